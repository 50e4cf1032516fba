"""A servo bus on an emulated chain of chosen models, with its events."""

from __future__ import annotations

from daemon.dynamixel.events import BusEventKind
from daemon.dynamixel.servo_bus import ServoBus
from sim.clock import VirtualClock
from tests.support.servo_emulator import FakePort, fake

X20 = ("XM430-W350",) * 20
ALL_KINDS = ("XM430-W350", "XL430-W250", "XL330-M288", "MX-28", "MX-64", "AX-12A", "AX-18A", "MX-64-2", "2XL430-W250")


def bus_of(
    *names: str, slow_every: int = 0, verify: bool = True, **port: object
) -> tuple[ServoBus, FakePort, VirtualClock]:
    far, servos, clock = fake(*names, **port)
    bus = ServoBus.on_port(far, servos, clock, slow_every=slow_every)
    if verify:
        bus.verify()
    return bus, far, clock


def kinds(bus: ServoBus) -> list[BusEventKind]:
    return [event.kind for event in bus.chains[0].link.events.take()]


def put(far: FakePort, position: int = 1000) -> None:
    """Every servo its own position; speed -5 and effort -7."""
    for i, s in far.servos.items():
        s.set("present_position", position + i)
        s.set("present_speed" if s.model.protocol == 1.0 else "present_velocity", -5)
        s.set(s.model.effort_item, -7)
