"""The daemon as a service: settings and their sources, readiness, metrics, JSON lines, unit files, logs in turn."""

from __future__ import annotations

import configparser
import json
import logging
import os
import queue
import shutil
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from pathlib import Path

import numpy as np
import pytest

from daemon.demo.main_job import free_endpoints
from daemon.errors import ConfigError
from daemon.logs.log_lines import JsonLines
from daemon.recording.mcap_reading import read_log
from daemon.recording.rotation import RotatingLog
from daemon.settings.sources import DEFAULTS, config_of, resolve
from daemon.shared_memory.bus_link import cycle_dtype
from daemon.supervisor.bus_keeper import END_TIMEOUT_S
from retarget.robot.loading import load_robot
from tests.support.harness import RunningDaemon, mmmd

pytestmark = [pytest.mark.timeout(90), pytest.mark.realtime]


def test_later_sources_win_and_each_value_says_where_it_came_from(tmp_path):
    file = tmp_path / "mmmd.toml"
    file.write_text('robot = "op3"\nidle = "calm"\nqueue_s = 0.2\nlog = "~/x.mcap"\n')
    found = resolve({"robot": "reference", "bus": None}, file, {"MMMD_IDLE": "lively", "MMMD_AUTO_ARM": "no"})
    assert found["robot"].value == "reference" and found["robot"].source == "--robot"
    assert found["idle"].value == "lively" and found["idle"].source == "MMMD_IDLE"
    assert found["queue_s"].value == 0.2 and found["queue_s"].source == str(file)
    assert found["bus"].source == "default" and found["auto_arm"].value is False
    config = config_of(found)
    assert config.robot == "reference" and config.log == Path.home() / "x.mcap" and not config.auto_arm


def test_defaults_are_those_of_the_daemon():
    config = config_of(resolve({}, None, {"XDG_CONFIG_HOME": "/nowhere"}))
    assert config.robot == "reference" and config.endpoints.cmd == DEFAULTS["cmd"]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("robto = 1", "unknown robto"),
        ("queue_s = 'x'", "queue_s"),
        ("auto_arm = 3", "bool"),
        ("a = ", "cannot be read"),
    ],
)
def test_a_wrong_file_is_named(tmp_path, text, says):
    file = tmp_path / "c.toml"
    file.write_text(text)
    with pytest.raises(ConfigError, match=says) as caught:
        resolve({}, file, {})
    assert str(file) in str(caught.value)


def test_a_value_out_of_range_is_named():
    with pytest.raises(ConfigError, match="queue_s"):
        config_of(resolve({}, None, {"MMMD_QUEUE_S": "9"}))


def test_config_show(tmp_path):
    file = tmp_path / "c.toml"
    file.write_text('robot = "op3"\n')
    shown = json.loads(mmmd("config", "show", "--config", str(file), "--json", MMMD_IDLE="calm").stdout)
    assert shown["robot"] == {"value": "op3", "source": str(file)} and shown["idle"]["source"] == "MMMD_IDLE"
    assert set(shown) == set(DEFAULTS)
    assert str(file) in mmmd("config", "show", "--config", str(file)).stdout
    assert mmmd("config", "show", "--config", "/no/such").returncode == 2


def test_a_json_line_is_one_object():
    record = logging.LogRecord("daemon.x", logging.WARNING, "", 1, "servo %d\nsilent", (3,), None)
    line = JsonLines("bus").format(record)
    assert "\n" not in line
    assert json.loads(line) | {"t": ""} == {
        "t": "", "level": "warning", "process": "bus", "module": "daemon.x", "message": "servo 3\nsilent"
    }  # fmt: skip


