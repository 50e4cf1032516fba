"""`mmmd completion`: what a shell offers after the Tab key."""

from __future__ import annotations

import shutil
import subprocess
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


@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        (["mmmd", "ge"], {"gesture", "generate", "generator"}),
        (["mmmd", "gesture", "p"], {"play"}),
        (["mmmd", "robot", ""], {"list", "new", "check", "show"}),
        (["mmmd", "say", "wave", "--te"], {"--tempo"}),
        (["mmmd", "say", "wave", "--when", ""], {"now", "after", "at"}),
        (["mmmd", "run", "--robot", "o"], {"op2", "op3"}),
        (["mmmd", "generate", "bow", "--bvh-names", "m"], {"mmmd", "mixamo"}),
        (["mmmd", "completion", "z"], {"zsh"}),
    ],
)
def test_bash_offers_commands_verbs_options_and_values(
    scripts: dict[str, Path], typed: list[str], offered: set[str]
) -> None:
    words = " ".join(f"'{word}'" for word in typed)
    script = f'. {scripts["bash"]}; COMP_WORDS=({words}); COMP_CWORD={len(typed) - 1}; _mmmd; echo "${{COMPREPLY[@]}}"'
    said = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout
    assert offered <= set(said.split()) and all(word.startswith(typed[-1]) for word in said.split())


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_every_command_is_in_every_shells_script(scripts: dict[str, Path], shell: str) -> None:
    text = scripts[shell].read_text()
    assert all(f" {name}" in text for name in COMMANDS)
    program = shutil.which(shell)
    if program is not None:
        subprocess.run([program, "-n", str(scripts[shell])], check=True)
