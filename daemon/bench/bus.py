"""`mmmd bench bus`: the codec alone, and the bus driver against servos that keep the time of a wire (`wire_emulator`)."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from typing import Any

import numpy as np
from rich.console import Console

from daemon.bench.bus_peers import PEERS, c_client_us, installed, sdk_codec_us
from daemon.bench.report import context
from daemon.bench.wire_emulator import CURRENT_RAW, POSITION_TICK, VELOCITY_RAW
from daemon.dynamixel.codec.group import GroupWrite
from daemon.dynamixel.codec.packet import Part, fast_status, status
from daemon.dynamixel.feedback import FastSyncStep, SyncStep
from daemon.dynamixel.ports.serial_port import SerialPort
from daemon.dynamixel.reading import BusReading
from daemon.dynamixel.servo_bus import ServoBus
from daemon.host.clock import RealClock
from retarget.robot.robot import ServoSpec
from retarget.robot.servos import servo_models

N_SERVOS = 20
IDS = list(range(1, N_SERVOS + 1))
BAUDS = (1_000_000, 2_000_000, 4_000_000)
LOSSES = (0.001, 0.01)
_FIFO = 40
_NO_BAUD = 100_000_000
"""Bits per second set in the driver where there is no wire, so that it does not wait for bytes on a wire."""
_WARM_CYCLES, _BLOCK = 50, 10
_METHOD = (
    "20 servos on a pty whose other end, a process of its own, holds every byte back for its time on the wire; a cycle"
    " writes 20 goals and reads current, velocity and position of all, as the daemon's does."
    " share: wire time / median cycle (means of ten); cpu_us: processor time of one. loss at"
    " 1 Mbit/s by sync and by fast sync read (of each servo's part; a fast answer ends there), dead servo by sync read, rates"
    " by mean. codec_us: build goals, parse 20 answers, store the values;"
    " median of five medians, taken between the others"
)


def bench_bus(seconds: float = 3.0, seed: int = 0) -> dict[str, Any]:
    """`codec_us`; the driver's rates under `wire`, `no_wire`, `loss` and `peers`; `dead_servo_rate_share`."""
    console = Console(stderr=True)
    realtime = _take_fifo()
    figures: dict[str, Any] = {"wire": {}}
    codec: list[tuple[float, float]] = []
    for baud in BAUDS:
        codec.append(_codecs_us())
        row = _wire(baud, fast=False, seconds=seconds) | {"fast": _wire(baud, fast=True, seconds=seconds)}
        figures["wire"][str(baud)] = row
        console.print(f"{baud} baud: {row}")
    codec.append(_codecs_us())
    figures["no_wire"] = {name: _no_wire(fast=name == "fast", seconds=seconds) for name in ("sync", "fast")}
    console.print(f"no wire: {figures['no_wire']}")
    codec.append(_codecs_us())
    figures["codec_us"], figures["codec_fast_us"] = np.median(codec, 0).round(2).tolist()
    console.print(f"codec {figures['codec_us']} us, fast {figures['codec_fast_us']} us; of {codec}")
    figures |= _losses(seconds)
    console.print(
        f"loss: {figures['loss']}; fast: {figures['loss_fast']}; dead servo: {figures['dead_servo_rate_share']}"
    )
    figures["peers"] = {name: _peer(name, seconds) for name in installed()}
    console.print(f"peers: {figures['peers']}")
    return figures | {"servos": N_SERVOS, "realtime": realtime, **context(seed, _METHOD)}


