"""What `mmmd` says to somebody who has typed nothing else yet, and what fits the servos that a scan has found."""

from __future__ import annotations

import pytest

from daemon.cli.first_look import FirstLook, Port, fit_line, robots_that_fit
from daemon.cli.program import main
from retarget.robot.loading import load_robot

PORT = Port("/dev/ttyUSB0", "U2D2")


@pytest.mark.parametrize(
    ("look", "said"),
    [
        (FirstLook((), ("op3",), True, False), ["no USB serial adapter", "simulated", "mmmd demo --view"]),
        (FirstLook((PORT,), ("op3",), True, False), ["/dev/ttyUSB0 (U2D2)", "mmmd scan /dev/ttyUSB0", "mmmd doctor"]),
        (FirstLook((), ("op3",), False, False), ["mmmd install-torch"]),
        (FirstLook((PORT,), ("op3",), True, True), ["a daemon runs already", "mmmd say", "mmmd view"]),
    ],
)
def test_a_first_look_says_what_to_type_next(look: FirstLook, said: list[str]) -> None:
    text = "\n".join(look.lines())
    assert all(one in text for one in said), text


def test_mmmd_alone_says_what_it_found(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([""]) == 2
    out = capsys.readouterr().out
    assert "found: " in out and "next" in out and "reference" in out


@pytest.mark.parametrize("name", ["op3", "toddlerbot", "reference"])
def test_a_robot_fits_its_own_servos_and_none_fewer(name: str) -> None:
    own = [(s.servo_id, s.model.model_number) for s in load_robot(name).servos]
    assert name in robots_that_fit([*own, (252, 12)])
    assert name not in robots_that_fit(own[1:])
    assert f"--robot {name}" in fit_line([name], "/dev/ttyUSB0", 1000000)
    assert "robot new" in fit_line([], "/dev/ttyUSB0", 1000000)
