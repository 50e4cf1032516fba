"""Every error that a user can meet, and how a test provokes it: rows of docs/errors.md."""

from __future__ import annotations

from dataclasses import dataclass

NOWHERE = (
    "--cmd",
    "ipc:///tmp/mmmd-nobody/cmd",
    "--ctl",
    "ipc:///tmp/mmmd-nobody/ctl",
    "--pub",
    "ipc:///tmp/mmmd-nobody/pub",
)


@dataclass(frozen=True)
class Typed:
    """A command line that ends in an error.

    Attributes:
        arguments: what is typed after `mmmd`, in an empty folder.
        status: the exit status.
        cause: what is wrong.
        remedy: what to do.
        files: content of files that are there, by name.
    """

    arguments: tuple[str, ...]
    status: int
    cause: str
    remedy: str
    files: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Frame:
    """A frame on a socket that is refused before it is a request.

    Attributes:
        socket: cmd, ctl or stream.
        frame: its bytes.
        code: of the `error` event.
        cause: what is wrong.
    """

    socket: str
    frame: bytes
    code: str
    cause: str


@dataclass(frozen=True)
class Answered:
    """A code with which the daemon refuses or ends a command.

    Attributes:
        code: of the `rejected`, `failed` or `error` event.
        cause: what is wrong.
        remedy: what to do.
        test: file below tests/ of the test that provokes it.
    """

    code: str
    cause: str
    remedy: str
    test: str


