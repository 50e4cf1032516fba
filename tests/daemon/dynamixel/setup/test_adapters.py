"""USB adapters: recognition under another path, and opening again after a loss."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from daemon.dynamixel.ports.adapter import (
    Adapter,
    adapter_at,
    device_of,
    latency_advice,
    latency_remedy,
    latency_timer_ms,
)
from daemon.dynamixel.ports.serial_port import SerialPort
from daemon.errors import LinkLostError
from sim.bus import SimBus
from sim.pty import PtyServer
from tests.support.factory_bus import ROBOT

pytestmark = pytest.mark.realtime


def sysfs(root: Path, tty: str, serial: str, latency: str = "16") -> None:
    """Write the files below `root` by which Linux describes an FTDI adapter."""
    usb = root / "devices" / f"usb-{tty}-{serial}"
    port = usb / "1.0" / tty
    port.mkdir(parents=True, exist_ok=True)
    for name, text in (("idVendor", "0403"), ("idProduct", "6014"), ("serial", serial)):
        (usb / name).write_text(text + "\n")
    (port / "latency_timer").write_text(latency + "\n")
    link = root / "class" / "tty" / tty
    link.mkdir(parents=True)
    (link / "device").symlink_to(port)


def test_an_adapter_is_known_again_under_another_path(tmp_path: Path) -> None:
    sysfs(tmp_path, "ttyUSB0", "FT1")
    sysfs(tmp_path, "ttyUSB1", "FT2", "1")
    mine = adapter_at("/dev/ttyUSB0", tmp_path)
    assert mine == Adapter("0403", "6014", "FT1")
    assert device_of(mine, tmp_path) == "/dev/ttyUSB0"
    (tmp_path / "class" / "tty" / "ttyUSB0" / "device").unlink()
    assert device_of(mine, tmp_path) is None
    sysfs(tmp_path, "ttyUSB7", "FT1")
    assert device_of(mine, tmp_path) == "/dev/ttyUSB7"
    assert device_of(Adapter("0403", "6014", ""), tmp_path) is None, "without a serial number they are all alike"
    assert latency_timer_ms("/dev/ttyUSB1", tmp_path) == 1 and latency_timer_ms("/dev/ttyUSB7", tmp_path) == 16
    assert latency_timer_ms("/dev/pts/3", tmp_path) is None and adapter_at("/dev/pts/3", tmp_path) is None
    assert "echo 1 | sudo tee /sys/class/tty/ttyUSB7/device/latency_timer" in latency_remedy("/dev/ttyUSB7")
    assert latency_advice("/dev/ttyUSB1", tmp_path) == latency_advice("/dev/pts/3", tmp_path) == ""
    advice = latency_advice("/dev/ttyUSB7", tmp_path)
    assert "up to 16 ms" in advice and latency_remedy("/dev/ttyUSB7") in advice


def test_a_lost_tty_is_opened_again_where_its_link_leads_now(tmp_path: Path) -> None:
    link = tmp_path / "servos"

    def serve() -> tuple[PtyServer, threading.Thread]:
        server = PtyServer(SimBus(ROBOT), link)
        thread = threading.Thread(target=server.serve)
        thread.start()
        return server, thread

    def end(server: PtyServer, thread: threading.Thread) -> None:
        server.stop()
        thread.join(5)
        server.close()

    server, thread = serve()
    port = SerialPort(str(link), ROBOT.bus.baud)
    end(server, thread)
    with pytest.raises(LinkLostError):
        for _ in range(3):
            port.write(b"\0")
            port.read(1, 0.01)
    with pytest.raises(LinkLostError, match="still lost"):
        port.reopen()
    server, thread = serve()
    try:
        port.reopen()
        port.write(b"\xff\xff\xfd\x00\x01\x03\x00\x01\x19\x4e")
        assert len(port.read(14, 2.0)) == 14
        with pytest.raises(Exception, match=f"process {os.getpid()}"):
            SerialPort(str(link), ROBOT.bus.baud)
        port.close()
        with pytest.raises(LinkLostError, match="closed"):
            port.reopen()
    finally:
        end(server, thread)
