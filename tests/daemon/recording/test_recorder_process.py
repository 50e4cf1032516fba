"""The recorder as a process: ended, killed, stopped, and without room on the disk."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np
import pytest
import zmq

from daemon.errors import LogError
from daemon.recording.mcap_reading import read_log
from daemon.shared_memory.bus_link import BusLink
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel

pytestmark = pytest.mark.realtime


class Recording:
    """The recorder's process on shared memory that the test fills."""

    def __init__(self, folder: Path, robot: RobotModel) -> None:
        self.out = folder / "run.mcap"
        self.link = BusLink.create(robot.n_joints)
        self.bus = BusLink.attach(self.link.path, robot.n_joints)
        self.endpoint = f"ipc://{folder}/events"
        self._context = zmq.Context()
        self.events = self._context.socket(zmq.PUSH)
        self.events.connect(self.endpoint)
        arguments = ["--robot", "reference", "--link", str(self.link.path), "--out", str(self.out)]
        command = [sys.executable, "-m", "daemon.recording.recorder", *arguments, "--events", self.endpoint]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE)

    def publish(self, records: list[np.void]) -> None:
        for record in records:
            slot = self.bus.cycles.next_record()
            for name in record.dtype.names or ():
                slot[name] = record[name]
            self.bus.cycles.publish()

    def wait_for(self, what: Callable[[], bool]) -> None:
        end_s = time.monotonic() + 30
        while not what():
            assert time.monotonic() < end_s and self.process.poll() is None
            time.sleep(0.02)

    def cycles(self) -> int:
        try:
            return len(read_log(self.out).cycles)
        except LogError:
            return 0

    def close(self) -> None:
        self.process.kill()
        self.process.communicate()
        self.events.close(0)
        self._context.term()
        self.link.close()


@pytest.fixture
def recording(tmp_path):
    made = Recording(tmp_path, load_robot("reference"))
    yield made
    made.close()


@pytest.mark.long
def test_sigterm_finishes_the_log(recording, run):
    recording.publish(run[1])
    recording.events.send_multipart([b"v1/event", msgspec.json.encode({"type": "done", "plan_id": 7})])
    recording.wait_for(lambda: recording.cycles() > 0)
    recording.publish(run[1][:30])
    os.kill(recording.process.pid, signal.SIGINT)  # Ctrl-C reaches the whole group, and the parking after it belongs in
    recording.process.terminate()
    assert recording.process.wait(30) == 0
    log = read_log(recording.out)
    assert not log.is_cut
    assert len(log.cycles) == len(run[1]) + 30
    assert log.n_events == 1


def test_killed_it_leaves_a_log_that_reads_to_its_last_chunk(recording, run):
    recording.publish(run[1])
    recording.wait_for(lambda: recording.cycles() == len(run[1]))
    recording.process.kill()
    recording.process.wait(30)
    log = read_log(recording.out)
    assert log.is_cut and "cut off" in log.problem
    assert [c.goal_tick for c in log.cycles] == [tuple(r["goal_tick"]) for r in run[1]]


@pytest.mark.long
def test_a_stopped_recorder_slows_nobody_and_its_losses_are_counted(recording, run):
    """Frozen while the ring goes round: publishing goes on, and the log says by its numbers what is missing."""
    recording.publish(run[1][:5])
    recording.wait_for(lambda: recording.cycles() > 0)
    os.kill(recording.process.pid, signal.SIGSTOP)
    record = run[1][-1].copy()
    for cycle in range(5, 6000):
        record["cycle"] = cycle
        recording.publish([record])
    os.kill(recording.process.pid, signal.SIGCONT)
    recording.process.terminate()
    assert recording.process.wait(60) == 0
    assert b"cycles dropped" in recording.process.stderr.read()
    log = read_log(recording.out)
    numbers = [c.cycle for c in log.cycles]
    assert numbers[-1] == 5999 and len(numbers) < 5000
    assert int(log.metadata["cycles_dropped"]) == 6000 - len(numbers)


@pytest.mark.long
def test_a_file_that_cannot_be_written_ends_recording_alone(tmp_path):
    link = BusLink.create(load_robot("reference").n_joints)
    try:
        arguments = ["--robot", "reference", "--link", str(link.path), "--out", str(tmp_path / "no" / "run.mcap")]
        command = [
            sys.executable,
            "-m",
            "daemon.recording.recorder",
            *arguments,
            "--events",
            f"ipc://{tmp_path}/events",
        ]
        ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    finally:
        link.close()
    assert ended.returncode == 1
    assert "goes on without a log" in ended.stderr and "Traceback" not in ended.stderr


@pytest.mark.long
def test_a_full_disk_ends_recording_alone():
    if not Path("/dev/full").exists():
        pytest.skip("needs /dev/full")
    link = BusLink.create(load_robot("reference").n_joints)
    try:
        arguments = ["--robot", "reference", "--link", str(link.path), "--out", "/dev/full"]
        command = [sys.executable, "-m", "daemon.recording.recorder", *arguments, "--events", "ipc://@mmmd-test-full"]
        ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    finally:
        link.close()
    assert ended.returncode == 1
    assert "goes on without a log" in ended.stderr and "Traceback" not in ended.stderr
