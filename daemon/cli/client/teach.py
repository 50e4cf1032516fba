"""`mmmd gesture teach`: a person leads the limp arms, and the measured positions become a gesture.

Nothing here commands a joint: the daemon parks the robot and cuts its torque. Afterwards the robot stays limp until it is armed,
which leads it slowly from its present pose.
"""

from __future__ import annotations

import contextlib
import select
import sys
import time
from collections.abc import Generator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from daemon.cli.connection import Connection
from daemon.cli.play_flags import PlayFlags, built, play
from daemon.cli.program import INTERRUPTED
from daemon.errors import CommandError

if TYPE_CHECKING:
    from daemon.client import Client
    from daemon.gestures.library import GestureLibrary
    from daemon.wire.status import StateEvent
    from retarget.pipeline import Retargeter

SLOW_TEMPO = 0.5
"""Share of its own tempo at which a taught gesture is played back."""
MOST_SECONDS = 60.0
"""Seconds of the longest recording, which is the longest gesture that is kept."""
_SILENCE_S = 2.0
"""Seconds without a measurement after which the recording ends: the daemon is gone."""


@dataclass(frozen=True)
class TeachFlags:
    """Options of teaching a gesture.

    Attributes:
        text: what it shows, in words; its name when not given.
        sides: arms that are kept; those that were moved when not given.
        seconds: length of the recording; until Enter when not given.
        pose: keep the one pose in which the arms are held at the end, for `mmmd inbetween`.
        limp: the trunk, which would fall without torque, is held or leans on something.
        play: arm the robot afterwards and play it at half speed.
        yes: go limp, and play, without a question.
        robot: name or robot.toml, where the daemon's own does not ship with mmmd.
    """

    text: str = ""
    sides: Literal["left", "right", "both"] | None = None
    seconds: float | None = None
    pose: bool = False
    limp: bool = False
    play: bool = False
    yes: bool = False
    robot: str = ""


@dataclass
class _Recording:
    """Measured positions so far.

    Attributes:
        t_s: (N,) times on the daemon's clock.
        q_rad: N rows of J joint angles.
        silent: names of servos that did not answer.
        kept: whether the recording has become a gesture.
        robot_is: state of the robot if the command ends here, in words.
    """

    t_s: list[float] = field(default_factory=list[float])
    q_rad: list[list[float]] = field(default_factory=list[list[float]])
    silent: set[str] = field(default_factory=set[str])
    kept: bool = False
    robot_is: str = "nothing was changed"

    @property
    def seconds(self) -> float:
        return self.t_s[-1] - self.t_s[0] if self.t_s else 0.0

    def add(self, state: StateEvent) -> None:
        self.t_s.append(state.t_mono)
        self.q_rad.append(state.present_rad)
        self.silent.update(servo.joint for servo in state.servos_not_ok)


def teach(name: str, how: TeachFlags, at: Connection, folder: Path | None, *, replace: bool) -> int:
    """Teach a gesture by hand; see `mmmd gesture`."""
    from daemon.gestures.library import GestureLibrary

    if how.seconds is not None and not 0 < how.seconds <= MOST_SECONDS:
        raise CommandError(f"--seconds {how.seconds:g}; allowed: more than 0, {MOST_SECONDS:g} at most")
    library = GestureLibrary(folder)
    replace = _may_take(library, name, how, replace=replace)
    recording = _Recording()
    try:
        with _lost_is_said(recording), at.client() as robot:
            retargeter = _retargeter(robot.status(), how)
            since_s = _make_limp(robot, retargeter, recording, how)
            _record(robot, recording, since_s, how)
            _keep(library, name, recording, retargeter, how, replace=replace)
        return _play(name, recording, how, at)
    except KeyboardInterrupt:
        sys.stderr.write(f"mmmd: interrupted: {recording.robot_is}\n")
        return INTERRUPTED


