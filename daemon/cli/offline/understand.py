"""`mmmd understand`: the commands read in a sentence, or in several of one conversation, without any motion."""

from __future__ import annotations

import json as json_module
import sys
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from daemon.errors import CommandError

if TYPE_CHECKING:
    from mmm_core.generate.sentence_reader import SentenceReader
    from mmm_core.language.commands import PlainCommand, Reading
    from mmm_core.language.context import InContext
    from mmm_core.language.endless import WithoutEnd


def understand(
    texts: Annotated[tuple[str, ...], tyro.conf.Positional, tyro.conf.arg(metavar="TEXT [TEXT ...]")],
    json: bool = False,
) -> int:
    """Print the commands that are read in a sentence: in turn, at once, each with its tempo, size and hold, and what is denied.

    Several sentences are a conversation: each may refer to the one before it. Nothing moves, no daemon is needed and no motion
    model is loaded; whether the model can do a command is said by `say`. docs/language.md says what is understood.

    Example: mmmd understand "left hand on your heart and salute with the right, then bow very slowly"

    Example, a conversation: mmmd understand "wave" "again, slower" "now with the other hand"

    Args:
        texts: one sentence, or several that follow each other.
        json: print one JSON object instead of lines; several sentences are under `texts`.
    """
    from mmm_core.language.command_changes import NothingToReferToError
    from mmm_core.language.context import conversation

    if not texts or not all(text.strip() for text in texts):
        raise CommandError('no sentence; e.g. mmmd understand "wave with your left hand"')
    try:
        meant = conversation(texts, _read)
    except NothingToReferToError as error:
        raise CommandError(f"{error}; say the whole command") from None
    if json:
        objects = [_object(m) for m in meant]
        sys.stdout.write(json_module.dumps(objects[0] if len(texts) == 1 else {"texts": objects}) + "\n")
        return 0
    for text, found in zip(texts, meant, strict=True):
        said = [f"> {text}"] if len(texts) > 1 else []
        sys.stdout.write("".join(f"{line}\n" for line in said + _lines(found)))
    return 0


def _read(text: str) -> Reading:
    """The reading of a text; the networks, and PyTorch with them, are loaded where the rules do not read it alone."""
    from mmm_core.language.hard_phrases import without_hard_phrases
    from mmm_core.language.impossible_counts import within_counts
    from mmm_core.language.reading import read
    from mmm_core.language.sure_reading import needs_networks

    by_rules = read(text)
    by_networks = by_rules.text == text and needs_networks(by_rules)  # a text that is read verbatim has other words
    return _reader().read(text) if by_networks else without_hard_phrases(text, within_counts(by_rules))


@cache
def _reader() -> SentenceReader:
    from mmm_core.generate.sentence_reader import SentenceReader

    return SentenceReader.load()


def _object(meant: InContext | WithoutEnd | Reading) -> dict[str, Any]:
    from mmm_core.language.context import InContext
    from mmm_core.language.endless import WithoutEnd
    from mmm_core.language.stop_words import means_stop

    reading = _reading(meant)
    found = {
        "text": reading.text,
        "steps": [[_command(c) for c in step] for step in reading.steps],
        "denied": list(reading.denied),
        "notes": list(reading.notes),
        "as_it_is": reading.plain,
        "in_context": isinstance(meant, InContext),
        "stops": means_stop(reading.text),
    }
    if isinstance(meant, InContext):
        found |= {"keeps_going": meant.keeps_going, "times": meant.times}
    elif isinstance(meant, WithoutEnd):
        found["keeps_going"] = True
    return found


def _command(command: PlainCommand) -> dict[str, Any]:
    manner = command.manner
    return {
        "text": command.text,
        "limbs": sorted(command.limbs),
        "tempo": round(manner.tempo, 2),
        "size": round(manner.size, 2),
        "hold_s": manner.hold_s,
    }


def _lines(meant: InContext | WithoutEnd | Reading) -> list[str]:
    from mmm_core.language.context import InContext
    from mmm_core.language.endless import WithoutEnd
    from mmm_core.language.stop_words import means_stop

    reading = _reading(meant)
    if means_stop(reading.text):
        return ["stop: the robot brakes at once and holds"]
    lines = [f"{i}. {sentence}" for i, sentence in enumerate(reading.sentences, 1)]
    lines += [f"not: {denied}" for denied in reading.denied] + list(reading.notes)
    if isinstance(meant, WithoutEnd) or (isinstance(meant, InContext) and meant.keeps_going):
        lines.append(
            "held until something else is said" if meant.is_pose else "round and round until something else is said"
        )
    if isinstance(meant, InContext):
        lines += [f"{meant.times} times"] if meant.times else []
    return lines if reading.steps else ["nothing is to be done", *lines]


def _reading(meant: InContext | WithoutEnd | Reading) -> Reading:
    from mmm_core.language.commands import Reading

    return meant if isinstance(meant, Reading) else meant.reading
