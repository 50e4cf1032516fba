"""The contract of `Port`, the same for simulated servos in process and behind a tty; and what opening one can meet."""

from __future__ import annotations

import os
import termios
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
import serial
from dynamixel_sdk import GroupSyncRead, GroupSyncWrite, PacketHandler, PortHandler

from daemon.dynamixel.codec import packet
from daemon.dynamixel.codec.packet import PacketDecoder
from daemon.dynamixel.ports.opening import PortContext, open_port
from daemon.dynamixel.ports.port import Port
from daemon.dynamixel.ports.serial_port import SerialPort, open_dxl
from daemon.errors import CommandError, LinkLostError, PortBusyError, PortMissingError, PortPermissionError
from daemon.host.clock import RealClock
from sim.bus import SimBus
from sim.port import SimPort
from sim.pty import PtyServer
from tests.support.robots import packaged

pytestmark = pytest.mark.realtime

ROBOT = packaged("op3")
BAUD = ROBOT.bus.baud


@pytest.fixture
def tty(tmp_path: Path) -> Iterator[Path]:
    """A link to a tty with OP3's servos behind it."""
    server = PtyServer(SimBus(ROBOT), tmp_path / "servos")
    thread = threading.Thread(target=server.serve)
    thread.start()
    yield tmp_path / "servos"
    server.stop()
    thread.join(5)
    server.close()


def in_process(_tty: Path) -> Port:
    return SimPort(SimBus(ROBOT), RealClock())


def behind_tty(tty: Path) -> Port:
    return SerialPort(str(tty), BAUD)


@pytest.fixture(params=[in_process, behind_tty])
def port(request: pytest.FixtureRequest, tty: Path) -> Iterator[Port]:
    opened = request.param(tty)
    yield opened
    opened.close()


def collect(port: Port, enough: Callable[[bytes], bool]) -> bytes:
    data, until = b"", time.monotonic() + 5
    while not enough(data) and time.monotonic() < until:
        data += port.read(4096, 0.5)
    return data


def test_what_is_written_is_answered(port: Port) -> None:
    port.write(packet.ping(1))
    data = collect(port, lambda d: len(d) >= 14)
    assert PacketDecoder().feed(data)[0].parameters[:2] == (1020).to_bytes(2, "little")


def test_reading_nothing_takes_the_time_and_returns_nothing(port: Port) -> None:
    start = time.monotonic()
    assert port.read(100, 0.05) == b""
    assert time.monotonic() - start >= 0.045


def test_no_more_is_read_than_asked_for_and_nothing_is_lost(port: Port) -> None:
    port.write(packet.ping(1))
    data = b""
    while len(data) < 14:
        piece = port.read(3, 2.0)
        assert 1 <= len(piece) <= 3
        data += piece
    assert len(PacketDecoder().feed(data)) == 1


def test_a_sync_read_brings_the_servos_in_order(port: Port) -> None:
    ids = ROBOT.servo_ids
    port.write(packet.sync_read(132, 4, ids))
    found = PacketDecoder().feed(collect(port, lambda d: len(d) >= 15 * len(ids)))
    assert [p.servo_id for p in found] == list(ids)


def test_closing_twice_is_harmless(port: Port) -> None:
    port.close()
    port.close()


def test_the_stock_sdk_pings_reads_writes_and_syncs_the_servos_on_the_tty(
    tty: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "dynamixel_sdk.port_handler.LATENCY_TIMER", 1000
    )  # ms that it waits: 16 are few on a busy machine
    port, handler = PortHandler(str(tty)), PacketHandler(2.0)
    assert port.openPort()
    assert port.setBaudRate(BAUD)
    try:
        model, result, error = handler.ping(port, 19)
        assert (model, result, error) == (1020, 0, 0)
        assert handler.write1ByteTxRx(port, 19, 64, 1) == (0, 0)
        assert handler.read1ByteTxRx(port, 19, 64) == (1, 0, 0)
        write = GroupSyncWrite(port, handler, 116, 4)
        for servo_id in (19, 20):
            assert write.addParam(servo_id, list((2100).to_bytes(4, "little")))
        assert write.txPacket() == 0
        read = GroupSyncRead(port, handler, 116, 4)
        for servo_id in (19, 20):
            assert read.addParam(servo_id)
        assert read.txRxPacket() == 0
        assert [read.getData(i, 116, 4) for i in (19, 20)] == [2100, 2100]
    finally:
        port.closePort()