@contextlib.contextmanager
def _lost_is_said(recording: _Recording) -> Generator[None]:
    """Report a recording that became no gesture, however the block ends."""
    try:
        yield
    finally:
        if recording.t_s and not recording.kept:
            sys.stderr.write(f"\nmmmd: {recording.seconds:.1f} s were recorded and are NOT kept\n")


def _may_take(library: GestureLibrary, name: str, how: TeachFlags, *, replace: bool) -> bool:
    """Whether the gesture may replace another one of its name.

    Raises:
        GestureExistsError: there is one, and neither `replace` nor a person allows replacing it.
        ClipError: the name is not allowed.
    """
    from daemon.errors import GestureExistsError

    try:
        library.check_name(name, replace=replace)
    except GestureExistsError as error:
        if how.yes or not _agreed(f"{str(error).partition(';')[0]}; replace it?", how):
            raise
        return True
    return replace


def _retargeter(status: StateEvent, how: TeachFlags) -> Retargeter:
    """The retargeter of the daemon's robot.

    Raises:
        CommandError: the robot's file is not on this machine.
    """
    from retarget.errors import UnknownRobotError
    from retarget.pipeline import Retargeter
    from retarget.robot.loading import load_robot

    try:
        model = load_robot(how.robot or status.robot)
    except UnknownRobotError:
        if how.robot:
            raise
        do = "give its file: --robot my/robot.toml"
        raise CommandError(f"teach: the daemon's robot '{status.robot}' does not ship with mmmd; {do}") from None
    if list(model.joint_names) != status.joint_names:
        raise CommandError(
            f"teach: {model.path} has other joints than the daemon's robot; give the file that it runs with"
        )
    return Retargeter(model)


def _make_limp(robot: Client, retargeter: Retargeter, recording: _Recording, how: TeachFlags) -> float:
    """Name the joints that go limp, ask, park, cut torque; return a time on the daemon's clock from which the robot is limp.

    Raises:
        CommandError: the trunk would fall, the person did not agree, or the robot did not become limp.
    """
    from daemon.gestures.limpness import limpness_of

    status = robot.status()
    limpness, was_limp = limpness_of(retargeter.kinematics), status.state == "limp"
    what = "is limp: no servo has torque" if was_limp else "parks slowly; then no servo has torque"
    lines = [f"{status.robot} on {status.bus} {what}", *(f"  {line}" for line in limpness.in_words())]
    _say("\n".join([*lines, "the arms alone are kept: trunk and head are at rest in the gesture"]))
    if limpness.falls and not (how.limp or was_limp):
        raise CommandError(
            f"teach: without torque {', '.join(limpness.falls)} would fall: hold or support the trunk, then add --limp"
        )
    if not how.yes and not _agreed("it stays limp now?" if was_limp else "it may go limp now?", how):
        raise CommandError("teach: not agreed to; nothing was changed")
    if was_limp and robot.status().state != "limp":
        raise CommandError("teach: the robot was armed meanwhile; nothing was changed; try again")
    if not was_limp:
        recording.robot_is = "the robot goes on to park, where it goes limp; `mmmd stop` brakes it"
        robot.park()
    robot.torque_off()  # from here on only a person arms the robot, no text
    recording.robot_is = "the robot is limp; only `mmmd arm` leads on, slowly from where it stands"
    now = robot.status()
    if now.state != "limp":
        raise CommandError(f"teach: the robot is {now.state}, not limp ({now.reason or '`mmmd status`'}); try again")
    return now.t_mono


