"""The main job, shown: simulated servos on a tty, the daemon on them, three texts, pictures, the log replayed."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from daemon.client import Client
from daemon.errors import DaemonError
from daemon.recording.mcap_reading import Log, read_log
from daemon.settings.config import Endpoints
from daemon.wire.events import Accepted, AnyEvent, Cancelled, Done, Progress, Refusal
from daemon.wire.requests import Say
from retarget.robot.robot import RobotModel
from sim.audit.audit import Audit

if TYPE_CHECKING:
    from daemon.pictures.performance import Performance

START_TIMEOUT_S = 60.0
STOP_TIMEOUT_S = 40.0
INTERRUPT_AFTER_S = 1.3
FILM_PX, FILM_FPS = (480, 360), 10.0
"""Width and height of the film in pixels, and its frames a second."""


@dataclass
class Shown:
    """The events of one text."""

    text: str
    seed: int
    events: list[AnyEvent] = field(default_factory=list[AnyEvent])

    @property
    def accepted(self) -> Accepted | None:
        """The event that accepted the text; None when it was refused."""
        return next((e for e in self.events if isinstance(e, Accepted)), None)

    @property
    def end(self) -> AnyEvent | None:
        """The event that ended the text's command; None before."""
        return self.events[-1] if self.events else None


def free_endpoints() -> Endpoints:
    """Endpoints on three free loopback ports."""
    ports: list[int] = []
    held: list[socket.socket] = []
    for _ in range(3):
        s = socket.socket()
        s.bind(("127.0.0.1", 0))
        held.append(s)
        ports.append(s.getsockname()[1])
    for s in held:
        s.close()
    cmd, ctl, pub = (f"tcp://127.0.0.1:{port}" for port in ports)
    return Endpoints(cmd, ctl, pub)


@contextmanager
def child(arguments: list[str], log: Path) -> Generator[subprocess.Popen[bytes]]:
    """Run a subcommand of mmmd in its own process, which ends with the block at the latest."""
    command, process = [sys.executable, "-m", "daemon.cli", *arguments], None
    with log.open("wb") as f:
        try:
            with _sigterm_waits():  # else a child that was just started would be left behind
                process = subprocess.Popen(command, stdout=f, stderr=subprocess.STDOUT, start_new_session=True)
            yield process
        finally:
            if process is not None:
                end(process)


@contextmanager
def _sigterm_waits() -> Generator[None]:
    """Delay a SIGTERM to the end of the block. Blocking the signal instead would be inherited by children."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    before = signal.signal(signal.SIGTERM, lambda number, _frame: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
        if came:
            signal.raise_signal(signal.SIGTERM)


def end(process: subprocess.Popen[bytes]) -> int:
    """Ask a child to end (it parks), wait, and kill it only when it does not; returns its exit status."""
    if process.poll() is None:
        process.send_signal(signal.SIGTERM)
        try:
            process.wait(STOP_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait(5)
    return process.returncode


def wait_until_ready(client: Client, process: subprocess.Popen[bytes], log: Path) -> None:
    """Wait for the daemon and its generator.

    Raises:
        DaemonError: the daemon ended, or is not ready in time.
    """
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline:
        if process.poll() is not None:
            raise DaemonError(f"the daemon ended: {log.read_text('utf-8', 'replace')[-2000:]}")
        try:
            if client.status().generator.startswith("ready"):
                return
        except DaemonError:
            pass
        time.sleep(0.1)
    raise DaemonError(f"the daemon was not ready within {START_TIMEOUT_S:.0f} s; its log: {log}")


def perform(client_endpoints: Endpoints, shown: list[Shown]) -> None:
    """Send the texts: the second waits for the first, the third comes while the second still moves."""
    threads: list[threading.Thread] = []
    for i, one in enumerate(shown):
        thread = threading.Thread(target=_say, args=(client_endpoints, one))
        thread.start()
        threads.append(thread)
        if i == 1:
            _wait_for_motion(one)
            time.sleep(INTERRUPT_AFTER_S)
        else:
            thread.join(60)
    for thread in threads:
        thread.join(60)


def _wait_for_motion(one: Shown) -> None:
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline and not any(isinstance(e, Progress | Refusal) for e in one.events):
        time.sleep(0.02)


def _say(endpoints: Endpoints, one: Shown) -> None:
    with Client(endpoints) as client:
        for event in client.events_of(Say(id=f"demo-{one.seed}-{one.text}", text=one.text, seed=one.seed)):
            one.events.append(event)


def audited_plans(log: Log, robot: RobotModel) -> dict[int, tuple[int, int]]:
    """Goals and violations of each plan in a log, by the simulator's audit."""
    audit = Audit(robot)
    counts: dict[int, tuple[int, int]] = {}
    torque = False
    for cycle in log.cycles:
        before, t_s = (audit.goals, sum(audit.violations.values())), cycle.t_mono_ns * 1e-9
        for servo, tick, present in zip(robot.servos, cycle.goal_tick, cycle.present_tick, strict=True):
            if cycle.torque != torque:
                audit.torque(t_s, servo.servo_id, cycle.torque, tick, present)
            if cycle.torque:
                audit.goal(t_s, servo.servo_id, tick, True)
        torque = cycle.torque
        goals, violations = counts.get(cycle.plan_id, (0, 0))
        after = (audit.goals, sum(audit.violations.values()))
        counts[cycle.plan_id] = (goals + after[0] - before[0], violations + after[1] - before[1])
    return counts


