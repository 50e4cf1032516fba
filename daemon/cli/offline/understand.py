"""`mmmd understand`: what is read in a sentence, without moving anything."""

from __future__ import annotations

import json as json_module
import sys
from typing import TYPE_CHECKING, Annotated, Any

import tyro

if TYPE_CHECKING:
    from mmm_core.language.reading import PlainCommand, Reading


def understand(text: Annotated[str, tyro.conf.Positional], json: bool = False) -> int:
    """Print the commands that are read in a sentence: in turn, at once, each with its tempo, size and hold, and what is denied.

    Nothing moves, no daemon is needed and no model is loaded; whether the model can do a command is said by `say`.
    docs/language.md says what is understood.

    Example: mmmd understand "left hand on your heart and salute with the right, then bow very slowly"

    Args:
        text: the sentence.
        json: print one JSON object instead of lines.
    """
    from mmm_core.language.reading import read

    reading = read(text)
    sys.stdout.write(
        f"{json_module.dumps(_object(reading))}\n" if json else "".join(f"{line}\n" for line in _lines(reading))
    )
    return 0


def _object(reading: Reading) -> dict[str, Any]:
    return {
        "text": reading.text,
        "steps": [[_command(c) for c in step] for step in reading.steps],
        "denied": list(reading.denied),
        "notes": list(reading.notes),
        "as_it_is": reading.plain,
    }


def _command(command: PlainCommand) -> dict[str, Any]:
    manner = command.manner
    return {
        "text": command.text,
        "limbs": sorted(command.limbs),
        "tempo": round(manner.tempo, 2),
        "size": round(manner.size, 2),
        "hold_s": manner.hold_s,
    }


def _lines(reading: Reading) -> list[str]:
    lines = [f"{i}. {sentence}" for i, sentence in enumerate(reading.sentences, 1)]
    lines += [f"not: {denied}" for denied in reading.denied] + list(reading.notes)
    return lines if reading.steps else ["nothing is to be done", *lines]
