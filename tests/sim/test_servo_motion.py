"""Motion of simulated servos: profiles, operating modes, gains, backlash, supply voltage."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from sim.faults import Fault
from tests.support.servo_bench import TICK_RAD, Bench


@pytest.mark.parametrize("name", ["XM430-W350", "XL330-M288", "XL430-W250", "XM540-W270"])
def test_without_profile_it_reaches_the_manuals_no_load_speed_and_no_more(name: str) -> None:
    b = Bench(name)
    b.write("operating_mode", 16)
    b.write("torque_enable", 1)
    b.write("goal_pwm", 885)
    b.wait(1.0)
    top = b.servo.spec.model.no_load_speed_rad_s
    assert b.servo.drives.velocity_tick_s[0] * TICK_RAD == pytest.approx(top, rel=0.03)


def test_a_profile_is_a_trapezoid_with_its_speed_and_acceleration() -> None:
    b = Bench()
    for name, value in (
        ("profile_acceleration", 10),
        ("profile_velocity", 40),
        ("torque_enable", 1),
        ("goal_position", 4000),
    ):
        assert b.write(name, value) == 0
    path = [b.servo.drives.live()[0][6]]
    while len(path) < 2000:
        b.wait(0.002)
        path.append(b.servo.drives.live()[0][6])
    speed = [(y - x) * 500 * TICK_RAD for x, y in pairwise(path)]
    bend = [(y - x) * 500 for x, y in pairwise(speed)]
    assert max(speed) == pytest.approx(40 * 0.0239808, rel=0.01)
    assert max(abs(a) for a in bend) <= 10 * 0.3745 * 1.02
    assert path[-1] == pytest.approx(4000, abs=0.01)
    assert b.read("position_trajectory") == 4000 and b.read("velocity_trajectory") == 0


def test_a_time_based_profile_takes_its_time() -> None:
    b = Bench()
    for name, value in (
        ("drive_mode", 4),
        ("profile_acceleration", 300),
        ("profile_velocity", 1000),
        ("torque_enable", 1),
    ):
        assert b.write(name, value) == 0
    b.write("goal_position", 3000)
    b.wait(0.9)
    assert b.servo.drives.live()[0][6] < 2999
    b.wait(0.15)
    assert b.servo.drives.live()[0][6] == pytest.approx(3000, abs=1)


def test_velocity_mode_keeps_its_speed_and_ramps_by_the_acceleration() -> None:
    b = Bench()
    for name, value in (
        ("operating_mode", 1),
        ("profile_acceleration", 5),
        ("torque_enable", 1),
        ("goal_velocity", -100),
    ):
        assert b.write(name, value) == 0
    b.wait(0.5)
    assert -15 > b.read("present_velocity") > -40, "1.9 rad/s2 for half a second is 39 units, and the loop lags"
    b.wait(3.0)
    assert b.read("present_velocity") == pytest.approx(-100, abs=2)


def test_current_mode_pushes_with_its_current_until_the_speed_takes_it() -> None:
    b = Bench(faults=(Fault("stuck", start_s=0.1),))
    for name, value in (("operating_mode", 0), ("torque_enable", 1), ("goal_current", 300)):
        assert b.write(name, value) == 0
    b.wait(0.5)
    assert b.read("present_current") == pytest.approx(300, abs=2)


def test_current_based_position_never_pushes_harder_than_its_goal_current() -> None:
    b = Bench(faults=(Fault("stuck", start_s=0.1),))
    for name, value in (("operating_mode", 5), ("goal_current", 150), ("torque_enable", 1), ("goal_position", 3500)):
        assert b.write(name, value) == 0
    b.wait(1.0)
    assert b.read("present_current") == pytest.approx(150, abs=2)


def test_goal_pwm_limits_how_hard_it_pushes() -> None:
    b = Bench(faults=(Fault("stuck", start_s=0.1),))
    for name, value in (("goal_pwm", 200), ("torque_enable", 1), ("goal_position", 3500)):
        assert b.write(name, value) == 0
    b.wait(1.0)
    assert b.read("present_pwm") == 200


def test_an_integral_gain_takes_away_what_friction_left() -> None:
    def end(i_gain: int) -> float:
        b = Bench("XL330-M288", faults=(Fault("push", start_s=0.1, amount=-0.05),))
        b.write("position_i_gain", i_gain)
        b.write("torque_enable", 1)
        b.write("goal_position", 2500)
        b.wait(8.0)
        return abs(b.read("present_position") - 2500)

    assert end(0) > 5
    assert end(400) <= 2


def test_more_proportional_gain_stiffens_and_feed_forward_reduces_lag() -> None:
    def lag(**gains: int) -> float:
        b = Bench()
        for name, value in (
            *gains.items(),
            ("profile_velocity", 80),
            ("profile_acceleration", 200),
            ("torque_enable", 1),
        ):
            assert b.write(name, value) == 0
        b.write("goal_position", 4000)
        b.wait(0.6)
        return b.read("position_trajectory") - b.read("present_position")

    plain = lag(position_p_gain=800)
    assert lag(position_p_gain=1600) < 0.7 * plain
    assert lag(position_p_gain=800, feedforward_1st_gain=15) < 0.8 * plain


def test_backlash_is_felt_when_it_turns_round() -> None:
    b = Bench()
    b.write("torque_enable", 1)
    for _ in range(3):
        b.write("goal_position", 2200)
        b.wait(1.0)
        b.write("goal_position", 2100)
        b.wait(1.0)
    shaft = b.servo.drives.body.position_rad[0] / TICK_RAD
    assert 0.5 < abs(shaft - b.servo.drives.position_tick[0]) < 1.5, "half of a quarter of a degree"


def test_without_torque_a_goal_moves_nothing_and_voltage_sags_under_load() -> None:
    b = Bench("XM540-W270", faults=(Fault("stuck", start_s=0.1),))
    b.write("goal_position", 3000)
    b.wait(0.5)
    assert abs(b.read("present_position") - 2048) <= 1
    idle = b.read("present_input_voltage")
    b.write("torque_enable", 1)
    b.wait(0.5)
    assert b.read("present_input_voltage") < idle
    assert math.isclose(idle, 120)