def test_a_service_tells_systemd_and_prometheus_and_logs_json(tmp_path):
    """systemd's end is a socket of ours; metrics are read as a scraper would."""
    inbox = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    inbox.bind(str(tmp_path / "notify"))
    heard: queue.Queue[bytes] = queue.Queue()

    def listen():  # all the time, as systemd does: the kernel keeps ten datagrams and drops the rest
        while told := inbox.recv(500):
            heard.put(told)

    listener = threading.Thread(target=listen)
    listener.start()
    port = int(free_endpoints().cmd.rsplit(":", 1)[1])
    os.environ |= {"NOTIFY_SOCKET": str(tmp_path / "notify"), "WATCHDOG_USEC": "600000"}
    try:
        daemon = RunningDaemon("--metrics", f"127.0.0.1:{port}", "--log-json")
    finally:
        for key in ("NOTIFY_SOCKET", "WATCHDOG_USEC"):
            del os.environ[key]
    try:
        daemon.until_ready()
        assert heard.get(timeout=10).startswith(b"READY=1\nSTATUS=robot reference")
        assert heard.get(timeout=10) == b"WATCHDOG=1"
        with daemon.client() as client:
            client.say("wave", seconds=0.8)
            client.wait_for("idle", timeout_s=3)
        text = urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=5).read().decode()
        values = {line.rsplit(" ", 1)[0]: float(line.rsplit(" ", 1)[1]) for line in text.splitlines() if line[0] != "#"}
        assert values['mmmd_state{robot="reference",state="idle"}'] == 1
        assert values['mmmd_state{robot="reference",state="fault"}'] == 0
        assert values['mmmd_events_total{robot="reference",type="done"}'] == 1
        assert values['mmmd_cycles_total{robot="reference"}'] > 25
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(f"http://127.0.0.1:{port}/other", timeout=5)
        with socket.create_connection(("127.0.0.1", port), 5) as rude:
            rude.sendall(b"x" * 20_000)
        urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=5).close()
        assert daemon.terminate() == 0
        while heard.get(timeout=5) != b"STOPPING=1":
            pass
        lines = [json.loads(line) for line in daemon.said.splitlines()]
        assert {"front", "bus"} <= {line["process"] for line in lines}
    finally:
        daemon.close()
        inbox.shutdown(socket.SHUT_RD)  # ends the listener with an empty datagram
        listener.join(5)
        inbox.close()


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Path:
    """The folder that the service was installed below."""
    root = tmp_path_factory.mktemp("root")
    install_below(root)
    return root


def install_below(root: Path) -> None:
    program = root / "bin" / "mmmd"
    program.parent.mkdir(exist_ok=True)
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    result = mmmd(
        "install-service", "--root", str(root), "--user", "root", PATH=f"{program.parent}:{os.environ['PATH']}"
    )
    assert result.returncode == 0 and "systemctl" in result.stdout


def test_install_service_writes_readable_files_and_keeps_a_configuration(installed):
    assert 'latency_timer}="1"' in (installed / "etc/udev/rules.d/60-mmmd.rules").read_text()
    config = installed / "etc/mmmd/mmmd.toml"
    assert not config_of(resolve({}, config, {})).auto_arm
    config.write_text('robot = "op3"\n')
    install_below(installed)
    assert config.read_text() == 'robot = "op3"\n'


def test_the_unit_spares_the_bus_process_of_a_dead_front_and_restarts(installed):
    """systemd.kill(5): `mixed` and `control-group` send SIGKILL to all that is left as soon as the main process is gone."""
    unit = configparser.RawConfigParser()
    unit.read(installed / "etc/systemd/system/mmmd.service")
    service = unit["Service"]
    assert service["ExecStart"].startswith(f"{installed}/bin/mmmd run --config /etc/mmmd/mmmd.toml")
    assert service["Type"] == "notify" and service["User"] == "root"
    assert service["KillMode"] == "process" and "ExecStop" not in service and "ExecStopPost" not in service
    assert service["OOMPolicy"] == "continue"
    assert service["Restart"] == "on-failure" and service["RestartPreventExitStatus"].split() == ["2", "3"]
    assert unit["Unit"]["StartLimitIntervalSec"] == "0"
    assert float(service["TimeoutStopSec"]) > config_of(resolve({}, None, {})).park_timeout_s + 3 * END_TIMEOUT_S
    shared_tmp = "PrivateTmp" not in service and "/tmp" in service["ReadWritePaths"].split()
    assert shared_tmp  # where `PortLock` keeps its files


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="needs systemd-analyze")
def test_systemd_finds_nothing_wrong_with_the_unit(installed):
    command = ["systemd-analyze", "verify", str(installed / "etc/systemd/system/mmmd.service")]
    result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=30)
    assert (result.returncode, [x for x in result.stderr.splitlines() if "mmmd" in x]) == (0, [])


