"""`mmmd bench estop`: its figures under disturbances, on a whole daemon, and how e-stops that are lost are counted."""

from __future__ import annotations

import pytest

from daemon.bench.disturbances import ALIVE_BOUND_S, DISTURBANCES, RESTART_BOUND_S, Disturbance
from daemon.bench.estop_disturbed import Outcome, measure_disturbed, summary
from tests.support.sizes import some_and_all

FIGURES = {"lost", "untold", "n", "bound_s", "p50_ms", "p99_ms", "worst_ms"}
TIMES = {"p50_ms", "p99_ms", "worst_ms"}
AWAY = {"bus_killed", "bus_frozen", "start", "port_lost"}


def test_there_is_a_disturbance_for_each_socket_process_and_phase():
    floods = {"flood_cmd", "flood_ctl", "flood_pub", "flood_stream", "connections_1000"}
    processes = {"front_frozen", "front_killed", "bus_killed", "bus_frozen"}
    assert set(DISTURBANCES) == floods | processes | {"start", "arming", "parking", "port_lost"}
    for name, one in DISTURBANCES.items():
        assert one.bus_away == (name in AWAY)
        assert one.bound_s == (RESTART_BOUND_S if name in AWAY else ALIVE_BOUND_S)


def test_a_lost_estop_is_counted_and_its_time_is_none_of_the_figures():
    outcomes = [Outcome(False, True, 0.01, 0.002), Outcome(True, False, 15.0, None), Outcome(False, False, 0.03, 0.004)]
    figures = summary(outcomes, DISTURBANCES["bus_killed"])
    assert set(figures) == FIGURES | {"from_back"}
    assert (figures["lost"], figures["untold"], figures["n"]) == (1, 2, 3)
    assert (figures["p50_ms"], figures["worst_ms"]) == (20.0, 30.0)
    assert figures["from_back"] == {"p50_ms": 3.0, "p99_ms": 3.98, "worst_ms": 4.0}


@pytest.mark.long
@pytest.mark.timeout(240)
@pytest.mark.realtime
@pytest.mark.parametrize("names", some_and_all(("bus_killed",), ("flood_pub", "front_killed", "bus_killed")))
def test_disturbed_daemons_give_every_figure_and_lose_no_estop(names):
    disturbances, violations = measure_disturbed(1, 0, "reference", names)
    assert tuple(disturbances) == names and violations == 0
    for name, figures in disturbances.items():
        assert set(figures) == FIGURES | ({"from_back"} if name in AWAY else set())
        assert (figures["lost"], figures["untold"], figures["n"]) == (0, 0, 1), (name, figures)
        assert figures["worst_ms"] > 0
    assert set(disturbances["bus_killed"]["from_back"]) == TIMES


@pytest.mark.long
@pytest.mark.timeout(240)
@pytest.mark.realtime
def test_an_estop_that_does_not_come_through_is_lost(monkeypatch, capsys):
    """The bench's own alarm: here the button is not pressed at all."""
    monkeypatch.setattr("daemon.bench.estop_rig.Button.press", lambda _button: None)
    monkeypatch.setitem(DISTURBANCES, "unpressed", Disturbance(DISTURBANCES["parking"].act))
    disturbances, _ = measure_disturbed(1, 0, "reference", ["unpressed"])
    assert (disturbances["unpressed"]["lost"], disturbances["unpressed"]["worst_ms"]) == (1, None)
    assert "LOST" in (said := capsys.readouterr().err) and "moving" in said.lower()