TYPED = (
    Typed(("sya", "wave"), 2, "no such command", "type it as it is listed"),
    Typed(("say", "wave", "with"), 2, "a text of several words without quotes", 'put it in quotes: mmmd say "wave with both hands"'),
    Typed(("say", "", *NOWHERE), 2, "an empty text", "say what to do, in words"),
    Typed(("say", "wave", "--tempo", "9", *NOWHERE), 2, "a value outside its range", "choose a value within it"),
    Typed(("say", "wave", "--seed", "-4", *NOWHERE), 2, "a seed outside its range", "choose a value within it"),
    Typed(("say", "wave", "--loop", "--hold", *NOWHERE), 2, "options that exclude each other", "leave one out"),
    Typed(("gesture", "play", "No Such", *NOWHERE), 2, "a name that no gesture can have", "mmmd gesture list"),
    Typed(
        ("gesture", "teach", "nod", "--yes", *NOWHERE), 1, "a gesture has that name, and --yes takes no gesture's place",
        "another name, or --force",
    ),
    Typed(
        ("gesture", "teach", "my_nod", "--seconds", "90", *NOWHERE), 2, "longer than a gesture may be", "60 s or less",
    ),
    Typed(("status", *NOWHERE), 1, "no daemon there", "start `mmmd run`, or name its endpoints"),
    Typed(("status", "--ctl", "5872"), 2, "an endpoint that is none", "name it as tcp://HOST:PORT or ipc://PATH"),
    Typed(("stop", "--ctl", "tcp://192.168.1.5:5872"), 2, "another machine without keys", "mmmd keys --help"),
    Typed(("run", "--robot", "opp3"), 2, "an unknown robot", "mmmd robot list"),
    Typed(("run", "--robot", "missing/robot.toml"), 2, "a robot file that is not there", "name the file"),
    Typed(("run", "--robot", "reference", "--bus", "usb://x"), 2, "a bus of an unknown kind", "dxl://DEVICE or sim://"),
    Typed(("run", "--robot", "reference", "--model", "missing.safetensors"), 2, "a checkpoint that is not there", "name the file, or leave --model out"),
    Typed(
        ("run", "--robot", "reference", "--model", "notes.txt"), 2, "a file that is no checkpoint", "name a .safetensors file of `mmmd train`",
        (("notes.txt", "these are notes"),),
    ),
    Typed(("run", "--config", "missing.toml"), 2, "a configuration that is not there", "name the file"),
    Typed(
        ("run", "--config", "mmmd.toml"), 2, "a setting that there is not", "mmmd config show lists all",
        (("mmmd.toml", 'robbot = "op3"\n'),),
    ),
    Typed(("run", "--robot", "reference", "--log", "run.mcap"), 2, "a log that exists", "choose another name, or a folder", (("run.mcap", ""),)),
    Typed(("scan", "/dev/no-such-adapter"), 1, "no adapter at that path", "look with ls -l /dev/serial/by-id/"),
    Typed(("generate",), 2, "nothing to generate", "give a text, --batch or --story"),
    Typed(("generate", "wave"), 2, "no file to write", "add --out"),
    Typed(("generate", "wave", "--out", "wave.txt"), 2, "another kind of file than is written", "name it .npz"),
    Typed(("generate", "wave", "--out", "none/wave.npz"), 2, "a folder that is not there", "make it"),
    Typed(("generate", "wave", "--out", "x.npz", "--seconds", "60"), 2, "a length outside its range", "0.2 to 9.8 s"),
    Typed(("generate", "--batch", "missing.jsonl", "--out", "many"), 2, "a batch file that is not there", "name the file"),
    Typed(
        ("generate", "--batch", "prompts.jsonl", "--out", "many"), 2, "a line that is no prompt", "correct that line",
        (("prompts.jsonl", '{"id": "a", "text": "nod", "speed": 2}\n'),),
    ),
    Typed(("retarget", "missing.npz", "--out", "ticks.npz"), 2, "a motion that is not there", "name the file"),
    Typed(
        ("retarget", "notes.npz", "--out", "ticks.npz"), 2, "a file that is no motion", "write one with `mmmd generate`",
        (("notes.npz", "these are notes"),),
    ),
    Typed(
        ("replay", "notes.mcap", "--bus", "sim://"), 2, "a file that is no log", "name a log of `mmmd run --log`",
        (("notes.mcap", "these are notes"),),
    ),
    Typed(("replay", "missing.mcap", "--bus", "sim://"), 2, "a log that is not there", "name the file"),
    Typed(("robot", "check", "opp3"), 2, "an unknown robot", "mmmd robot list"),
    Typed(("calibrate", "--robot", "opp3", "--bus", "sim://"), 2, "an unknown robot", "mmmd robot list"),
    Typed(("install-service",), 2, "system files, and nobody to ask", "add --yes, or try it with --root DIR"),
)  # fmt: skip
FRAMES = (
    Frame("cmd", b"\xff\xfe", "not_utf8", "bytes that are no UTF-8 text"),
    Frame("cmd", b"x" * 65_537, "too_large", "a frame of more than 64 KiB"),
    Frame("cmd", b"   ", "empty_text", "no words"),
    Frame("cmd", b"wave " * 500, "text_too_long", "more words than the model reads"),
    Frame("cmd", b'{"type": "say"', "bad_json", "a brace that is not closed"),
    Frame("cmd", b'{"type": "stop"}', "unknown_type", "a verb of the other socket"),
    Frame("cmd", b'{"type": "say", "text": "wave", "speed": 2}', "unknown_field", "a field that there is not"),
    Frame("cmd", b'{"type": "say", "text": "wave", "tempo": 9}', "bad_value", "a value outside its range"),
    Frame("cmd", b'{"type": "say"}', "bad_value", "a field that is missing"),
    Frame("cmd", b'{"type": "say", "text": "wave", "when": "at"}', "bad_value", "fields that do not go together"),
    Frame("cmd", b'{"type": "say", "text": "wave", "v": 2}', "version", "another version of the protocol"),
    Frame("ctl", b"halt!", "unknown_type", "a verb that there is not"),
    Frame("stream", b"[0.1, 0.2]", "bad_json", "a target that is no object"),
)
ANSWERED = (
    Answered(
        "bad_edit", "the edit does not fit the motion or the model", "name other parts or times", "end_to_end/test_compositions.py",
    ),
    Answered(
        "bad_file", "the file that an edit names cannot be read", "name an .npz of `mmmd generate`", "end_to_end/test_compositions.py",
    ),
    Answered(
        "bad_gesture", "there is no motion to keep under that name, or its file is damaged", "`mmmd say` something, then record", "daemon/scheduling/test_sequences.py",
    ),
    Answered(
        "bad_keyframes", "the times of poses do not fit", "put them further apart", "end_to_end/test_compositions.py",
    ),
    Answered(
        "bad_motion", "the generator gave a motion that cannot be played", "say it in other words", "daemon/front/test_front.py",
    ),
    Answered(
        "deadline", "the motion cannot begin in time", "leave out the deadline", "daemon/scheduling/test_commands.py",
    ),
    Answered(
        "fault", "the robot came into a fault", "find the cause (`mmmd status`), then `mmmd reset` and `mmmd arm`", "end_to_end/test_chaos.py",
    ),
    Answered(
        "frames", "a message of several parts", "send one part", "daemon/front/test_front.py",
    ),
    Answered(
        "front_silent", "the front is frozen or dead; on ctl, `stop` and `estop` are served without it", "ask again, or start the daemon anew", "daemon/ctl/test_control.py",
    ),
    Answered(
        "generator_down", "no generator runs, or it still loads the motion model", "send it again in some seconds; `mmmd status` says why; gestures need none", "daemon/generator/test_generator.py",
    ),
    Answered(
        "generator_error", "the model failed", "see the daemon's output", "daemon/front/test_front.py",
    ),
    Answered(
        "generator_timeout", "the generator did not answer in time", "say it once more", "daemon/generator/test_generator.py",
    ),
    Answered(
        "gesture_exists", "a gesture has that name", "another name, or --replace", "daemon/scheduling/test_gesture_commands.py",
    ),
    Answered(
        "id_in_use", "the id stands for another command", "choose a new id", "daemon/scheduling/test_commands.py",
    ),
    Answered(
        "lease_held", "another program streams", "end that program, or wait", "end_to_end/test_stream.py",
    ),
    Answered(
        "lease_silent", "a streaming program fell silent for good", "keep sending, or release the lease", "end_to_end/test_stream_losses.py",
    ),
    Answered(
        "no_lease", "a target, or a release, without the lease that is held", "ask for a lease first", "end_to_end/test_stream_losses.py",
    ),
    Answered(
        "not_finite", "a target that is no number, or far from any joint", "send radians", "end_to_end/test_stream_losses.py",
    ),
    Answered(
        "not_running", "a command to cancel that does not run", "`mmmd status` says what runs", "daemon/scheduling/test_sequences.py",
    ),
    Answered(
        "nothing_to_refer_to", "a text such as \"again\" or \"with the other hand\" came without a command before it on its connection, or after one that has none",
        "say the whole command", "daemon/front/test_conversations.py",
    ),
    Answered(
        "not_reached", "no edited motion shows what the text asks", "edit a longer stretch or more parts, or take other words or another seed",
        "daemon/cli/test_edit_command.py",
    ),
    Answered(
        "out_of_scope", "nothing that an upper body can do, or no English", "ask for a gesture of head, arms or torso", "daemon/front/test_front.py",
    ),
    Answered(
        "overtaken", "an e-stop came after the request and was served first", "send it again if it is still meant", "daemon/ctl/test_control.py",
    ),
    Answered(
        "queue_full", "too many commands wait", "wait, or cancel some", "daemon/scheduling/test_commands.py",
    ),
    Answered(
        "stale_state", "a request names a state of the robot that is older than 3 s or of another daemon: it was held up on its way",
        "look at the robot and its newest state, then ask again", "daemon/front/test_late_requests.py",
    ),
    Answered(
        "unknown_gesture", "no gesture of that name", "`mmmd gesture list`", "daemon/scheduling/test_gesture_commands.py",
    ),
    Answered(
        "unknown_joint", "a target that names no joint of the robot", "`mmmd capabilities --json` lists them", "end_to_end/test_stream_losses.py",
    ),
    Answered(
        "unknown_motion", "the motion of a command that is not known any more", "name a newer command, or a gesture", "end_to_end/test_compositions.py",
    ),
    Answered(
        "wrong_number", "a target with another number of angles", "one for each joint, or angles by name", "end_to_end/test_stream_losses.py",
    ),
    Answered(
        "wrong_secret", "a target without the secret of the lease", "send the secret that `accepted` gave", "daemon/front/test_target_parsing.py",
    ),
    Answered(
        "wrong_state", "the robot's state does not allow it", "`mmmd status` says what does", "daemon/scheduling/test_commands.py",
    ),
)  # fmt: skip
INSIDE = (
    "bus_dropped", "checkpoint", "internal", "interrupted", "no_daemon", "not_an_event", "retarget", "too_fast",
)  # fmt: skip
"""Codes that no test of a daemon brings about from outside: faults of the program, or of another version of it."""
