"""Every command block and printed example of README, docs and `--help` does what the page says, on the simulator.

The blocks of a page are run in its order, in one folder, against the daemon that the page starts. Blocks and commands that are
not run say why: in the page by a comment (tests/support/pages.py), for `--help` in a table below. Their number is asserted, so
that none is left out by mistake.
"""

from __future__ import annotations

import functools
import importlib
import itertools
import re
import shlex
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest
import tyro

from daemon.cli.program import COMMANDS
from daemon.wire.codec import decode_cmd, decode_ctl, decode_target
from daemon.wire.events import EVENTS as EVENT_TYPES
from daemon.wire.requests import CMD_TYPES, tag_of
from sim.faults import FaultSchedule
from tests.support.pages import ROOT, Block, assert_prints, blocks, help_examples
from tests.support.terminal import Terminal, terminal

PAGES = {
    page: found
    for path in sorted([ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
    if (found := blocks(page := str(path.relative_to(ROOT))))
}
RUN = {page: [b for b in found if b.kind in ("commands", "python", "output")] for page, found in PAGES.items()}
NOT_RUN_IN_PAGES = 35
NOT_RUN_IN_HELP = {
    "mmmd bench": "minutes to hours; tests/daemon/bench",
    "mmmd calibrate": "a person moves the joints and answers; tests/daemon/cli/test_calibrate_command.py",
    "mmmd eval": "minutes to hours, or data that does not ship; docs/evaluation.md's short ones are run",
    "mmmd generator --bind tcp://0.0.0.0": "keys of two machines; tests/daemon/network/test_remote_generator.py",
    "mmmd gesture teach": "a person leads the arms; tests/end_to_end/test_teach_command.py",
    "mmmd import-official": "the authors' weights do not ship; tests/mmm_core/imports",
    "mmmd install-torch": "it would change this environment; tests/packaging/test_cpu_torch.py",
    "mmmd keys": "two machines; `test_two_machines_exchange_keys` below",
    "mmmd retarget HumanML3D": "a data set, or a cluster, that is not here",
    "mmmd run --keys": "two machines; `test_two_machines_exchange_keys` below",
    "mmmd train": "hours of training; tests/mmm_core/training",
    "mmmd view": "serves a page until Ctrl-C; tests/end_to_end/test_page.py",
    "my_tracker": "a program of the reader's own; tests/end_to_end/test_stream.py",
    "sudo": "rights over this machine; the same with --root is run",
    "torchrun": "hours of training",
    "{": "settings of another program; tests/daemon/client",
}
"""Examples of `--help` that are not run, by their beginning, each with the reason."""
EVENTS = {str(kind.__struct_config__.tag): kind for kind in EVENT_TYPES}
EXAMPLES = help_examples()
pytestmark = pytest.mark.realtime


def commands() -> list[tuple[str, str]]:
    """(first place, command line) of all pages and help texts."""
    found = [(str(b), c) for blocks_of in PAGES.values() for b in blocks_of if b.kind == "commands" for c in b.commands]
    found += [(f"{name} --help", example) for name, example in EXAMPLES]
    first_places = {command: place for place, command in reversed(found) if command.startswith("mmmd ")}
    return [(place, command) for command, place in first_places.items()]


@pytest.mark.parametrize(("place", "command"), commands())
def test_options_of_every_command_line_exist(place: str, command: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Each command line of pages and help is read as the program reads it; nothing is run."""
    name, *arguments = shlex.split(re.split(r" [<|>] ", command)[0])[1:]
    if any("|" in a for a in arguments):
        return  # verbs to choose from
    module, _, function = COMMANDS[name].target.partition(":")
    real = getattr(importlib.import_module(module), function)

    @functools.wraps(real)
    def read(*_args: object, **_kwargs: object) -> int:
        return 0

    try:
        assert tyro.cli(read, prog=f"mmmd {name}", args=arguments) == 0
    except SystemExit as stop:
        raise AssertionError(f"{place}: {command}: status {stop.code}\n{capsys.readouterr().err}") from None


@pytest.mark.parametrize("block", [b for found in PAGES.values() for b in found if b.kind == "json"], ids=str)
def test_messages_on_pages_are_messages(block: Block) -> None:
    """Requests are decoded as the daemon does; events, shortened on the page by "...", have fields that there are."""
    text = "\n".join(block.lines)
    for message in json_objects(text):
        kind = re.match(r'{"type": "(\w+)"', message)
        assert kind is not None, message
        if kind[1] in EVENTS:
            known = set(EVENTS[kind[1]].__struct_fields__) | {"type"}
            assert set(re.findall(r'"(\w+)":', top_level(message))) <= known, message
        elif kind[1] == "target":
            decode_target(message.replace("[0.1, ...]", "[0.1]").replace("ITS SECRET", 16 * "s").encode())
        elif kind[1] in map(tag_of, CMD_TYPES):
            decode_cmd(message.encode())
        else:
            decode_ctl(message.encode())


@pytest.mark.parametrize("block", [b for found in PAGES.values() for b in found if b.kind == "toml"], ids=str)
def test_toml_on_pages_is_read(block: Block, tmp_path: Path) -> None:
    settings = tomllib.loads("\n".join(block.lines))
    if "fault" in settings:
        (tmp_path / "f.toml").write_text("\n".join(block.lines))
        assert len(FaultSchedule.load(tmp_path / "f.toml").faults) == len(settings["fault"])


def test_every_block_that_is_not_run_says_why() -> None:
    why = [why for found in PAGES.values() for block in found for why in block.skipped.values()]
    assert len(why) == NOT_RUN_IN_PAGES
    assert all(len(one) > 10 for one in (*why, *NOT_RUN_IN_HELP.values()))
    for prefix in NOT_RUN_IN_HELP:
        assert any(example.startswith(prefix) for _, example in EXAMPLES), prefix


@pytest.mark.long
def test_the_first_page_begins_as_it_says(tmp_path: Path) -> None:
    """README, By hand: the daemon on a simulated robot, and what is typed in the other terminal."""
    with prepared(tmp_path) as typed:
        for block in RUN["README.md"][1:3]:
            run(typed, block)


@pytest.mark.soak
@pytest.mark.timeout(900)
def test_examples_of_help_do_what_they_say(tmp_path: Path) -> None:
    """All of them in one folder, the offline ones first: they write the files that others read."""
    done: list[str] = []
    with prepared(tmp_path) as typed:
        for command in FIRST:
            typed.type(command)
        for _, example in sorted(EXAMPLES, key=lambda e: (" run.mcap" in e[1], e[1].startswith(ON_THEIR_OWN))):
            if any(example.startswith(prefix) for prefix in NOT_RUN_IN_HELP):
                continue
            if example.startswith(("mmmd say", "mmmd story", "mmmd gesture", "mmmd edit gesture", "mmmd inbetween")):
                typed.leave_safe_states()
            if example == "mmmd cancel":
                typed.leave_safe_states()
                typed.type('mmmd say "clap your hands" --loop --no-wait')
            if example == "mmmd robot check my_robot":
                fill_in(tmp_path / "my_robot/robot.toml")
            if "--log run.mcap" in example:  # a log is never overwritten
                (tmp_path / "run.mcap").rename(tmp_path / "before.mcap")
            typed.type(example)
            done.append(example)
    assert len(done) > 60


@pytest.mark.soak
def test_two_machines_exchange_keys(tmp_path: Path) -> None:
    """docs/daemon.md, Over the network: robot and laptop are two homes on this machine, the endpoints loopback's."""
    block = next(b for b in PAGES["docs/daemon.md"] if b.lines[0].startswith("robot$"))
    homes, keys, said = {"robot": "", "laptop": "export HOME=$PWD/laptop && "}, dict[str, str](), ""
    with prepared(tmp_path) as typed:
        for machine, line in (line.split("$ ") for line in block.lines):
            command = homes[machine] + line.partition(" #")[0].strip()
            for name, key in keys.items():
                command = command.replace(f"{name.upper()}_KEY", key)
            for name in ("cmd", "ctl", "pub"):
                command = re.sub(rf"--{name} tcp://robot:\d+", f"--{name} {getattr(typed.endpoints, name)}", command)
            said = typed.type(command)
            if "mmmd keys new" in line:
                keys[machine] = said.split()[0]
    assert "done" in said


@pytest.mark.soak
@pytest.mark.timeout(900)
@pytest.mark.parametrize("page", [page for page, found in RUN.items() if found])
def test_a_page_does_what_it_says(page: str, tmp_path: Path) -> None:
    with prepared(tmp_path) as typed:
        for command in TAKEN_FOR_GRANTED.get(page, ()):
            typed.type(command)
        for block in RUN[page]:
            run(typed, block)


def run(typed: Terminal, block: Block) -> None:
    """Run a block; what fails is named by its place in the page."""
    if block.why_not(""):
        return
    try:
        if block.kind == "python":
            assert typed.python("\n".join(block.lines)).strip()
        elif block.kind == "output":
            assert_prints(typed.printed.get(block.command) or typed.type(block.command), block.lines)
        else:
            for command in block.commands:
                if not block.why_not(command):
                    typed.type(command)
    except (AssertionError, subprocess.TimeoutExpired) as error:
        raise AssertionError(f"{block}: {error}") from None


def prepared(folder: Path):
    """A terminal in a folder with what pages speak of as the reader's own."""
    (folder / "retarget").symlink_to(ROOT / "retarget")
    (folder / "docs").symlink_to(ROOT / "docs")
    (folder / "scenes.jsonl").write_text('{"text": "bow", "seconds": 2.5}\n{"text": "wave"}\n')
    (folder / "prompts.jsonl").write_text('{"id": "a", "text": "nod twice", "seed": 1, "seconds": 2}\n')
    shutil.copy(ROOT / "retarget/robots/reference/robot.xml", folder / "my_torso.xml")
    (folder / "my.urdf").write_text(urdf())
    (folder / "path.jsonl").write_text("".join(f'{{"right_elbow": {0.2 + 0.001 * i:.3f}}}\n' for i in range(20)))
    faults = next(b for b in PAGES["docs/simulator.md"] if b.kind == "toml").lines
    (folder / "f.toml").write_text("\n".join(faults))
    (folder / "faults.toml").write_text(
        "\n".join(line for line in faults if not line.startswith("path"))
    )  # for two ports
    return terminal(folder)


def fill_in(robot_file: Path) -> None:
    """Write servo ids where `mmmd robot new` leaves blanks, as its reader does."""
    ids = itertools.count(1)
    robot_file.write_text(re.sub(r'(?<=id = )"\?"', lambda _: str(next(ids)), robot_file.read_text()))


def urdf() -> str:
    """A torso of six joints: two for each shoulder, and elbows."""
    links, joints = ['<link name="torso"/>'], list[str]()
    for side, y in (("l", 0.1), ("r", -0.1)):
        above = "torso"
        for name, axis, at in (
            ("pitch", "0 1 0", f"0 {y} 0.3"),
            ("roll", "1 0 0", "0 0 0"),
            ("elbow", "0 1 0", "0 0 -0.2"),
        ):
            links.append(
                f'<link name="{side}_{name}_link"><visual><geometry><box size="0.03 0.03 0.1"/></geometry></visual></link>'
            )
            joints.append(
                f'<joint name="{side}_{name}" type="revolute"><parent link="{above}"/><child link="{side}_{name}_link"/>'
                f'<origin xyz="{at}"/><axis xyz="{axis}"/><limit lower="-1.5" upper="1.5" effort="1" velocity="3"/></joint>'
            )
            above = f"{side}_{name}_link"
        links.append(f'<link name="{side}_hand"/>')
        joints.append(
            f'<joint name="{side}_wrist" type="fixed"><parent link="{above}"/><child link="{side}_hand"/>'
            '<origin xyz="0 0 -0.2"/></joint>'
        )
    return f'<robot name="mine">{"".join(links + joints)}</robot>'


FIRST = (
    'mmmd generate "wave with your right hand" --seconds 4 --out wave.npz',
    'mmmd generate "clap your hands" --seconds 3 --out clap.npz',
    "mmmd run --robot reference --bus sim:// --log run.mcap",
    'mmmd story "wave with your right hand" "bow"',
    "mmmd run --robot reference --bus sim://",
)
"""What the examples of help take for granted: motions, a recorded run, and a daemon."""
ON_THEIR_OWN = ("mmmd run ", "mmmd sim ")
"""Beginnings of examples that start a robot of their own: they come after those that talk to the daemon."""
TAKEN_FOR_GRANTED = {
    "docs/retargeting.md": ('mmmd generate "wave with your right hand" --out wave.npz',),
    "docs/simulator.md": ("mmmd run --robot reference --bus sim:// --log run.mcap", 'mmmd say "nod"'),
    "docs/wire/README.md": ("mmmd run --robot reference --bus sim://",),
}
"""Commands that the reader of a page has typed before, as README gives them."""


def json_objects(text: str) -> list[str]:
    """The objects in a text, each from its brace to the one that closes it."""
    found, depth, start = [], 0, 0
    for i, c in enumerate(text):
        if c == "{":
            start = i if not depth else start
            depth += 1
        elif c == "}":
            depth -= 1
            if not depth:
                found.append(text[start : i + 1])
    return found


def top_level(message: str) -> str:
    """An object's text without the objects in it."""
    inner = message[1:-1]
    while re.search(r"\{[^{}]*\}", inner):
        inner = re.sub(r"\{[^{}]*\}", "", inner)
    return inner
