"""`mmmd completion`: completion of commands, verbs, options and their values for bash, zsh and fish.

The words are read from each command's `--help`, so that there is no list to forget. Robots' names complete `--robot`.
"""

from __future__ import annotations

import contextlib
import io
import re
import sys
from dataclasses import dataclass
from typing import Annotated, Literal

import tyro

_USAGE = re.compile(r"^usage:.*?(?=\n\n)", re.DOTALL)
_CHOICES = r"\{([\w,.-]+)\}"
_OPTION = re.compile(rf"^[│|]\s(?:-\w, )?(--[\w-]+)((?:, --[\w-]+)*)(?: {_CHOICES})?", re.MULTILINE)
_BASH = """\
# Completion of mmmd for {shell}, made by `mmmd completion {shell}`.
{head}_mmmd() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" words=""
  if [ "$COMP_CWORD" -eq 1 ]; then
    words="{commands}"
  else
    case "${{COMP_WORDS[1]}} $before" in
{values}
    *) case "${{COMP_WORDS[1]}}" in
{options}
      esac ;;
    esac
  fi
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _mmmd mmmd
"""


@dataclass(frozen=True)
class _Words:
    """Words that may follow a command: verbs, options, and the values of options."""

    verbs: tuple[str, ...]
    options: tuple[str, ...]
    values: dict[str, tuple[str, ...]]


def completion(shell: Annotated[Literal["bash", "zsh", "fish"], tyro.conf.Positional]) -> int:
    """Print a script that completes commands, options and their values in a shell.

    Example: mmmd completion bash > mmmd.bash

    For bash put it into ~/.local/share/bash-completion/completions/mmmd, for zsh source it in ~/.zshrc after compinit, for
    fish put it into ~/.config/fish/completions/mmmd.fish.

    Args:
        shell: bash, zsh or fish.
    """
    from daemon.cli.program import COMMANDS

    words = {name: _words(name) for name in COMMANDS}
    sys.stdout.write(_fish(words) if shell == "fish" else _bash(words, shell))
    return 0


def _words(name: str) -> _Words:
    """The words in a command's help."""
    from daemon.cli.program import main
    from retarget.robot.loading import list_robots

    kept = io.StringIO()
    with contextlib.redirect_stdout(kept):
        main([name, "--help"])
    text = kept.getvalue()
    usage = _USAGE.match(text)
    verbs = re.search(_CHOICES, usage[0]) if usage else None
    options, values = list[str](), dict[str, tuple[str, ...]]()
    for match in _OPTION.finditer(text):
        options += [match[1], *match[2].replace(",", " ").split()]
        if match[3]:
            values[match[1]] = tuple(match[3].split(","))
    for option in {"--robot", "--robots"} & set(options):
        values[option] = tuple(list_robots())
    return _Words(tuple(verbs[1].split(",")) if verbs else (), tuple(dict.fromkeys(options)), values)


def _bash(words: dict[str, _Words], shell: str) -> str:
    values = [f'    "{name} {option}") words="{" ".join(known)}" ;;'
              for name, of in words.items() for option, known in of.values.items()]  # fmt: skip
    options = [f'      {name}) words="{" ".join((*of.verbs, *of.options))}" ;;' for name, of in words.items()]
    head = "autoload -U +X bashcompinit && bashcompinit\n" if shell == "zsh" else ""
    return _BASH.format(
        shell=shell, head=head, commands=" ".join(words), values="\n".join(values), options="\n".join(options)
    )


def _fish(words: dict[str, _Words]) -> str:
    from daemon.cli.program import COMMANDS

    lines = ["# Completion of mmmd for fish, made by `mmmd completion fish`."]
    for name, of in words.items():
        summary = COMMANDS[name].summary.replace("'", "\\'")
        lines.append(f"complete -c mmmd -n __fish_use_subcommand -a {name} -d '{summary}'")
        seen = f"complete -c mmmd -n '__fish_seen_subcommand_from {name}'"
        lines += [f"{seen} -a '{' '.join(of.verbs)}'"] if of.verbs else []
        for option in of.options:
            known = f" -x -a '{' '.join(of.values[option])}'" if option in of.values else ""
            lines.append(f"{seen} -l {option.removeprefix('--')}{known}")
    return "\n".join(lines) + "\n"
