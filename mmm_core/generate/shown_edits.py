"""Fills the [MASK]s of an edit so that the new ids show the gestures of the text: several candidates, judged by their motion.

Kept ids hold a motion back: the model has learnt that a clip goes on as it began, so of edits that are filled with the old
motion as context, three in ten show their text (`mmmd eval edits`). Therefore the candidates after the first are generated for
the text without context and replace the [MASK]s; only the ids beside kept ones are masked again and filled with both sides as
context. A motion for the text alone says which gestures must be seen; the first candidate that shows them is taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import torch
from torch import Tensor

from mmm_core.errors import TextRefusedError
from mmm_core.generate.engine import Engine
from mmm_core.language.count_words import count_asked
from mmm_core.model.sampling import fill
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.motion import FPS, Motion
from mmm_core.recognition.named import families_named, sentences
from mmm_core.recognition.seen import NOTHING_MOVES, STILL_FAMILIES, Act, Scene, lost, scenes_seen, sentence

CANDIDATES = 8
"""Candidates generated for the text alone, at most, after the one that is filled in context."""
SEAM_TOKENS = 2
"""Tokens beside kept ids that are masked again and filled in context; as many as between two scenes of a story."""
REFERENCES = 3
"""Motions for the text alone that are tried, at most, until each command shows a gesture that the recognition can name."""
EDIT_STRIDE = 32_452_843
"""Distance between the seeds of candidates."""
_LIMBS = {"left_arm": ("left",), "right_arm": ("right",)}


@dataclass(frozen=True)
class Edited:
    """An edited motion and whether its new part shows the gestures of the text.

    Attributes:
        motion: the whole motion.
        asked: gestures that a motion for the text alone shows, as a sentence without its subject; "" for an imported model,
            whose motions are not judged.
        missing: gestures among them that the edited motion does not show; "" where it shows all.
    """

    motion: Motion
    asked: str = ""
    missing: str = ""

    @property
    def reached(self) -> bool:
        """Whether the edited motion shows all gestures of the text."""
        return not self.missing


@dataclass(frozen=True)
class _Asked:
    """The acts that a text asks for in each of its scenes."""

    scenes: tuple[Scene, ...]
    acts: tuple[tuple[Act, ...], ...]

    @property
    def is_named(self) -> bool:
        return all(any(act.family for act in acts) for acts in self.acts)

    @property
    def is_still(self) -> bool:
        """Whether the motion for the text alone stands still, though the text names no standing."""
        acts = [act for acts in self.acts for act in acts]
        named = [family for scene in self.scenes for family in families_named(scene.words)]
        return all(act.sentence == NOTHING_MOVES for act in acts) and not any(f in STILL_FAMILIES for f in named)

    def missing(self, motion: Motion, span: tuple[int, int]) -> list[str]:
        """Descriptions of the acts that the motion does not show at the positions of `span`."""
        if self.is_still:
            return ["a motion for the text alone shows nothing that moves"]
        part = _frames(motion, *(at * FRAMES_PER_TOKEN for at in span))
        scale = part.duration_s / self.scenes[-1].end_s
        scenes = [replace(scene, end_s=scene.end_s * scale) for scene in self.scenes]
        return [what for _, what in lost(part, scenes, self.acts)]


def filled(engine: Engine, row: Tensor, text: str, seed: int, n_frames: int | None) -> Edited:
    """The motion of a row (L, C) whose [MASK]s are filled: the first candidate that shows the gestures of the text.

    If no candidate shows all, the one that misses fewest is taken.

    Args:
        engine: the model.
        row: kept ids, and [MASK] in the body parts and at the positions that are edited.
        text: a command for the edited part.
        seed: any integer from 0 to 2^31 - 1.
        n_frames: length that the motion is cut to; None keeps all frames of the row.

    Raises:
        TextRefusedError: the text is rejected.
    """
    states, verdict = engine.understand(text)
    if verdict.status == "rejected":
        raise TextRefusedError(text, verdict.reason)

    def motion_of(ids: Tensor) -> Motion:
        return engine.motion(ids, text, seed, verdict, n_frames)

    opened = row == engine.model.transformer.ids.mask
    in_context = fill(engine.model.transformer, states, [row], [seed], engine.settings)[0]
    if not engine.model.is_ours:
        return Edited(motion_of(in_context))
    spans = _spans(opened)
    asked = _asked(engine, text, seed, spans, _edited_sides(engine, opened))
    best: tuple[list[str], Motion] | None = None
    for ids in _candidates(engine, row, in_context, text, states, seed):
        motion = motion_of(ids)
        missing = [what for span in spans for what in asked.missing(motion, span)]
        if best is None or len(missing) < len(best[0]):
            best = (missing, motion)
        if not missing:
            break
    assert best is not None
    return Edited(best[1], sentence(asked.acts), "; ".join(dict.fromkeys(best[0])))


def _candidates(
    engine: Engine, row: Tensor, in_context: Tensor, text: str, states: TextStates, seed: int
) -> Iterator[Tensor]:
    """Yields candidates, (L, C) ids each: first the row filled in context, then motions for the text alone put in its place.

    These motions have by turns the segment's length and the length that the model chooses.
    """
    yield in_context
    mask = engine.model.transformer.ids.mask
    opened = row == mask
    for k in range(CANDIDATES):
        ids = row.clone()
        for start, end in _spans(opened):
            fresh = _fresh(engine, text, (seed + k * EDIT_STRIDE) % 2**31, end - start, own_length=bool(k % 2))
            at = start + (end - start - len(fresh)) // 2
            there = slice(at, at + len(fresh))
            ids[there] = torch.where(opened[there], fresh, ids[there])
            for seam in _seams(start, end, len(row)):
                ids[seam] = torch.where(opened[seam], mask, ids[seam])
        if bool((ids == mask).any()):
            ids = fill(engine.model.transformer, states, [ids], [seed], engine.settings)[0]
        yield ids


def _fresh(engine: Engine, text: str, seed: int, n_tokens: int, *, own_length: bool) -> Tensor:
    """(at most n_tokens, C) ids of a motion for the text alone: of `n_tokens`, or of the text's own length if that is shorter."""
    if own_length and engine.model.length is not None:
        ids = engine.ids_of(engine.generate(text, seed=seed).motion)
        if len(ids) <= n_tokens:
            return ids
    return engine.ids_of(engine.generate(text, seed=seed, seconds=n_tokens * FRAMES_PER_TOKEN / FPS).motion)