def _record(robot: Client, recording: _Recording, since_s: float, how: TeachFlags) -> None:
    """Collect measured positions until Enter, or for the requested time.

    Raises:
        CommandError: the robot is not limp any more, or the input has ended.
        NoAnswerError: the daemon does not answer.
    """
    from daemon.wire.status import StateEvent

    what = "hold the arms in the pose" if how.pose else "move the arms"
    _say(f"{what}; {'Enter ends it' if how.seconds is None else f'{how.seconds:g} s'}")
    end_s = time.monotonic() + (how.seconds or MOST_SECONDS)
    for _, state in robot.watch("v1/state", timeout_s=_SILENCE_S):
        if not isinstance(state, StateEvent) or state.t_mono <= since_s:
            continue  # the last value from before is sent to every new subscriber
        if state.state != "limp":
            why = state.reason or "somebody else commands it"
            raise CommandError(f"teach: the robot is {state.state} ({why}), so the recording ended")
        recording.add(state)
        if time.monotonic() >= end_s or (how.seconds is None and _entered()):
            break
    _say(f"{recording.seconds:.1f} s recorded, {len(recording.t_s)} positions of each joint")
    if recording.silent:
        _say(f"note: at times without an answer, so their last position counts: {', '.join(sorted(recording.silent))}")


def _keep(
    library: GestureLibrary, name: str, recording: _Recording, retargeter: Retargeter, how: TeachFlags, *, replace: bool
) -> None:
    """Make the gesture, print the changes, write it.

    Raises:
        ClipError: nothing moved, the robot cannot show it, or the file cannot be written.
    """
    import numpy as np

    from daemon.gestures.teaching import taught_gesture, taught_pose

    q_rad = np.array(recording.q_rad, np.float64)
    taught = (taught_pose if how.pose else taught_gesture)(retargeter, recording.t_s, q_rad, how.sides)
    text, source = how.text or name.replace("_", " "), f"taught by hand on {retargeter.robot.name}"
    clip = library.keep(name, text, taught.posture, source, side=taught.sides, replace=replace)
    recording.kept = True
    for note in taught.notes:
        _say(f"note: {note}")
    kind = "pose" if how.pose else f"gesture of {len(clip.posture) / clip.posture.fps:.1f} s"
    arms = "both arms" if taught.sides == "both" else f"the {taught.sides} arm"
    _say(f"kept {name}: {kind}, {arms}, in {library.folder}")


def _play(name: str, recording: _Recording, how: TeachFlags, at: Connection) -> int:
    """Play the gesture at half speed if requested; else print how to do so."""
    from daemon.wire.requests import Gesture

    slowly = f"mmmd gesture play {name} --tempo {SLOW_TEMPO:g}"
    if not how.play:
        use = f"`mmmd inbetween {name}@2`" if how.pose else f"`{slowly}`"
        _say(
            f"the robot is limp; let go of it, then `mmmd arm` (slowly, from where it stands, to its rest pose) and {use}"
        )
        return 0
    if not how.yes and not _agreed(f"let go of the robot: it is armed, and plays {name} at half speed?", how):
        _say(f"not played; the robot is limp: `mmmd arm`, then `{slowly}`")
        return 0
    with at.client() as robot:
        recording.robot_is = "the robot goes on slowly to its rest pose; `mmmd stop` brakes it"
        robot.arm()
        now = robot.status()
    if now.state not in ("idle", "holding"):
        raise CommandError(f"teach: not armed: the robot is {now.state} ({now.reason or 'see `mmmd status`'})")
    return play(built(Gesture, PlayFlags(tempo=SLOW_TEMPO), name=name), at, wait=True, json=False)


def _agreed(question: str, how: TeachFlags) -> bool:
    """Whether a person answers yes, or has done so on the command line.

    Raises:
        CommandError: standard input is no terminal, so no one can answer.
    """
    if how.yes:
        return True
    _say(f"{question} (yes or no)")
    answer = sys.stdin.readline()
    if not answer:
        raise CommandError("teach: end of input before an answer; --yes goes on without a question")
    return answer.strip().lower() in ("y", "yes")


def _entered() -> bool:
    """Whether Enter was pressed.

    Raises:
        CommandError: the input has ended.
    """
    if not select.select([sys.stdin], [], [], 0)[0]:
        return False
    if not sys.stdin.readline():
        raise CommandError("teach: end of input; --seconds records without a terminal")
    return True


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()