def _take_fifo() -> bool:
    """Give this process FIFO priority, as the bus process has it; return whether the system allowed this."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_FIFO))
    except OSError:
        return False
    return True


def _codecs_us() -> tuple[float, float]:
    """Median codec times in microseconds, with sync read and with fast sync read."""
    return _codec_us(fast=False), _codec_us(fast=True)


def _codec_us(*, fast: bool) -> float:
    """Median microseconds to build the goals and to parse and store the answers of all servos."""
    write = GroupWrite(IDS, 116, 4)
    step = (FastSyncStep if fast else SyncStep)(list(range(N_SERVOS)), IDS)
    reading, goals = BusReading.of(N_SERVOS), np.full(N_SERVOS, POSITION_TICK, np.int32)
    raw = bytearray(_reply(fast=fast))
    took: list[float] = []
    for _ in range(5000):
        start_s = time.perf_counter()
        write.frame(goals)
        whole = step.take(raw, reading)
        took.append(time.perf_counter() - start_s)
        assert whole.all()
    return round(float(np.median(took)) * 1e6, 2)


def _reply(*, fast: bool) -> bytes:
    rng = np.random.default_rng(0)
    rows = [bytes(rng.integers(0, 250, 10, dtype=np.uint8)) for _ in IDS]
    if fast:
        return fast_status([Part(i, 0, row) for i, row in zip(IDS, rows, strict=True)])
    return b"".join(status(i, 0, row) for i, row in zip(IDS, rows, strict=True))


@contextmanager
def _emulator(baud: int, *, fast: bool = True, loss: float = 0.0, dead: int = 0) -> Generator[str]:
    """The tty of emulated servos at `baud` (0: a wire that takes no time)."""
    options = [f"--servos={N_SERVOS}", f"--baud={baud}", f"--loss={loss}", f"--dead={dead}"]
    options += ["--fast"] if fast else []
    if os.sched_getscheduler(0) == os.SCHED_FIFO:
        options.append(f"--fifo={_FIFO}")
    command = [sys.executable, "-m", "daemon.bench.wire_emulator", *options]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdin is not None and process.stdout is not None
    try:
        yield process.stdout.readline().strip()
    finally:
        process.stdin.close()
        process.wait(10)
        process.stdout.close()


@contextmanager
def _bus(device: str, baud: int, *, verify: bool = True) -> Generator[ServoBus]:
    model = servo_models()["XM430-W350"]
    servos = [ServoSpec.direct(i, f"joint_{i}", model) for i in IDS]
    port = SerialPort(device, baud)
    try:
        bus = ServoBus.on_port(port, servos, RealClock())
        if verify:
            bus.verify()
        yield bus
    finally:
        port.close()


def _timed(cycle: Callable[[], object], seconds: float) -> tuple[np.ndarray[Any, Any], float]:
    """(N,) seconds of a cycle, each the mean of ten in a row, and processor seconds of a cycle.

    The mean of ten is taken because a cycle whose end is noticed late makes the next one look short.
    """
    for _ in range(_WARM_CYCLES):
        cycle()
    took: list[float] = []
    cpu_s, end_s = time.process_time(), time.perf_counter() + seconds
    at_s = time.perf_counter()
    while at_s < end_s:
        cycle()
        now_s = time.perf_counter()
        took.append(now_s - at_s)
        at_s = now_s
    blocks = np.array(took[: max(1, len(took) // _BLOCK) * _BLOCK]).reshape(-1, min(_BLOCK, len(took))).mean(axis=1)
    return blocks, (time.process_time() - cpu_s) / len(took)


def _run(bus: ServoBus, seconds: float) -> tuple[np.ndarray[Any, Any], float, float]:
    """(N,) seconds of each cycle, processor seconds of one, and the share of values that were valid and right."""
    goals, valid = np.full(N_SERVOS, POSITION_TICK, np.int32), [0, 0]

    def cycle() -> None:
        reading = bus.exchange(goals)
        valid[0] += int(reading.valid.sum())
        valid[1] += N_SERVOS

    took, cpu_s = _timed(cycle, seconds)
    r, known = bus.reading, bus.reading.age_cycles < len(took)
    right = (r.position_tick == POSITION_TICK) & (r.velocity_raw == VELOCITY_RAW) & (r.current_raw == CURRENT_RAW)
    if not right[known].all():
        raise RuntimeError(f"wrong values came back: {r}")
    return took, cpu_s, valid[0] / valid[1]


def _wire(baud: int, *, fast: bool, seconds: float) -> dict[str, Any]:
    with _emulator(baud, fast=fast) as device:
        with _bus(device, baud) as bus:
            plan = bus.plan()
            took, cpu_s, _ = _run(bus, seconds)
        client_us = c_client_us(device, IDS, plan.reply_bytes, min(seconds, 2.0), fast=fast)
    cycle_s = float(np.median(took))
    row: dict[str, Any] = {
        "share": round(plan.wire_s / cycle_s, 4), "mean_share": round(plan.wire_s / float(took.mean()), 4),
        "cpu_us": round(cpu_s * 1e6, 1), "cycle_us": round(cycle_s * 1e6, 1), "wire_us": round(plan.wire_s * 1e6, 1),
    }  # fmt: skip
    if client_us is not None:
        row |= {"c_client_us": client_us, "share_of_c_client": round(client_us / cycle_s / 1e6, 4)}
    return row


def _no_wire(*, fast: bool, seconds: float) -> dict[str, float]:
    with _emulator(0, fast=fast) as device, _bus(device, _NO_BAUD) as bus:
        took, cpu_s, _ = _run(bus, seconds)
    return {
        "cycles_per_s": round(1 / float(took.mean())), "median_us": round(float(np.median(took)) * 1e6, 1),
        "cpu_us": round(cpu_s * 1e6, 1),
    }  # fmt: skip


def _losses(seconds: float) -> dict[str, Any]:
    """Rates with losses and with a dead servo, as shares of the rate without."""
    loss, whole_hz = _loss(seconds, fast=False)
    loss_fast, whole_fast_hz = _loss(seconds, fast=True)
    with _emulator(BAUDS[0], fast=False, dead=7) as device, _bus(device, BAUDS[0], verify=False) as bus:
        goals = np.full(N_SERVOS, POSITION_TICK, np.int32)
        start_s = time.perf_counter()
        while bus.chains[0].link.health.asked.all():
            bus.exchange(goals)
        before_hz = int(bus.timeouts[6]) / (time.perf_counter() - start_s)
        took, _, _ = _run(bus, 2 * seconds)
    return {
        "loss": loss,
        "loss_fast": loss_fast,
        "lossless_hz": round(whole_hz, 1),
        "lossless_fast_hz": round(whole_fast_hz, 1),
        "dead_servo_rate_share": round(1 / float(took.mean()) / whole_hz, 4),
        "dead_servo_rate_share_before_quarantine": round(before_hz / whole_hz, 4),
    }


def _loss(seconds: float, *, fast: bool) -> tuple[dict[str, Any], float]:
    """Rate with each loss as a share of the rate without, share of valid values; and that rate."""
    rates: dict[float, tuple[float, float]] = {}
    for loss in (0.0, *LOSSES):
        with _emulator(BAUDS[0], fast=fast, loss=loss) as device, _bus(device, BAUDS[0]) as bus:
            took, _, valid = _run(bus, 2 * seconds)
            rates[loss] = 1 / float(took.mean()), valid
    whole_hz = rates.pop(0.0)[0]
    shares = {
        str(loss): {"rate_share": round(hz / whole_hz, 4), "valid_share": round(valid, 5)}
        for loss, (hz, valid) in rates.items()
    }
    return shares, whole_hz


def _peer(name: str, seconds: float) -> dict[str, Any]:
    """Figures of the bus cycle of `bus` with a peer's driver: at 1 and 4 Mbit/s, without a wire, and with 0.1 % of replies lost."""
    figures: dict[str, Any] = {}
    if name == "dynamixel-sdk":
        figures["codec_us"] = round(sdk_codec_us(IDS, _reply(fast=False)), 1)
    wire_bytes = 114 + 34 + 420
    for label, baud, loss in (
        ("1000000", BAUDS[0], 0.0),
        ("4000000", BAUDS[2], 0.0),
        ("no_wire", 0, 0.0),
        ("loss 0.001", 0, 0.001),
    ):
        with _emulator(baud, fast=False, loss=loss) as device:
            cycle, close = PEERS[name](device, baud or 4_000_000, IDS)
            right: list[bool] = []
            took, cpu_s = _timed(lambda cycle=cycle, right=right: right.append(cycle()), seconds)
            close()
        row = {
            "cycles_per_s": round(1 / float(took.mean())),
            "cpu_us": round(cpu_s * 1e6, 1),
            "whole_share": float(np.mean(right)),
        }
        if baud:
            row["share"] = round(wire_bytes * 10 / baud / float(np.median(took)), 4)
        figures[label] = row
    return figures
