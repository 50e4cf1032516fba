"""`mmmd scan`: the servos on a port."""

from __future__ import annotations

import dataclasses
import json as json_module
from typing import Annotated

import tyro


def scan(
    device: Annotated[str, tyro.conf.Positional],
    baud: tuple[int, ...] = (),
    protocol: tuple[float, ...] = (2.0, 1.0),
    json: bool = False,
) -> int:
    """Look for servos on a port, at every baud and in both protocols. Nothing on the bus is changed.

    Protocol 1.0 is asked id by id: about five seconds for each baud. Exit status 1 when nothing answers.

    Example: mmmd scan /dev/ttyUSB0
    or quicker: mmmd scan /dev/ttyUSB0 --baud 1000000 --protocol 2.0

    Args:
        device: the port, e.g. /dev/ttyUSB0 or a path of /dev/serial/by-id/.
        baud: only these bauds.
        protocol: only these protocols (1.0, 2.0).
        json: print one JSON object instead of a table.
    """
    from rich.console import Console
    from rich.progress import Progress

    from daemon.cli.tables import table_of
    from daemon.dynamixel.ports.serial_port import SerialPort
    from daemon.dynamixel.scan import BAUDS
    from daemon.dynamixel.scan import scan as scan_port
    from daemon.errors import CommandError
    from daemon.host.clock import RealClock

    wrong = [p for p in protocol if p not in (1.0, 2.0)]
    if wrong:
        raise CommandError(f"--protocol {wrong[0]}: there are 1.0 and 2.0")
    bauds = baud or BAUDS
    stderr = Console(stderr=True)
    with Progress(console=stderr, transient=True, disable=json) as progress:
        task = progress.add_task("", total=len(bauds) * len(protocol))
        pairs = [(b, p) for b in bauds for p in protocol]

        def show(now_baud: int, now_protocol: float, share: float) -> None:
            done = pairs.index((now_baud, now_protocol)) + share
            progress.update(task, completed=done, description=f"{now_baud} baud, protocol {now_protocol}")

        result = scan_port(
            lambda b: SerialPort(device, b), RealClock(), bauds=bauds, protocols=protocol, on_progress=show
        )
    console = Console()
    if json:
        rows = [dataclasses.asdict(f) | {"model": f.model_name} for f in result.found]
        others = {"garbled_bauds": result.garbled_bauds, "impossible_bauds": result.impossible_bauds}
        console.out(json_module.dumps({"device": device, "found": rows, **others}))
        return 0 if rows else 1
    columns = ("id", "model", "firmware", "protocol", "baud")
    table = table_of(columns, ("id", "model", "baud"), f"{len(result.found)} servos on {device}")
    for f in result.found:
        table.add_row(str(f.servo_id), f.model_name, str(f.firmware), f"{f.protocol}", str(f.baud))
    console.print(table)
    for b in result.garbled_bauds:
        console.print(
            f"{b} baud: something answered that cannot be read: two servos with the same id? Connect one alone"
        )
    if result.impossible_bauds:
        console.print(f"not looked for: the port does not take {', '.join(map(str, result.impossible_bauds))} baud")
    if len({f.baud for f in result.found} | {f.protocol for f in result.found}) > 2:
        console.print("servos at different bauds or protocols cannot share one bus: mmmd servo baud")
    if result.found:
        from daemon.cli.first_look import fit_line, robots_that_fit

        fitting = robots_that_fit((f.servo_id, f.model_number) for f in result.found)
        console.print(fit_line(fitting, device, result.found[0].baud))
    else:
        console.print(
            "nothing answers: is the supply on, the cable in the right socket, the adapter's switch on its bus?"
        )
    return 0 if result.found else 1
