"""Turns a text into the model's input: the commands that are read in it, with encoder states and scope verdict.

Of a text and its mirror image the model reads only the canonical one (`mmm_core.language.mirroring.canonical`), so that the
mirrored text gives the mirrored motion. A text of several commands is mirrored as a whole; a command that is then not
canonical itself is read as its own mirror image, and its ids are mirrored back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice

from mmm_core.generate.motion_model import MotionModel, nothing_to_do
from mmm_core.generate.result import understood_as
from mmm_core.language.at_once import is_pose
from mmm_core.language.commands import Reading
from mmm_core.language.limbs import limbs_of
from mmm_core.language.manner import Manner
from mmm_core.language.mirroring import canonical, mirror_words
from mmm_core.language.scope import ScopeVerdict, clauses_of, taken_clauses, with_clauses
from mmm_core.model.text import TextStates


@dataclass(frozen=True)
class ReadCommand:
    """One command as the model reads it.

    Attributes:
        text: the command's words, mirrored where the whole text is.
        states: the encoder's states of the words, or of their mirror image.
        is_mirrored: whether the states are those of the mirror image, so that the ids have to be mirrored.
        manner: tempo, size and hold.
        limbs: limbs that the command moves, as `mmm_core.language.limbs.limbs_of` names them.
        is_pose: whether the command lasts as long as the commands that are done at the same time.
        understood: the nearest known command and its score; empty in a text of one command.
    """

    text: str
    states: TextStates
    is_mirrored: bool = False
    manner: Manner = Manner()  # noqa: RUF009
    limbs: frozenset[str] = frozenset()
    is_pose: bool = False
    understood: str = ""


@dataclass(frozen=True)
class Interpreted:
    """A text's commands and the verdict on them.

    Attributes:
        reading: the text as it was read.
        verdict: scope verdict, with left and right as in the text.
        steps: groups of commands done at the same time, in the order of the text; none where the text is rejected.
        is_mirrored: whether the motion of the steps has to be mirrored.
    """

    reading: Reading
    verdict: ScopeVerdict
    steps: tuple[tuple[ReadCommand, ...], ...]
    is_mirrored: bool = False


def interpret(engine: MotionModel, text: str, *, fresh: bool = True) -> Interpreted:
    """The commands of one text; see `interpret_all`."""
    return interpret_all(engine, [text], fresh=fresh)[0]


def interpret_all(engine: MotionModel, texts: Sequence[str], *, fresh: bool = True) -> list[Interpreted]:
    """The commands of several texts, encoded in one batch.

    Args:
        engine: encodes and judges.
        texts: in English.
        fresh: whether the motion continues no other; a text that continues a motion is not mirrored.
    """
    drafts = [_Draft.of(engine, text, fresh and engine.model.is_ours) for text in texts]
    said = [words for draft in drafts for words in draft.words]
    if not said:
        return [Interpreted(d.reading, nothing_to_do(d.reading), ()) for d in drafts]
    states = engine.read(said)
    rows = iter(range(len(said)))
    return [_interpreted(engine, draft, states, list(islice(rows, len(draft.words)))) for draft in drafts]


@dataclass(frozen=True)
class _Draft:
    """The words of a text that have to be encoded: the whole text, then its commands or, for a single command, its clauses."""

    reading: Reading
    words: tuple[str, ...]
    commands: tuple[str, ...] = ()
    mirrored: tuple[bool, ...] = ()
    is_mirrored: bool = False

    @classmethod
    def of(cls, engine: MotionModel, text: str, mirrors: bool) -> _Draft:
        reading = engine.reading_of(text)
        if not reading.steps:
            return cls(reading, ())
        whole, is_mirrored = canonical(reading.words) if mirrors else (reading.words, False)
        flat = [c.text for step in reading.steps for c in step]
        if len(flat) == 1:
            scope = engine.model.scope
            clauses = clauses_of(whole) if scope is not None and scope.classifier is not None else []
            return cls(reading, (whole, *clauses), is_mirrored=is_mirrored)
        commands = [mirror_words(c) if is_mirrored else c for c in flat]
        own = [canonical(c) if mirrors else (c, False) for c in commands]
        return cls(
            reading, (whole, *(c for c, _ in own)), tuple(commands), tuple(image for _, image in own), is_mirrored
        )


def _interpreted(engine: MotionModel, draft: _Draft, states: TextStates, rows: list[int]) -> Interpreted:
    reading = draft.reading
    if not rows:
        return Interpreted(reading, nothing_to_do(reading), ())
    whole = engine.verdict(draft.words[0], states.sentence[rows[0]], reading.outside)
    parts = [engine.verdict(words, states.sentence[row]) for words, row in zip(draft.words[1:], rows[1:], strict=True)]
    if not draft.commands:
        if parts:
            whole = with_clauses(whole, list(draft.words[1:]), parts)
        own = engine.read([whole.kept]) if whole.kept else states.row(rows[0])
        only = next(c for step in reading.steps for c in step)
        text = whole.kept or draft.words[0]
        command = ReadCommand(text, own, False, only.manner, limbs_of(text))
        done = () if whole.status == "rejected" else ((command,),)
        return Interpreted(reading, _said(whole, draft.is_mirrored), done, draft.is_mirrored)
    taken = taken_clauses(whole, parts)
    whole = with_clauses(whole, list(draft.commands), parts)
    if whole.status == "rejected":
        return Interpreted(reading, _said(whole, draft.is_mirrored), (), draft.is_mirrored)
    if any(parts[i].status == "rejected" for i in taken) and not whole.kept and reading.plain:
        command = ReadCommand(draft.words[0], states.row(rows[0]))
        return Interpreted(reading, _said(whole, draft.is_mirrored), ((command,),), draft.is_mirrored)
    commands = [
        ReadCommand(
            text,
            states.row(row),
            image,
            understood=_seen_in_mirror(understood_as(verdict), image),
            limbs=limbs_of(text),
            is_pose=is_pose(text),
        )
        for text, row, image, verdict in zip(draft.commands, rows[1:], draft.mirrored, parts, strict=True)
    ]
    steps: list[tuple[ReadCommand, ...]] = []
    number = 0
    for step in reading.steps:
        mine = range(number, number + len(step))
        number += len(step)
        kept = tuple(replace(commands[i], manner=c.manner) for i, c in zip(mine, step, strict=True) if i in taken)
        steps += [kept] if kept else []
    return Interpreted(reading, _said(whole, draft.is_mirrored), tuple(steps), draft.is_mirrored)


def _seen_in_mirror(words: str, image: bool) -> str:
    return mirror_words(words) if image else words


def _said(verdict: ScopeVerdict, is_mirrored: bool) -> ScopeVerdict:
    """The verdict with left and right as in the text."""
    if not is_mirrored:
        return verdict
    return replace(verdict, **{key: mirror_words(getattr(verdict, key)) for key in ("nearest", "reason", "kept")})
