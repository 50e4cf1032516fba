"""`mmmd`: the commands, each loaded only when it is called.

Exit status: 0 good, 1 failed, 2 bad use, 3 robot fault. An error is one message on stderr; MMMD_DEBUG=1 adds the
traceback.
"""

from __future__ import annotations

import contextlib
import difflib
import importlib
import io
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class CommandEntry:
    """A command: `module:function`, its summary in a line, and its form in the list."""

    target: str
    summary: str


COMMANDS: dict[str, CommandEntry] = {
    "demo": CommandEntry("daemon.cli.demo:demo", "simulated robot, daemon, three texts, pictures: see it work"),
    "run": CommandEntry("daemon.cli.services.run:run", "the daemon: text over ZeroMQ in, servo motion out"),
    "view": CommandEntry(
        "daemon.cli.services.view:view", "the robot in a browser: 3D, text box, STOP; or a recorded run"
    ),
    "config": CommandEntry("daemon.cli.services.run:config", "the settings of `run` and where each comes from"),
    "install-service": CommandEntry("daemon.cli.services.service:install_service", "systemd unit and udev rule"),
    "install-torch": CommandEntry(
        "daemon.cli.install_torch:install_torch", "PyTorch for the CPU, which the motion model needs"
    ),
    "say": CommandEntry("daemon.cli.client.say:say", "tell the robot what to do"),
    "story": CommandEntry("daemon.cli.client.story:story", "several things in one motion, for as long as you like"),
    "inbetween": CommandEntry("daemon.cli.client.story:inbetween", "poses at given times; the middle is generated"),
    "gesture": CommandEntry("daemon.cli.client.gesture:gesture", "play, list, record, teach and add named gestures"),
    "look": CommandEntry("daemon.cli.client.layers:look", "turn the head, whatever the body does"),
    "idle": CommandEntry("daemon.cli.client.layers:idle", "small movements while there is nothing to play"),
    "stream": CommandEntry("daemon.cli.client.stream:stream", "joint targets from another program, under a lease"),
    "cancel": CommandEntry("daemon.cli.client.layers:cancel", "end a command; the robot brakes and holds"),
    "capabilities": CommandEntry("daemon.cli.client.layers:capabilities", "what the robot and the daemon can do"),
    "status": CommandEntry("daemon.cli.client.status:status", "what the robot and the daemon are doing"),
    "watch": CommandEntry("daemon.cli.client.watch:watch", "follow events and state as they happen"),
    "stop": CommandEntry("daemon.cli.client.control:stop", "brake within the limits and hold"),
    "estop": CommandEntry(
        "daemon.cli.client.control:estop", "cut torque at once (or hold, as set); latched until reset"
    ),
    "reset": CommandEntry("daemon.cli.client.control:reset", "leave e-stop or fault; the robot stays limp"),
    "arm": CommandEntry("daemon.cli.client.control:arm", "torque on, slow move to the rest pose"),
    "park": CommandEntry("daemon.cli.client.control:park", "slow move to the park pose, torque off"),
    "torque": CommandEntry("daemon.cli.client.control:torque", "off: brake, then limp where it stands; on: as arm"),
    "mcp": CommandEntry("daemon.cli.mcp:mcp", "tools for a language model: say, story, gesture, look, stop"),
    "keys": CommandEntry("daemon.cli.keys:keys", "who may talk to whom over the network"),
    "scan": CommandEntry("daemon.cli.hardware.scan:scan", "which servos are on a port: every baud, both protocols"),
    "doctor": CommandEntry(
        "daemon.cli.hardware.doctor:doctor", "rights, adapter, servos, settings, rate; with the remedy"
    ),
    "servo": CommandEntry("daemon.cli.hardware.servo:servo", "read and set up one servo: get, set, reboot, id, baud"),
    "calibrate": CommandEntry(
        "daemon.cli.hardware.calibrate:calibrate", "zero positions and ranges of the joints, by hand"
    ),
    "sim": CommandEntry("daemon.cli.hardware.sim:sim", "simulated servos behind a real tty"),
    "robot": CommandEntry("daemon.cli.hardware.robot:robot", "list, check and show robots"),
    "generate": CommandEntry("daemon.cli.offline.generate:generate", "text to human motion: .npz and .bvh"),
    "understand": CommandEntry("daemon.cli.offline.understand:understand", "what is read in a sentence; nothing moves"),
    "edit": CommandEntry("daemon.cli.offline.edit:edit", "a part of a motion made again: file or robot"),
    "import-official": CommandEntry(
        "daemon.cli.offline.import_official:import_official", "the MMM authors' checkpoints as one file of ours"
    ),
    "retarget": CommandEntry("daemon.cli.offline.retarget:retarget", "human motion to joint angles and servo ticks"),
    "replay": CommandEntry("daemon.cli.offline.replay:replay", "a recorded run again, through the same gate"),
    "render": CommandEntry("daemon.cli.offline.render:render", "pictures and films of a motion or a run"),
    "plot": CommandEntry("daemon.cli.offline.render:plot", "the joints of a run over time"),
    "generator": CommandEntry(
        "daemon.cli.services.generator:generator", "the motion model alone, for daemons to share"
    ),
    "train": CommandEntry("daemon.cli.offline.train:train", "train the motion model"),
    "eval": CommandEntry("daemon.cli.offline.eval:eval", "how good the model is"),
    "bench": CommandEntry("daemon.cli.bench:bench", "how fast and how safe it all is"),
    "completion": CommandEntry("daemon.cli.completion:completion", "completion for bash, zsh and fish"),
}
GOOD, FAILED, BAD_USE, ROBOT_FAULT = 0, 1, 2, 3
INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells expect it."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; return its exit status, or 1 when its output is not read."""
    _spell_out_what_cannot_be_shown()
    try:
        status = _answer(*(sys.argv[1:] if argv is None else argv))
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # no error message at exit either
        return FAILED
    return status


