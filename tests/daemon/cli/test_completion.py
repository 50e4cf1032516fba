"""`mmmd completion`: what a shell offers after the Tab key. Each shell reads its script and completes; an absent one is skipped."""

from __future__ import annotations

import os
import pty
import select
import shutil
import subprocess
import time
from pathlib import Path

import pytest

from daemon.cli import main
from daemon.cli.program import COMMANDS


@pytest.fixture(scope="module")
def scripts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The script of each shell."""
    folder = tmp_path_factory.mktemp("completion")
    found: dict[str, Path] = {}
    for shell in ("bash", "zsh", "fish"):
        with pytest.MonkeyPatch.context() as patch, (folder / shell).open("w") as f:
            patch.setattr("sys.stdout", f)
            assert main(["completion", shell]) == 0
        found[shell] = folder / shell
    return found


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("mmmd ge", {"gesture", "generate", "generator"}),
        ("mmmd gesture p", {"play"}),
        ("mmmd robot ", {"list", "new", "check", "show"}),
        ("mmmd say wave --te", {"--tempo"}),
        ("mmmd say wave --when ", {"now", "after", "at"}),
        ("mmmd run --robot o", {"op2", "op3"}),
        ("mmmd generate bow --bvh-names m", {"mmmd", "mixamo"}),
        ("mmmd completion z", {"zsh"}),
    ],
)
def test_a_shell_offers_commands_verbs_options_and_values(
    scripts: dict[str, Path], shell: str, typed: str, offered: set[str], tmp_path: Path
) -> None:
    if shutil.which(shell) is None:
        pytest.skip(f"no {shell} here")
    said = OFFERED_BY[shell](scripts[shell], typed, tmp_path)
    assert offered <= set(said) and all(word.startswith(typed.rpartition(" ")[2]) for word in said)


def offered_by_bash(script: Path, typed: str, folder: Path) -> list[str]:
    """The offers of bash's completion function, called as bash calls it."""
    words = " ".join(f"'{word}'" for word in typed.split(" "))
    line = f'. {script}; COMP_WORDS=({words}); COMP_CWORD={typed.count(" ")}; _mmmd; echo "${{COMPREPLY[@]}}"'
    return subprocess.run(["bash", "-c", line], cwd=folder, capture_output=True, text=True, check=True).stdout.split()


def offered_by_fish(script: Path, typed: str, folder: Path) -> list[str]:
    """First column of what fish lists: a word, and what it does."""
    line = f"source {script}; complete -C '{typed}'"
    env = os.environ | {"HOME": str(folder)}
    done = subprocess.run(["fish", "-c", line], cwd=folder, env=env, capture_output=True, text=True, check=True)
    return [row.split("\t")[0] for row in done.stdout.splitlines()]


ZSH = """\
autoload -U compinit && compinit -u && . {script}
compadd() {{ local -a found; builtin compadd -O found "$@"; print -rl -- $found >> found }}
zle-line-init() {{ print -r begin }}
zle -N zle-line-init
"""


def offered_by_zsh(script: Path, typed: str, folder: Path) -> list[str]:
    """The words that zsh offers at Tab; it completes at a terminal alone, so a pseudo-terminal is given to it."""
    mine, its = pty.openpty()
    (folder / ".zshrc").write_text(ZSH.format(script=script))
    env = os.environ | {"TERM": "dumb", "HOME": str(folder), "ZDOTDIR": str(folder)}
    with subprocess.Popen(["zsh", "-d", "-i"], cwd=folder, env=env, stdin=its, stdout=its, stderr=its,
                          start_new_session=True) as shell:  # fmt: skip
        os.close(its)
        try:
            read_until(mine, b"begin\r\n")
            os.write(mine, f"{typed}\t\x15print -r en''d\n".encode())  # \x15 takes the line back
            read_until(mine, b"end\r\n")
        finally:
            shell.kill()
            os.close(mine)
    return (folder / "found").read_text().split()


def read_until(fd: int, wanted: bytes) -> bytes:
    """The output of a terminal, read up to and with the text `wanted`."""
    said, end_s = b"", time.monotonic() + 60
    while wanted not in said:
        assert select.select([fd], [], [], max(0.0, end_s - time.monotonic()))[0], said
        said += os.read(fd, 4096)
    return said


OFFERED_BY = {"bash": offered_by_bash, "fish": offered_by_fish, "zsh": offered_by_zsh}


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_every_command_is_in_every_shells_script(scripts: dict[str, Path], shell: str) -> None:
    text = scripts[shell].read_text()
    assert all(f" {name}" in text for name in COMMANDS)
    program = shutil.which(shell)
    if program is not None:
        subprocess.run([program, "-n", str(scripts[shell])], check=True)