def test_at_another_baud_the_servos_are_silent(tty: Path) -> None:
    port = SerialPort(str(tty), 57600)
    port.write(packet.ping(1))
    assert port.read(100, 0.2) == b""
    port.close()


def test_a_second_owner_is_told_who_the_first_is(tty: Path) -> None:
    first = SerialPort(str(tty), BAUD)
    with pytest.raises(PortBusyError, match=f"process {os.getpid()}"):
        SerialPort(str(tty), BAUD)
    first.close()
    SerialPort(str(tty), BAUD).close()


def test_a_missing_device_is_named_with_where_to_look() -> None:
    with pytest.raises(PortMissingError, match=r"/dev/ttyNONE.*ls /dev/serial"):
        SerialPort("/dev/ttyNONE", 1_000_000)


@pytest.mark.skipif(os.geteuid() != 0, reason="needs root, to give a device that another user may not open")
def test_a_forbidden_device_comes_with_the_command_that_helps(tty: Path) -> None:
    device = os.path.realpath(tty)
    os.chmod(device, 0o000)
    os.seteuid(65534)
    try:
        with pytest.raises(PortPermissionError, match="usermod -a -G dialout"):
            SerialPort(device, BAUD)
    finally:
        os.seteuid(0)


def test_a_tty_whose_other_end_closes_is_lost(tmp_path: Path) -> None:
    server = PtyServer(SimBus(ROBOT), tmp_path / "servos")
    port = SerialPort(str(tmp_path / "servos"), BAUD)
    server.close()
    with pytest.raises(LinkLostError, match="lost"):
        for _ in range(3):
            port.write(packet.ping(1))
            port.read(10, 0.05)
    port.close()


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("usb://x", "unknown scheme 'usb'; known: dxl://, sim://"),
        ("sim://?speed=3", "allowed: sim://"),
        ("sim://?baud=fast", "baud 'fast' is not a number"),
        ("dxl://", "no device"),
        ("dxl:///dev/x?baud=fast", "baud 'fast' is not a number"),
        ("dxl:///dev/x?speed=3", "speed; allowed: dxl://PATH"),
    ],
)
def test_a_bus_url_that_means_nothing_is_refused_with_what_is_allowed(url: str, said: str) -> None:
    with pytest.raises(CommandError) as caught:
        open_port(url, PortContext(ROBOT, RealClock()))
    assert said in str(caught.value)


def test_the_robots_own_baud_is_taken_when_the_url_names_none(tty: Path) -> None:
    port = open_dxl(urlsplit(f"dxl://{tty}"), PortContext(ROBOT, RealClock()))
    assert port.baud == 2_000_000
    port.close()


@pytest.mark.parametrize("lost", ["_update_dtr_state", "_reconfigure_port", "_reset_input_buffer"])
@pytest.mark.parametrize("error", [OSError(5, "Input/output error"), termios.error(5, "Input/output error")])
def test_an_adapter_that_is_lost_while_it_is_opened_is_a_lost_port(
    tty: Path, monkeypatch: pytest.MonkeyPatch, lost: str, error: Exception
) -> None:
    port = SerialPort(str(tty), BAUD)

    def fail(*_: object, **__: object) -> None:
        raise error

    with monkeypatch.context() as patch:
        patch.setattr(serial.Serial, lost, fail)
        with pytest.raises(LinkLostError, match="Input/output error"):
            port.reopen()
    port.reopen()
    port.close()
