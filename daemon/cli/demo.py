"""`mmmd demo`: a demonstration without hardware."""

from __future__ import annotations

import contextlib
import json
import subprocess
from pathlib import Path
from typing import Annotated

import tyro

TEXTS = ("wave with your right hand", "raise both arms", "nod twice")


def demo(
    texts: Annotated[tuple[str, ...], tyro.conf.Positional] = (),
    robot: str = "reference",
    out: Path = Path("out/demo"),
    view: bool = False,
) -> int:
    """Start simulated servos on a tty and the daemon on them, send three texts, draw and replay what happened.

    The third text is sent while the robot still moves for the second. Writes run.mcap, film.gif, contact_sheet.png, joints.png,
    audit.json and the logs of both processes. Takes under a minute.

    Example: mmmd demo "clap three times" "cross your arms" "look to the left" --robot op3

    Args:
        texts: three commands of your own.
        robot: name of a packaged robot, or the path of a robot.toml.
        out: folder for what it writes.
        view: serve the page at http://127.0.0.1:5880 and open it; after the texts the robot is yours until Ctrl-C.
    """
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn

    from daemon.client import Client
    from daemon.demo.main_job import (
        Shown,
        audited_plans,
        child,
        describe,
        draw,
        end,
        free_endpoints,
        perform,
        read_run,
        replayed,
        wait_until_ready,
    )
    from daemon.errors import CommandError
    from retarget.robot.loading import load_robot

    if texts and len(texts) != len(TEXTS):
        raise CommandError(f"{len(texts)} texts; the demo takes {len(TEXTS)}, or none for its own")
    console = Console(highlight=False, soft_wrap=True)
    model = load_robot(robot)
    link, log_file, audit_file = _files_in(out)
    shown = [Shown(text, seed) for seed, text in enumerate(texts or TEXTS)]
    endpoints, baud = free_endpoints(), str(model.bus.baud)
    with Progress(SpinnerColumn(), TextColumn("{task.description}"), console=console, transient=True) as bar:
        task = bar.add_task("starting the simulated robot and the daemon")
        with child(
            ["sim", "--robot", robot, "--link", str(link), "--audit", str(audit_file), "--baud", baud], out / "sim.log"
        ) as servos:
            _wait_for(link)
            bus = f"dxl://{link}?baud={baud}"
            ends = ["--cmd", endpoints.cmd, "--ctl", endpoints.ctl, "--pub", endpoints.pub]
            command = [
                "run",
                "--robot",
                robot,
                "--bus",
                bus,
                "--log",
                str(log_file),
                *ends,
                *(["--view"] if view else []),
            ]
            with child(command, out / "daemon.log") as daemon, Client(endpoints) as client:
                wait_until_ready(client, daemon, out / "daemon.log")
                if view:
                    console.print(f"page: {_open_page(out / 'daemon.log')}")
                bar.update(task, description="arming: torque on over the measured pose, then a slow way to rest")
                client.arm()
                bar.update(task, description="three texts, the third while the robot still moves")
                perform(endpoints, shown)
                if view:
                    bar.update(
                        task, description="the robot is yours, on the page; Ctrl-C parks it and draws what happened"
                    )
                    _until_interrupted(daemon)
                bar.update(task, description="parking")
                daemon_status = end(daemon)
            end(servos)
        bar.update(task, description="drawing and replaying")
        log = read_run(log_file)
        audited = audited_plans(log, model)
        pictures, undrawn = draw(shown, log, model, out)
        replay = replayed(log_file)
    for one in shown:
        for line in describe(one, audited):
            console.print(line)
    audit = json.loads(audit_file.read_text("utf-8"))
    same = "the servos received the same goals" if replay["identical"] else f"DIFFERENT: {replay['first_difference']}"
    console.print(f"parked, daemon ended with status {daemon_status}")
    console.print(
        f"whole run: {audit['violations']} limit violations and {audit['self_contacts']} self-contacts in {audit['goals']} goals"
    )
    console.print(f"replay: {replay['same']} of {replay['goals']} goal sets: {same}")
    console.print(undrawn, end="\n" if undrawn else "")
    console.print("written: " + ", ".join(str(p) for p in (log_file, *pictures, audit_file)))
    good = daemon_status == 0 and replay["identical"] and not audit["violations"] and not audit["self_contacts"]
    good = good and not any(violations for _, violations in audited.values())
    return 0 if good and all(one.accepted is not None for one in shown) else 1


def _files_in(out: Path) -> tuple[Path, Path, Path]:
    """Paths of the servos' tty, the log and the audit in the folder, which is made; an earlier demo's log is deleted."""
    out.mkdir(parents=True, exist_ok=True)
    (out / "run.mcap").unlink(missing_ok=True)
    return out / "servos", out / "run.mcap", out / "audit.json"


def _open_page(log: Path) -> str:
    """Open the page that the daemon's log names; return its address."""
    import re
    import time
    import webbrowser

    from daemon.errors import DaemonError

    deadline = time.monotonic() + 20
    while not (found := re.search(r"page at (http://\S+)", log.read_text("utf-8", "replace"))):
        if time.monotonic() > deadline:
            raise DaemonError(f"the page did not come up; see {log}")
        time.sleep(0.05)
    webbrowser.open(found[1])
    return found[1]


def _until_interrupted(daemon: subprocess.Popen[bytes]) -> None:
    """Wait for Ctrl-C, or for the end of the daemon."""
    with contextlib.suppress(KeyboardInterrupt):
        daemon.wait()


def _wait_for(link: Path) -> None:
    import time

    from daemon.errors import DaemonError

    deadline = time.monotonic() + 20
    while not link.exists():
        if time.monotonic() > deadline:
            raise DaemonError(f"the simulated robot did not come up; see {link.parent / 'sim.log'}")
        time.sleep(0.05)