def records(n: int) -> np.ndarray:
    robot = load_robot("reference")
    rows = np.zeros(n, cycle_dtype(robot.n_joints, robot.n_joints))
    rows["cycle"] = np.arange(n)
    rows["t_mono_ns"] = time.monotonic_ns() + np.arange(n) * 10_000_000
    rows["goal_rad"] = np.random.default_rng(0).normal(size=rows["goal_rad"].shape)
    return rows


def test_logs_go_on_in_the_next_file_and_the_oldest_go(tmp_path):
    path = tmp_path / "run.mcap"
    rows = records(3000)
    with RotatingLog(path, load_robot("reference"), size_mb=0.05, total_mb=0.3) as log:
        for i, row in enumerate(rows):
            log.cycle(row)
            if i % 100 == 99:
                log.flush()
    files = sorted(tmp_path.glob("*.mcap"), key=lambda p: p.stat().st_mtime_ns)
    assert len(files) > 2 and not path.exists()
    assert sum(p.stat().st_size for p in files) < 0.5e6
    numbers = [c.cycle for p in sorted(files, key=lambda p: int(p.stem.split(".")[1])) for c in read_log(p).cycles]
    assert numbers == list(range(numbers[0], 3000)) and numbers[0] > 0  # whole files, nothing lost between them


def test_logs_of_an_earlier_run_are_not_overwritten(tmp_path):
    """`run.mcap` had been removed or moved away; `run.1.mcap` of that run was then written over."""
    path, theirs = tmp_path / "run.mcap", [tmp_path / f"run.{n}.mcap" for n in (1, 2, 4)]
    for file in theirs:
        file.write_bytes(b"of an earlier run")
    with RotatingLog(path, load_robot("reference"), size_mb=0.05, total_mb=0) as log:
        for i, row in enumerate(records(1500)):
            log.cycle(row)
            if i % 100 == 99:
                log.flush()
    assert all(file.read_bytes() == b"of an earlier run" for file in theirs)
    mine = [path, tmp_path / "run.3.mcap", *(tmp_path / f"run.{n}.mcap" for n in range(5, 100))]
    assert [c.cycle for p in mine if p.exists() for c in read_log(p).cycles] == list(range(1500))
    with pytest.raises(FileExistsError):
        RotatingLog(path, load_robot("reference"), 0, 0)


def test_a_log_that_does_not_rotate_is_one_file(tmp_path):
    with RotatingLog(tmp_path / "run.mcap", load_robot("reference"), 0, 0) as log:
        for row in records(500):
            log.cycle(row)
        log.flush()
    assert [c.cycle for c in read_log(tmp_path / "run.mcap").cycles] == list(range(500))
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full, a device without room")
def test_a_full_disk_ends_the_recorder_with_one_message(tmp_path):
    (tmp_path / "run.mcap").symlink_to("/dev/full")
    from daemon.shared_memory.bus_link import BusLink

    link = BusLink.create(load_robot("reference").n_joints)
    try:
        command = [sys.executable, "-m", "daemon.recording.recorder", "--robot", "reference", "--link", str(link.path)]
        command += ["--events", f"ipc://{tmp_path}/events", "--out", str(tmp_path / "run.mcap")]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        _, said = process.communicate(timeout=20)
        assert process.returncode == 1 and "recording stopped" in said and "Traceback" not in said
    finally:
        link.close()