def _answer(name: str = "", *arguments: str) -> int:
    """Run a command, or list the commands; return the exit status."""
    if name in COMMANDS:
        return _guarded(name, arguments)
    if name in ("", "-h", "--help", "help"):
        _out(_overview())
        if not name:
            _out(_found())
        return GOOD if name else BAD_USE
    if name in ("-V", "--version"):
        from importlib.metadata import version  # here alone: it would lengthen the start of every command

        _out(f"mmmd {version('mmmd')}")
        return GOOD
    like = difflib.get_close_matches(name, COMMANDS, 2, 0.5)
    meant = f"did you mean {' or '.join(like)}? " if like else ""
    return _failed(f"unknown command '{name}'; {meant}`mmmd --help` describes all", BAD_USE)


def _spell_out_what_cannot_be_shown() -> None:
    """Print characters that the terminal's encoding lacks as escapes, where printing them would end the command."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _guarded(name: str, arguments: Sequence[str]) -> int:
    """Run a command; any exception becomes one message and an exit status."""
    try:
        with _ended_by_sigterm():
            return _run(name, _load(name), arguments)
    except SystemExit as stop:  # argument parsing: 0 after --help, 2 after bad use
        return stop.code if isinstance(stop.code, int) else BAD_USE
    except KeyboardInterrupt:
        return _failed("interrupted", INTERRUPTED)
    except BrokenPipeError:
        raise
    except Exception as error:  # no traceback reaches a person
        return _explain(error)


@contextlib.contextmanager
def _ended_by_sigterm() -> Generator[None]:
    """Let SIGTERM unwind a command, so that its child processes end with it; commands with a handler of their own replace it."""

    def unwind(number: int, _frame: object) -> None:
        raise SystemExit(128 + number)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, unwind)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _load(name: str) -> Callable[..., int | None]:
    module_name, _, function_name = COMMANDS[name].target.partition(":")
    return getattr(importlib.import_module(module_name), function_name)


def _run(name: str, command: Callable[..., int | None], arguments: Sequence[str]) -> int:
    import tyro

    if "-h" in arguments or "--help" in arguments:
        from daemon.cli.help_text import plain_help

        with plain_help():
            tyro.cli(command, prog=f"mmmd {name}", args=arguments)
    status = tyro.cli(command, prog=f"mmmd {name}", args=arguments)
    return GOOD if status is None else int(status)


def _explain(error: Exception) -> int:
    """Print one message for an error; return the exit status."""
    if os.environ.get("MMMD_DEBUG"):
        traceback.print_exception(error)
    from daemon.cli.missing_parts import about_missing

    if missing := about_missing(error):
        return _failed(missing, FAILED)
    from daemon.errors import CommandError, ConfigError, DaemonError, GestureNameError, LogError
    from mmm_core.errors import EvaluationError, GenerationError, MmmError, TextRefusedError, WrongFileError
    from retarget.errors import MotionError, RetargetError, RobotFileError, UnknownRobotError

    wrong_files = (RobotFileError, MotionError, LogError, WrongFileError, EvaluationError)
    wrong_values = (CommandError, ConfigError, UnknownRobotError, GestureNameError, GenerationError)
    is_wrong = isinstance(error, (*wrong_values, *wrong_files)) or _names_no_file(error)
    bad_use = is_wrong and not isinstance(error, TextRefusedError)
    if isinstance(error, (DaemonError, MmmError, RetargetError)):
        return _failed(str(error), int(getattr(error, "exit_status", BAD_USE if bad_use else FAILED)))
    if isinstance(error, UnicodeEncodeError):
        return _failed("a text on the command line is not UTF-8; type it anew", BAD_USE)
    if isinstance(error, OSError):
        return _failed(str(error), BAD_USE if bad_use else FAILED)
    return _failed(f"internal error ({type(error).__name__}: {error}); MMMD_DEBUG=1 shows where", FAILED)


def _names_no_file(error: BaseException) -> bool:
    """Whether a file named on the command line is missing or is a folder; a missing device does not count."""
    from daemon.errors import PortError

    cause: BaseException | None = error
    while cause is not None and not isinstance(cause, PortError):
        if isinstance(cause, (FileNotFoundError, IsADirectoryError, NotADirectoryError)):
            return True
        if getattr(cause, "found", "") == "no such file":
            return True
        cause = cause.__cause__ or cause.__context__
    return False


def _overview() -> str:
    width = max(map(len, COMMANDS))
    lines = [f"  {name:<{width}}  {entry.summary}" for name, entry in COMMANDS.items()]
    return "\n".join([
        "usage: mmmd COMMAND [OPTIONS]; `mmmd COMMAND --help` tells more",
        "",
        *lines,
        "",
        "example:",
        "  mmmd run --robot reference --bus sim://     in one terminal",
        '  mmmd say "wave with your right hand"        in another',
    ])  # fmt: skip


def _found() -> str:
    """Findings on this machine and the next command to type; empty where only the client is installed."""
    try:
        from daemon.cli.first_look import first_look

        return "\n" + "\n".join(first_look().lines())
    except ImportError:
        return ""


def _out(text: str) -> None:
    sys.stdout.write(text + "\n")


def _failed(message: str, status: int) -> int:
    sys.stderr.write(f"mmmd: {message}\n")
    return status


if __name__ == "__main__":
    sys.exit(main())
