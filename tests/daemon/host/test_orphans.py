"""Children of a front that is no more: they end, whenever it was killed, and servos do not hold for ever."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from daemon.control.front_watch import FAULT_LIMP_S
from daemon.control.starting import start
from daemon.host.parent import PARENT_VARIABLE
from daemon.shared_memory.bus_link import BusLink, BusRequest, BusState
from retarget.robot.loading import load_robot
from tests.support.rig import rig
from tests.support.sizes import few_and_long

_FRONT_KILLED_AT_ONCE = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], env={**os.environ, "%s": str(os.getpid())}, start_new_session=True)
print(process.pid, flush=True)
os._exit(1)
"""


def has_ended(pid: int) -> bool:
    """Whether a process that is nobody's child here is gone, or only waits to be reaped."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.realtime
@pytest.mark.parametrize("module", few_and_long(["daemon.control.process"], ["daemon.recording.recorder"]))
def test_a_child_whose_front_was_killed_while_it_started_ends(module: str, tmp_path: Path) -> None:
    """It asked for its parent's id once it ran, got that of whoever inherits orphans, and kept the port for ever."""
    robot = load_robot("reference")
    link = BusLink.create(robot.n_joints, robot.n_servos)
    arguments = ["--robot", "reference", "--link", str(link.path)]
    if module.endswith("recorder"):
        arguments += ["--events", f"ipc://{tmp_path}/events", "--out", str(tmp_path / "run.mcap")]
    else:
        arguments += ["--bus", "sim://"]
    command = [sys.executable, "-c", _FRONT_KILLED_AT_ONCE % PARENT_VARIABLE, sys.executable, "-m", module, *arguments]
    front = subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=60, check=False)
    pid = int(front.stdout)
    try:
        until_s = time.monotonic() + 60
        while not has_ended(pid) and time.monotonic() < until_s:
            time.sleep(0.1)
        assert has_ended(pid), f"{module} goes on without its front"
    finally:
        if not has_ended(pid):
            os.kill(pid, 9)
        link.close()


def test_servos_found_holding_go_limp_when_the_front_stays_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    """After a loss a new bus process is in a fault in which the servos still hold: nobody who is gone can reset it."""
    with rig() as r:
        r.arm()
        link = BusLink.create(r.robot.n_joints, r.robot.n_servos)
        try:
            again = start(r.robot, lambda: r.bus, link, r.clock, after_loss=True)
            assert again is not None and again.state is BusState.FAULT and not again.made_limp
            monkeypatch.setattr(BusLink, "heartbeat_age_s", property(lambda _: FAULT_LIMP_S - 1))
            for _ in range(50):
                again.cycle()
            assert all(r.torque), "the front may be slow"
            monkeypatch.setattr(BusLink, "heartbeat_age_s", property(lambda _: FAULT_LIMP_S + 1))
            for _ in range(20):
                again.cycle()
            assert again.state is BusState.FAULT and not any(r.torque) and again.made_limp
            link.request(BusRequest.RESET)
            again.cycle()
            assert again.state is BusState.LIMP
        finally:
            link.close()
