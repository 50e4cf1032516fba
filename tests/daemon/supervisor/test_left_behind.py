"""What a daemon leaves behind, and what others may have left for it: folders, lock files, logs of failed starts."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from daemon.dynamixel.ports.lock import LockFileError, PortLock
from daemon.dynamixel.ports.serial_port import SerialPort
from daemon.errors import PortError
from daemon.supervisor.run_folder import RunFolder


@pytest.fixture(autouse=True)
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A temporary folder of its own for each test."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def aged(path: Path) -> Path:
    os.utime(path, (time.time() - 3600, time.time() - 3600))
    return path


def test_a_start_removes_the_folders_of_killed_daemons_only(temporary: Path) -> None:
    living = RunFolder()
    (living.path / "log").touch()
    code = (
        "import os, tempfile; from daemon.supervisor.run_folder import RunFolder; "
        f"tempfile.tempdir = {str(temporary)!r}; print(RunFolder().path, flush=True); os.kill(os.getpid(), 9)"
    )
    killed = subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, timeout=60, check=False)
    left = Path(killed.stdout.strip())
    assert left.is_dir()
    RunFolder().close()
    assert left.is_dir(), "it could be of a daemon that just starts"
    aged(left)
    aged(living.path)
    elsewhere = temporary / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "owned").touch()
    link = temporary / "mmmd-run-link"
    link.symlink_to(elsewhere)
    (temporary / "mmmd-run-bare").mkdir()
    aged(temporary / "mmmd-run-bare")
    RunFolder().close()
    assert not left.exists()
    assert living.path.is_dir() and (elsewhere / "owned").exists() and (temporary / "mmmd-run-bare").is_dir()
    living.close()
    assert not living.path.exists()


@pytest.mark.parametrize("kind", ["link", "dangling link", "second name", "pipe", "folder"])
def test_a_file_in_place_of_a_lock_is_refused_and_left_as_it_is(temporary: Path, kind: str) -> None:
    """The lock was opened through links: whoever can write to /tmp had root empty and overwrite any file."""
    precious = temporary / "precious"
    precious.write_text("keep me")
    place = temporary / "mmmd-dev-ttyNONE.lock"
    if kind == "link":
        place.symlink_to(precious)
    elif kind == "dangling link":
        place.symlink_to(temporary / "made")
    elif kind == "second name":
        os.link(precious, place)
    elif kind == "pipe":
        os.mkfifo(place)
    else:
        place.mkdir()
    with pytest.raises(LockFileError, match=r"mmmd-dev-ttyNONE\.lock"):
        PortLock("/dev/ttyNONE")
    assert precious.read_text() == "keep me" and not (temporary / "made").exists()


def test_a_port_names_what_is_in_place_of_its_lock_file(temporary: Path) -> None:
    master, slave = os.openpty()
    try:
        device = os.ttyname(slave)
        (temporary / f"mmmd-{device.strip('/').replace('/', '-')}.lock").symlink_to("/etc/hostname")
        with pytest.raises(PortError, match=r"lock file .* cannot be opened.*ls -l"):
            SerialPort(device, 1_000_000)
    finally:
        os.close(master)
        os.close(slave)


@pytest.mark.skipif(os.geteuid() != 0, reason="needs root, to be another user who may open the device")
def test_nobody_opens_a_port_in_use_even_without_a_lock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("daemon.dynamixel.ports.serial_port.is_pseudo", lambda _fd: False)
    master, slave = os.openpty()
    try:
        device = os.ttyname(slave)
        os.chmod(device, 0o666)
        port = SerialPort(device, 1_000_000)
        os.seteuid(65534)
        try:
            with pytest.raises(OSError, match="busy"):
                os.open(device, os.O_RDWR | os.O_NOCTTY)
            os.seteuid(0)
            port.close()
            os.seteuid(65534)
            os.close(os.open(device, os.O_RDWR | os.O_NOCTTY))
        finally:
            os.seteuid(0)
            port.close()
    finally:
        os.close(master)
        os.close(slave)


@pytest.mark.realtime
def test_a_start_that_fails_leaves_no_log_and_no_folder(temporary: Path) -> None:
    """A service tries again every few seconds: each try left a log file, 14,400 a day."""
    logs = temporary / "logs"
    logs.mkdir()
    command = [sys.executable, "-m", "daemon.cli", "run", "--robot", "reference", "--bus", "dxl:///dev/ttyNONE"]
    command += ["--generator", "tcp://127.0.0.1:9", "--log", str(logs)]
    for name in ("cmd", "ctl", "pub", "stream"):
        command += [f"--{name}", f"ipc://{temporary}/{name}"]
    environment = {**os.environ, "TMPDIR": str(temporary)}
    ended = subprocess.run(command, env=environment, stderr=subprocess.PIPE, text=True, timeout=120, check=False)
    assert ended.returncode == 1 and "no device '/dev/ttyNONE'" in ended.stderr, ended.stderr
    assert list(logs.iterdir()) == []
    assert [p for p in temporary.glob("mmmd-*") if p.is_dir()] == []
