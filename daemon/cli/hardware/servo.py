"""`mmmd servo`: read and set up one servo."""

from __future__ import annotations

import json as json_module
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

if TYPE_CHECKING:
    from rich.table import Table

    from daemon.dynamixel.registers.registers import Item

Verb = Literal["get", "set", "reboot", "id", "baud"]


def servo(
    verb: Annotated[Verb, tyro.conf.Positional],
    servo_id: Annotated[int, tyro.conf.Positional],
    arguments: Annotated[tuple[str, ...], tyro.conf.Positional] = (),
    bus: str = "dxl:///dev/ttyUSB0?baud=1000000",
    drop: bool = False,
    json: bool = False,
) -> int:
    """Read or set up one servo, of either protocol. Nothing here moves a joint: goals and torque are the daemon's.

    Settings kept without power are written only with torque off, ids only when they are free, values only in the range
    of the manual, and everything is read back. What lets a held joint fall needs --drop. The daemon must not run: it owns
    the port.

    Example: mmmd servo get 3
    or: mmmd servo get 3 present_temperature --bus "dxl:///dev/ttyUSB0?baud=57600"
    or: mmmd servo set 3 return_delay_time 0
    or: mmmd servo id 1 7
    or: mmmd servo baud 7 2000000

    Args:
        verb: get [ITEM ...], set ITEM VALUE, reboot, id NEW, baud NEW.
        servo_id: which servo.
        arguments: of the verb.
        bus: where it is.
        drop: with reboot, and with set of torque_enable 0 or a lower torque_limit: also when the servo holds torque, so
            that its joint falls.
        json: print one JSON object.
    """
    from rich.console import Console

    from daemon.dynamixel.ports.opening import PortContext, open_port
    from daemon.dynamixel.setup.single_servo import find
    from daemon.errors import CommandError
    from daemon.host.clock import RealClock
    from retarget.robot.loading import load_robot

    counts = {"get": None, "set": 2, "reboot": 0, "id": 1, "baud": 1}
    if counts[verb] is not None and len(arguments) != counts[verb]:
        raise CommandError(f"mmmd servo {verb} {servo_id}: takes {counts[verb]} more arguments, got {len(arguments)}")
    number = arguments[-1] if verb in ("set", "id", "baud") else "0"
    if not number.lstrip("-").isdigit():
        raise CommandError(f"mmmd servo {verb}: '{number}' is no whole number")
    console, clock = Console(), RealClock()
    context = PortContext(load_robot("reference"), clock)
    port = open_port(bus, context)
    try:
        one = find(port, clock, servo_id)
        said = {"servo_id": servo_id, "model": one.model.name, "firmware": one.firmware}
        if verb == "get":
            names = arguments or tuple(one.model.table)
            items = [one.item(name) for name in names]  # checked before any request
            values = one.chain.registers.read_items(servo_id, names)
            if json:
                console.out(json_module.dumps(said | {"items": values}))
                return 0
            console.print(_table(f"servo {servo_id}: {one.model.name}, firmware {one.firmware}", items, values))
            return 0
        if verb == "set":
            one.set(arguments[0], int(number), drop=drop)
            did = f"{arguments[0]} = {number}"
        elif verb == "reboot":
            one.reboot(drop=drop)
            did = "rebooted: torque is off, settings in RAM are gone"
        elif verb == "id":
            one.set_id(int(number))
            did = f"its id is now {number}"
        else:
            one.set_baud(int(number))
            port.close()
            port = open_port(_at_baud(bus, number), context)
            find(port, clock, servo_id, one.model.protocol)
            did = f"its baud is now {number}; it answers there"
    finally:
        port.close()
    console.out(json_module.dumps(said | {"did": did}) if json else f"servo {servo_id} ({one.model.name}): {did}")
    return 0


def _table(title: str, items: Sequence[Item], values: Mapping[str, int]) -> Table:
    """A table of a servo's items with values and meanings."""
    from daemon.cli.tables import table_of

    table = table_of(("address", "item", "value", "meaning", "access"), ("item", "value"), title)
    for item in items:
        value = values[item.name]
        meaning = f"{value * item.scale:g} {item.unit}" if item.unit and item.unit != "tick" else ""
        access = ("EEPROM" if item.eeprom else "RAM") + ("" if item.writable else ", read only")
        table.add_row(str(item.address), item.name, str(value), meaning, access)
    return table


def _at_baud(url: str, baud: str) -> str:
    """The URL of the same port at another baud."""
    place, _, query = url.partition("?")
    options = [option for option in query.split("&") if option and not option.startswith("baud=")]
    return f"{place}?{'&'.join([*options, f'baud={baud}'])}"
