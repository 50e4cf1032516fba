"""Servos on a pty that model only the timing of a wire, against which `mmmd bench bus` measures clients.

Answers are built once and looked up; nothing moves, and writes are not checked. With `--baud 0` every request is answered at once.
Run as `python -m daemon.bench.wire_emulator`; prints the tty, serves until its standard input closes.
"""

from __future__ import annotations

import argparse
import os
import pty
import random
import select
import struct
import sys
import time
import tty

from daemon.dynamixel.codec.packet import BROADCAST_ID, HEADER, Instruction, Part, fast_status, status
from daemon.dynamixel.registers.models import MODELS

MODEL_NUMBER, FIRMWARE = 1020, 52
POSITION_TICK, VELOCITY_RAW, CURRENT_RAW = 2048, -3, -7
_SPIN_S = 0.00015
"""Seconds by which a sleep ends late; the rest of the time to an answer is spent in a busy loop."""
_PING_BYTES = 3


def memory(servo_id: int) -> bytes:
    """Control table of a servo from the factory, in its middle position."""
    table, out = MODELS[MODEL_NUMBER].table, bytearray(256)
    values = {
        "model_number": MODEL_NUMBER, "firmware_version": FIRMWARE, "id": servo_id, "return_delay_time": 0,
        "present_position": POSITION_TICK, "present_velocity": VELOCITY_RAW, "present_current": CURRENT_RAW,
    }  # fmt: skip
    for item in table.values():
        out[item.address : item.end] = item.encode(values.get(item.name, item.initial or 0))
    return bytes(out)


class Emulator:
    """The servos 1 to n behind one end of a pty.

    Args:
        n: servos.
        baud: bits per second; 0 for a wire that takes no time.
        loss: share of status packets that are lost, 0 to 1.
        dead: id of a servo that never answers; 0 for none.
        fast: whether the servos know fast sync reads.
        seed: seed of the losses.
    """

    def __init__(self, n: int, baud: int, loss: float, dead: int, *, fast: bool, seed: int = 0) -> None:
        self._byte_s = 10 / baud if baud else 0.0
        self._loss, self._dead, self._fast = loss, dead, fast
        self._random = random.Random(seed)
        self._memory = {i: memory(i) for i in range(1, n + 1)}
        self._cache: dict[bytes, list[bytes]] = {}
        self._fd, slave = pty.openpty()
        tty.setraw(slave)
        self.device, self._slave = os.ttyname(slave), slave  # our own end stays open, so that clients may come and go

    def serve(self) -> None:
        """Answer until standard input closes."""
        poll = select.poll()
        poll.register(self._fd, select.POLLIN)
        poll.register(sys.stdin.fileno(), select.POLLIN | select.POLLHUP)
        pending, free_s = b"", 0.0
        while True:
            ready = dict(poll.poll())
            if sys.stdin.fileno() in ready:
                return
            data = os.read(self._fd, 4096)
            heard_s = max(time.perf_counter(), free_s) + len(data) * self._byte_s
            pending += data
            while (end := _end(pending)) is not None:
                request, pending = pending[:end], pending[end:]
                free_s = self._answer(request, heard_s)

    def _answer(self, request: bytes, at_s: float) -> float:
        """Answer a request, each packet once its last byte is due; return the time at which the wire is free again."""
        for reply in self._replies(request):
            at_s += len(reply) * self._byte_s
            if self._byte_s:
                left_s = at_s - time.perf_counter()
                if left_s > _SPIN_S:
                    time.sleep(left_s - _SPIN_S)
                while time.perf_counter() < at_s:
                    pass
            os.write(self._fd, reply)
        return at_s

    def _replies(self, request: bytes) -> list[bytes]:
        replies = self._cache.get(request)
        if replies is None:
            replies = self._built(request)
            if not self._byte_s:
                replies = [b"".join(replies)] if replies and not self._loss else replies
            if request[7] not in (Instruction.SYNC_WRITE, Instruction.WRITE):
                self._cache[request] = replies
        if not self._loss:
            return replies
        lost = [self._random.random() < self._loss for _ in replies]
        if request[7] == Instruction.FAST_SYNC_READ and True in lost:
            replies = replies[: lost.index(True)]  # no servo continues after a missing part
        kept = [r for r, gone in zip(replies, lost, strict=False) if not gone]
        return [b"".join(kept)] if kept and not self._byte_s else kept

    def _built(self, request: bytes) -> list[bytes]:
        servo_id, kind, parameters = request[4], request[7], request[8:-2]
        there = [servo_id] if servo_id in self._memory and servo_id != self._dead else []
        if kind == Instruction.PING:
            return [status(i, 0, struct.pack("<HB", MODEL_NUMBER, FIRMWARE)) for i in there]
        if kind == Instruction.READ:
            address, length = struct.unpack("<HH", parameters)
            return [status(i, 0, self._memory[i][address : address + length]) for i in there]
        if kind == Instruction.WRITE:
            return [status(i) for i in there]
        if kind in (Instruction.SYNC_READ, Instruction.FAST_SYNC_READ) and servo_id == BROADCAST_ID:
            address, length = struct.unpack_from("<HH", parameters)
            data = {i: self._memory[i][address : address + length] for i in parameters[4:] if i in self._memory}
            if kind == Instruction.SYNC_READ:
                return [status(i, 0, d) for i, d in data.items() if i != self._dead]
            return self._fast_reply(data) if self._fast else []
        return []

    def _fast_reply(self, data: dict[int, bytes]) -> list[bytes]:
        """The common packet in the parts that the servos send; it ends before a dead servo's part."""
        raw, at, out = fast_status([Part(i, 0, d) for i, d in data.items()]), 0, list[bytes]()
        for servo_id, d in data.items():
            if servo_id == self._dead:
                break
            end = at + 4 + len(d) + (8 if not out else 0)
            out.append(raw[at:end])
            at = end
        return out


def _end(data: bytes) -> int | None:
    """Offset at which the first packet of `data` ends, None where it is incomplete; clients are trusted to send packets only."""
    if len(data) < 7 or not data.startswith(HEADER):
        return None
    end = 7 + (data[5] | data[6] << 8)
    return end if end <= len(data) else None


def main() -> None:
    """Serve with the settings of the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--servos", type=int, default=20)
    parser.add_argument("--baud", type=int, default=1_000_000)
    parser.add_argument("--loss", type=float, default=0.0)
    parser.add_argument("--dead", type=int, default=0)
    parser.add_argument("--fast", action="store_true")
    parser.add_argument("--fifo", type=int, default=0)
    a = parser.parse_args()
    if a.fifo:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(a.fifo))
    emulator = Emulator(a.servos, a.baud, a.loss, a.dead, fast=a.fast)
    sys.stdout.write(emulator.device + "\n")
    sys.stdout.flush()
    emulator.serve()


if __name__ == "__main__":
    main()