def _seams(start: int, end: int, n_tokens: int) -> list[slice]:
    """Positions of a segment that lie beside kept ids; none in a segment too short to have any others."""
    if end - start <= 2 * SEAM_TOKENS:
        return []
    first, last = slice(start, start + SEAM_TOKENS), slice(end - SEAM_TOKENS, end)
    return [first] * (start > 0) + [last] * (end < n_tokens)


def _spans(opened: Tensor) -> list[tuple[int, int]]:
    """First and end position of each segment with [MASK]s."""
    at = torch.nonzero(opened.any(-1)).flatten().tolist()
    starts = [i for i in at if i - 1 not in at]
    return [(i, next(j for j in range(i, len(opened) + 1) if j not in at)) for i in starts]


def _asked(
    engine: Engine, text: str, seed: int, spans: Sequence[tuple[int, int]], sides: tuple[str, ...] | None
) -> _Asked:
    """The acts of a motion for the text alone; among `REFERENCES` seeds, the first whose acts all have names is taken."""
    found: _Asked | None = None
    longest_s = max(end - start for start, end in spans) * FRAMES_PER_TOKEN / FPS
    for k in range(REFERENCES):
        seconds = None if engine.model.length is not None else longest_s
        made = engine.generate(text, seed=(seed + k * EDIT_STRIDE) % 2**31, seconds=seconds)
        seen = scenes_seen(made.motion, made.scenes)
        asked = _Asked(made.scenes, tuple(_of_text(acts, text, sides) for acts in seen))
        if asked.is_named:
            return asked
        found = found or asked
    assert found is not None
    return found


def _of_text(acts: Sequence[Act], text: str, sides: tuple[str, ...] | None) -> tuple[Act, ...]:
    """The named acts, or all if none has a name, on edited arms and with the number that the text names."""
    acts = [act for act in acts if act.family] or list(acts)
    number = count_asked(text)
    return tuple(replace(act, count=None if act.count is None else number, side=_side(act, sides)) for act in acts)


def _side(act: Act, sides: tuple[str, ...] | None) -> str:
    if act.side == "both" and sides is not None and len(sides) == 1 and "{" in sentences().get(act.family, "{"):
        return sides[0]
    return act.side


def _edited_sides(engine: Engine, opened: Tensor) -> tuple[str, ...] | None:
    """Arms of the edited body parts; None where the whole body is edited."""
    names = engine.model.tokenizer.part_names
    edited = [name for name, is_open in zip(names, opened.any(0).tolist(), strict=False) if is_open]
    if len(edited) == len(names):
        return None
    return tuple(side for name in edited for side in _LIMBS.get(name, ()))


def _frames(motion: Motion, start: int, end: int) -> Motion:
    return replace(
        motion, joints_m=motion.joints_m[start:end], head_quat_wxyz=motion.head_quat_wxyz[start:end],
        forearm_twist_rad=motion.forearm_twist_rad[start:end], features=motion.features[start:end], tokens=motion.tokens[:0],
    )  # fmt: skip
