"""What a virtual machine's host takes from it does not pass for simulated servos; any other pause does."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.dynamixel.codec import packet
from sim.clock import VirtualClock
from sim.port import SimPort
from sim.steal_time import LEAST_PAUSE_S, LOOK_EVERY_S, STAT, MachineTime, stolen_s
from tests.support.servo_bench import Bench

TICK_S = 0.01


class Machine:
    """Two processors with a host, whose clock goes on by `pass_s`."""

    def __init__(self, folder: Path) -> None:
        self.clock, self.stolen_s, self._stat = VirtualClock(), 0.0, folder / "stat"
        self.pass_s(0.0)
        self.time = MachineTime(self.clock, self._stat)

    def pass_s(self, seconds: float, taken_s: float = 0.0) -> None:
        """Of these seconds the host took `taken_s` from the second processor and nothing from the first."""
        self.stolen_s += taken_s
        ticks = round(self.stolen_s / TICK_S)
        rest = "intr 12 0 0\nctxt 9"
        self._stat.write_text(
            f"cpu  1 2 3 4 5 6 7 {ticks} 0 0\ncpu0 1 2 3 4 5 6 7 0 0 0\ncpu1 1 2 3 4 5 6 7 {ticks} 0 0\n{rest}"
        )
        self.clock.sleep_until(self.clock.now_s() + seconds)


def test_time_stands_while_the_host_runs_but_not_for_a_stopped_process(tmp_path: Path) -> None:
    machine = Machine(tmp_path)
    machine.pass_s(0.5, taken_s=0.5)
    assert machine.time.now_s() == pytest.approx(0.0)
    machine.pass_s(2.0)
    assert machine.time.now_s() == pytest.approx(2.0)
    machine.pass_s(1.0, taken_s=0.25)
    assert machine.time.now_s() == pytest.approx(2.75)
    assert machine.time.taken_s == pytest.approx(0.75)


def test_what_was_taken_in_small_pieces_does_not_excuse_a_stop_later(tmp_path: Path) -> None:
    machine = Machine(tmp_path)
    for _ in range(200):
        machine.pass_s(0.02, taken_s=0.01)
        machine.time.now_s()
    before_s = machine.time.now_s()
    machine.pass_s(2.0)
    assert machine.time.now_s() - before_s >= 2.0 - LOOK_EVERY_S


@given(st.lists(st.tuples(st.floats(0.001, 2.0), st.floats(0.0, 1.0)), max_size=20))
def test_it_never_goes_back_nor_faster_than_the_clock(tmp_path_factory: pytest.TempPathFactory, passes) -> None:
    machine = Machine(tmp_path_factory.mktemp("machine"))
    seen_s = machine.time.now_s()
    for seconds, share in passes:
        machine.pass_s(seconds, taken_s=share * seconds)
        now_s = machine.time.now_s()
        assert -1e-9 <= now_s - seen_s <= seconds + 1e-9
        seen_s = now_s
    assert machine.time.taken_s <= machine.stolen_s + len(passes) * TICK_S


def test_a_sleep_lasts_as_long_in_its_own_time(tmp_path: Path) -> None:
    machine = Machine(tmp_path)
    inner = machine.clock.sleep_until

    def held_up(t_s: float) -> None:
        machine.clock.sleep_until = inner  # type: ignore[method-assign]
        machine.pass_s(0.4, taken_s=0.4)

    machine.clock.sleep_until = held_up  # type: ignore[method-assign]
    machine.time.sleep_until(0.05)
    assert machine.time.now_s() == pytest.approx(0.05)
    assert machine.clock.now_s() == pytest.approx(0.45)


def test_a_machine_that_tells_nothing_has_its_clocks_time(tmp_path: Path) -> None:
    clock = VirtualClock()
    time = MachineTime(clock, tmp_path / "missing")
    clock.sleep_until(10 * LEAST_PAUSE_S)
    assert time.now_s() == clock.now_s() and time.taken_s == 0.0


@pytest.mark.skipif(not STAT.exists(), reason="needs Linux's /proc/stat")
def test_this_machine_tells_of_each_of_its_processors() -> None:
    lines = [line for line in STAT.read_text().splitlines() if line.startswith("cpu")]
    assert len(stolen_s()) == len(lines) - 1 >= 1


@pytest.mark.parametrize(("taken_s", "trips"), [(0.5, False), (0.0, True)])
def test_a_servos_watchdog_runs_out_where_only_the_process_stood(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, taken_s: float, trips: bool
) -> None:
    machine = Machine(tmp_path)
    monkeypatch.setattr("sim.port.machine_time", lambda: machine.time)
    bench = Bench()
    port = SimPort(bench.bus, object())  # type: ignore[arg-type]  # any clock but a virtual one is the machine's
    for address, value in ((64, 1), (98, 10)):  # torque enable; bus watchdog, 200 ms
        port.write(packet.write(1, address, bytes([value])))
        machine.pass_s(0.01)
    machine.pass_s(0.5, taken_s=taken_s)
    port.write(packet.ping(1))
    assert bench.servo.get("bus_watchdog") == (-1 if trips else 10)
