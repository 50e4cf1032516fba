"""The rate plan against the table of `bus_daemon_peers.md` 2.1, and against the virtual wire."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.dynamixel.rate_plan import plan_for
from daemon.dynamixel.registers.models import MODEL_NUMBERS, MODELS
from daemon.dynamixel.servo_bus import ServoBus
from daemon.errors import ConfigError
from tests.support.servo_emulator import fake

XM = [MODELS[1020]] * 20


@pytest.mark.parametrize(
    ("baud", "fast", "delay_us", "hz"),
    [
        (57_600, False, 0, 10), (57_600, True, 0, 13), (1_000_000, False, 0, 176), (1_000_000, True, 0, 229),
        (1_000_000, False, 500, 64), (4_000_000, False, 0, 704), (4_000_000, True, 0, 917), (4_000_000, False, 500, 88),
    ],
)  # fmt: skip
def test_twenty_servos_as_computed_by_hand(baud: int, fast: bool, delay_us: int, hz: int) -> None:
    """Goals and ten bytes of feedback: 114 out, 34 to ask, 420 back (288 in a fast read)."""
    plan = plan_for(XM, baud, fast=fast, return_delay_s=delay_us * 1e-6)
    assert plan.goal_bytes == 114 and plan.request_bytes == 34
    assert plan.reply_bytes == (288 if fast else 420)
    assert plan.highest_hz == pytest.approx(hz, abs=0.6)


def test_an_impossible_rate_is_refused_with_the_arithmetic_and_what_helps() -> None:
    plan = plan_for(XM, 1_000_000, return_delay_s=500e-6)
    with pytest.raises(ConfigError) as caught:
        plan.require(100)
    text = str(caught.value)
    for said in (
        "420 bytes",
        "20 x 500 us",
        "15680 us",
        "nearest possible: 63 Hz",
        "return delay 0 (mmmd doctor --fix): 176 Hz",
    ):
        assert said in text, text
    plan = plan_for(XM, 57_600, return_delay_s=500e-6)
    with pytest.raises(ConfigError, match="1000000 baud and return delay 0"):
        plan.require(100)
    with pytest.raises(ConfigError, match="nothing but fewer servos"):
        plan_for(XM * 10, 57_600).require(200)


def test_what_was_measured_makes_it_tight_not_impossible() -> None:
    plan = plan_for(XM, 1_000_000, turnaround_s=0.006)
    assert plan.require(50)
    assert not plan.require(100)
    assert "117% of it used" in plan.lines(100)[-1]


@pytest.mark.parametrize("turnaround_s", [0.0, 0.0005])
@pytest.mark.parametrize(
    "names",
    [("XM430-W350",) * 20, ("2XL430-W250",) * 10, ("MX-28",) * 10, ("AX-12A",) * 6, ("XM430-W350", "AX-12A") * 3],
)
def test_a_cycle_takes_what_its_plan_says(names: tuple[str, ...], turnaround_s: float) -> None:
    far, servos, clock = fake(*names, turnaround_s=turnaround_s)
    bus = ServoBus.on_port(far, servos, clock)
    bus.verify()
    goals = np.full(len(names), 100, np.int32)
    bus.exchange(goals)
    start_s = clock.now_s()
    for _ in range(20):
        bus.exchange(goals)
    assert (clock.now_s() - start_s) / 20 == pytest.approx(bus.plan().cycle_s, rel=0.02)
    models = [MODELS[MODEL_NUMBERS[n]] for n in names]
    ahead = plan_for(
        models,
        1_000_000,
        fast=names[0] == names[-1] == "XM430-W350",
        turnaround_s=bus.chains[0].link.timing.turnaround_s,
    )
    assert ahead.cycle_s == pytest.approx(bus.plan().cycle_s, rel=0.1)
