"""Exit statuses that docs/errors.md promises, and what bad numbers and refused texts leave."""

from __future__ import annotations

import math
import socket
from pathlib import Path

import pytest

from daemon.cli.connection import Connection
from daemon.cli.program import main
from daemon.client.errors import exit_status, stamp
from daemon.errors import CommandError
from daemon.settings.config import EndpointInUseError
from daemon.supervisor.start_checks import check_web_server
from daemon.wire import requests
from daemon.wire.events import Rejected


@pytest.mark.parametrize(
    ("code", "allowed", "status"),
    [
        ("fault", "", 3),
        ("wrong_state", "stop, estop, reset", 3),
        ("wrong_state", "stop, arm", 1),
        ("out_of_scope", "", 1),
    ],
)
def test_a_fault_or_an_e_stop_is_status_3(code: str, allowed: str, status: int) -> None:
    assert exit_status(Rejected(code=code, asked="say", found="", allowed=allowed, do="")) == status


def test_ctrl_c_is_status_130(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("daemon.cli.program._run", interrupted)
    assert main(["status"]) == 130
    assert "interrupted" in capsys.readouterr().err


@pytest.mark.parametrize("request_", [requests.Say(text="nod", seconds=math.nan), requests.Look(yaw_deg=math.inf)])
def test_a_number_that_is_not_finite_is_refused_before_it_is_sent(request_: requests.Request) -> None:
    """JSON has no such numbers: `look --yaw nan` freed the head and said that it was held."""
    with pytest.raises(CommandError, match="finite number"):
        stamp(request_)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["say", "wave", "--tempo", "nan"], "--tempo nan; allowed: a finite number"),
        (["say", "wave", "--seconds", "inf"], "--seconds inf; allowed: a finite number"),
        (["inbetween", "arms_out@-1", "standing@2"], "pose 1: at -1 s: give a time from 0 on"),
        (["status", "--timeout-s", "0"], "--timeout-s 0; allowed: more than 0"),
    ],
)  # fmt: skip
def test_a_wrong_number_is_said_as_it_was_typed(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """A tempo of nan was told as None, and a time-out of zero was the daemon's fault."""
    assert main(arguments) == 2
    assert said in capsys.readouterr().err


def test_no_wrong_time_out_keeps_a_stop_from_being_sent() -> None:
    """`mmmd estop --timeout-s 0` ended before anything was sent."""
    for timeout_s in (0.0, -1.0, math.nan):
        with Connection(timeout_s=timeout_s).client_to_stop() as robot:
            assert robot._timeout_s == Connection().timeout_s


def test_a_refused_text_takes_no_other_motions_place(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "kept.npz"
    out.write_bytes(b"a motion")
    assert main(["generate", "do not wave", "--out", str(out)]) == 1
    assert out.read_bytes() == b"a motion"
    assert main(["generate", "wave", "--out", str(out), "--threads", "0"]) == 2
    assert "--threads 0" in capsys.readouterr().err


def test_a_text_that_is_refused_is_no_wrong_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motion, out = tmp_path / "nod.npz", tmp_path / "out.npz"
    assert main(["generate", "nod", "--out", str(motion)]) == 0
    assert main(["edit", str(motion), "do not wave", "--out", str(out)]) == 1
    assert "what this model can do" in capsys.readouterr().err and not out.exists()


def test_a_name_that_no_gesture_can_have_is_a_wrong_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motion = tmp_path / "nod.npz"
    assert main(["generate", "nod", "--out", str(motion)]) == 0
    assert main(["gesture", "add", "My Nod", str(motion)]) == 2
    assert "a-z, 0-9 and _" in capsys.readouterr().err


def test_a_web_address_that_another_process_has_ends_the_start() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        with pytest.raises(EndpointInUseError, match="which another process has"):
            check_web_server(f"127.0.0.1:{other.getsockname()[1]}")
