"""The bus cycle with other clients: dynamixel-sdk, rustypot (extra `bench`), and a minimal C program where there is a compiler."""

from __future__ import annotations

import importlib
import importlib.util
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from daemon.bench.wire_emulator import POSITION_TICK
from daemon.dynamixel.codec.packet import sync_read, sync_write

Cycle = Callable[[], bool]
"""Runs one cycle; returns whether every servo's position was right."""
Peer = Callable[[str, int, list[int]], tuple[Cycle, Callable[[], None]]]
"""Maps (tty, baud, ids) to a cycle and a function that closes the peer."""


def sdk(device: str, baud: int, ids: list[int], *, fast: bool = False) -> tuple[Cycle, Callable[[], None]]:
    """A cycle of dynamixel-sdk: GroupSyncWrite and GroupSyncRead, with three values extracted for each servo."""
    lib: Any = importlib.import_module("dynamixel_sdk")
    port = lib.PortHandler(device)
    handler = lib.PacketHandler(2.0)
    port.openPort()
    port.setBaudRate(baud)
    write, read = lib.GroupSyncWrite(port, handler, 116, 4), lib.GroupSyncRead(port, handler, 126, 10)
    goal = list(POSITION_TICK.to_bytes(4, "little"))
    for i in ids:
        write.addParam(i, goal)
        read.addParam(i)

    def cycle() -> bool:
        for i in ids:
            write.changeParam(i, goal)
        write.txPacket()
        (read.fastSyncRead if fast else read.txRxPacket)()
        values = [(read.getData(i, 126, 2), read.getData(i, 128, 4), read.getData(i, 132, 4)) for i in ids]
        return all(v[2] == POSITION_TICK for v in values)

    return cycle, port.closePort


def rustypot(device: str, baud: int, ids: list[int], *, fast: bool = False) -> tuple[Cycle, Callable[[], None]]:
    """A cycle of rustypot's XL430 controller, whose raw blocks are split here."""
    lib: Any = importlib.import_module("rustypot")
    controller = lib.Xl430PyController(device, baud, 0.05)
    if fast:
        controller.set_fast_sync_read(True)
    goals = [list(POSITION_TICK.to_bytes(4, "little"))] * len(ids)

    def cycle() -> bool:
        controller.sync_write_raw_data(ids, 116, goals)
        try:
            rows = controller.sync_read_raw_data(ids, 126, 10)
        except (RuntimeError, OSError):
            return False
        data = np.array([list(row) for row in rows], np.uint8)
        return bool((np.ascontiguousarray(data[:, 6:10]).view("<i4")[:, 0] == POSITION_TICK).all())

    def close() -> None:
        close_ = getattr(controller, "close", None)
        if close_ is not None:
            close_()

    return cycle, close


PEERS: dict[str, Callable[..., tuple[Cycle, Callable[[], None]]]] = {"dynamixel-sdk": sdk, "rustypot": rustypot}
MODULES = {"dynamixel-sdk": "dynamixel_sdk", "rustypot": "rustypot"}


def installed() -> list[str]:
    """Names of the peers that can run on this machine."""
    return [name for name, module in MODULES.items() if importlib.util.find_spec(module) is not None]


def sdk_codec_us(ids: list[int], reply: bytes, n: int = 300) -> float:
    """Median microseconds in which dynamixel-sdk builds the goals, parses these answers and extracts the values, without I/O."""
    lib: Any = importlib.import_module("dynamixel_sdk")

    class Wire:
        """A port in memory."""

        is_using = False

        def __init__(self) -> None:
            self._left = b""

        def clearPort(self) -> None:  # noqa: N802 - the SDK's names
            self._left = reply

        def writePort(self, data: list[int]) -> int:  # noqa: N802
            return len(data)

        def readPort(self, length: int) -> list[int]:  # noqa: N802
            out, self._left = list(self._left[:length]), self._left[length:]
            return out

        def setPacketTimeout(self, _length: int) -> None:  # noqa: N802
            """Do nothing, as this port never waits."""

        def isPacketTimeout(self) -> bool:  # noqa: N802
            return not self._left

    wire, handler = Wire(), lib.PacketHandler(2.0)
    write, read = lib.GroupSyncWrite(wire, handler, 116, 4), lib.GroupSyncRead(wire, handler, 126, 10)
    goal = list(POSITION_TICK.to_bytes(4, "little"))
    for i in ids:
        write.addParam(i, goal)
        read.addParam(i)
    took: list[float] = []
    for _ in range(n):
        start_s = time.perf_counter()
        for i in ids:
            write.changeParam(i, goal)
        write.txPacket()
        read.txRxPacket()
        for i in ids:
            for address, size in ((126, 2), (128, 4), (132, 4)):
                read.getData(i, address, size)
        took.append(time.perf_counter() - start_s)
    return float(np.median(took)) * 1e6


def c_client_us(device: str, ids: list[int], reply_bytes: int, seconds: float, *, fast: bool) -> float | None:
    """Median cycle in microseconds of the minimal C client on this tty; None without a C compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        return None
    request = sync_write(116, 4, [(i, POSITION_TICK.to_bytes(4, "little")) for i in ids]) + sync_read(
        126, 10, ids, fast=fast
    )
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "wire_client"
        source = Path(__file__).with_name("wire_client.c")
        subprocess.run([compiler, "-O2", "-o", str(program), str(source)], check=True, capture_output=True)
        command = [str(program), device, request.hex(), str(reply_bytes), str(seconds)]
        out = subprocess.run(command, check=True, capture_output=True, text=True, timeout=seconds + 30).stdout
    return float(np.median([float(line) for line in out.split()]))