def describe(one: Shown, audited: dict[int, tuple[int, int]]) -> list[str]:
    """Lines for people about one text."""
    accepted, last = one.accepted, one.end
    lines = [f'"{one.text}"']
    if accepted is None:
        return [*lines, f"  refused: {last.message if isinstance(last, Refusal) else 'no answer'}"]
    lines.append(f"  {accepted.status}: {accepted.understood}; generated in {accepted.generate_ms:.0f} ms")
    if isinstance(last, Done):
        first = "-" if last.first_motion_ms is None else f"{last.first_motion_ms:.0f} ms"
        lines.append(f"  first moving servo frame {first} after the text; duration {last.duration_s:.2f} s")
        lines.append(
            f"  peak speed {degrees(last.peak_speed_rad_s):.0f} deg/s of {degrees(last.peak_speed_limit_rad_s):.0f} allowed"
            f" ({last.peak_speed_joint}); clipped frames {last.clipped_frames}; direction error {last.direction_error_deg} deg"
        )
    elif isinstance(last, Cancelled):
        lines.append("  cancelled: the next text took over while the robot moved")
    goals, violations = audited.get(accepted.plan_id, (0, 0))
    lines.append(f"  audit: {violations} violations in {goals} goals")
    return lines


def draw(shown: list[Shown], log: Log, robot: RobotModel, out: Path) -> tuple[list[Path], str]:
    """Draw a plot of the joints, a film and a contact sheet of a run; the text says why the last two are missing, else empty.

    The persons beside the robot are generated again from text and seed.
    """
    from daemon.pictures.drawing import contact_sheet, frames
    from daemon.pictures.errors import NoOpenGLError
    from daemon.pictures.film import write_film
    from daemon.pictures.joints import joint_plot
    from daemon.pictures.performance import cut, of_run

    sheet, film, plot = out / "contact_sheet.png", out / "film.gif", out / "joints.png"
    joint_plot(log, robot, plot)
    performances = _performances(shown, log, robot)
    if not performances:
        return [plot], ""
    try:
        contact_sheet(performances).save(sheet)
        run = of_run(log, robot, FILM_FPS)
        moves = next(i for i, caption in enumerate(run.captions) if caption == performances[0].captions[0])
        write_film(frames(cut(run, moves), "robot", "half", FILM_PX), film, FILM_FPS)
    except NoOpenGLError as error:
        return [plot], f"no contact sheet and no film: {error}"
    return [film, sheet, plot], ""


def _performances(shown: list[Shown], log: Log, robot: RobotModel) -> list[Performance]:
    """The played part of each text's motion: the person beside the robot's goals."""
    from daemon.pictures.performance import of_motion
    from mmm_core.generate.engine import Engine

    engine = Engine.load(threads=1)
    found: list[Performance] = []
    for one in shown:
        goals = [c.goal_rad for c in log.cycles if one.accepted is not None and c.plan_id == one.accepted.plan_id]
        if goals:
            motion = engine.generate(one.text, seed=one.seed).motion
            frame_s = np.arange(0.0, len(goals) / robot.bus.rate_hz, 1.0 / motion.fps)
            cycles = np.minimum((frame_s * robot.bus.rate_hz).astype(int), len(goals) - 1)
            found.append(of_motion(motion, robot, one.text, np.array(goals)[cycles]))
    return found


def replayed(log_file: Path) -> dict[str, Any]:
    """The report of `mmmd replay` about a log."""
    command = [sys.executable, "-m", "daemon.cli", "replay", str(log_file), "--bus", "sim://", "--json"]
    done = subprocess.run(command, capture_output=True, timeout=120, check=False)
    if done.returncode not in (0, 1) or not done.stdout.strip():
        raise DaemonError(f"replay failed: {done.stderr.decode('utf-8', 'replace')[-1000:]}")
    return json.loads(done.stdout)


def read_run(log_file: Path) -> Log:
    """The log of the run."""
    return read_log(log_file)
