"""Fills the [MASK]s of an edit so that the new ids show what the text asks: several candidates, judged by their motion.

Ids that are kept hold a motion back: the model has learnt that a clip goes on as it began, so with the old motion as context
alone three edits of ten show their text (`mmmd eval edits`). Therefore the candidates after the first are generated for the text
without context and put in the place of the [MASK]s; only the ids beside kept ones are masked again and filled with both sides
as context. Asked is what a motion for the text alone shows; the first candidate that shows it as well is taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import torch
from torch import Tensor

from mmm_core.generate.engine import Engine
from mmm_core.language.count_words import count_asked
from mmm_core.language.scope import ScopeVerdict
from mmm_core.model.sampling import fill
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.motion import FPS, Motion
from mmm_core.recognition.named import families_named, sentences
from mmm_core.recognition.seen import STILL_FAMILIES, Act, Scene, lost, scenes_seen, sentence

CANDIDATES = 8
"""Motions generated for a text alone, at most, after the one that is filled in context."""
SEAM_TOKENS = 1
"""Tokens beside kept ids that are masked again and filled in context."""
REFERENCES = 3
"""Motions for the text alone, at most, until each of its commands shows a gesture with a name."""
FEWEST_TOKENS = 2
EDIT_STRIDE = 32_452_843
"""Distance between the seeds of candidates."""
_LIMBS = {"left_arm": ("left",), "right_arm": ("right",)}


@dataclass(frozen=True)
class Edited:
    """An edited motion and whether its new part shows what the text asks.

    Attributes:
        motion: the whole motion.
        asked: what a motion for the text alone shows, as a sentence without its subject; "" where it is not judged, because
            the model was imported.
        found: what is missing of it in the edited motion; "" where it is reached.
        reached: whether nothing is missing.
    """

    motion: Motion
    asked: str = ""
    found: str = ""

    @property
    def reached(self) -> bool:
        return not self.found


@dataclass(frozen=True)
class _Asked:
    """What a text asks for: acts in each of its scenes."""

    scenes: tuple[Scene, ...]
    acts: tuple[tuple[Act, ...], ...]

    @property
    def is_named(self) -> bool:
        return all(any(act.family for act in acts) for acts in self.acts)

    def missing(self, motion: Motion, start: int, end: int) -> list[str]:
        """What of it frames `start` to `end` do not show."""
        part = _frames(motion, start, end)
        scale = part.duration_s / self.scenes[-1].end_s
        scenes = [replace(scene, end_s=scene.end_s * scale) for scene in self.scenes]
        return [what for _, what in lost(part, scenes, self.acts)]


def filled(engine: Engine, row: Tensor, text: str, states: TextStates, verdict: ScopeVerdict, seed: int, n_frames: int | None) -> Edited:
    """The motion of a row (L, C) whose [MASK]s are filled, of all candidates the first that shows what the text asks.

    Where none does, the one that misses least.
    """
    def motion_of(ids: Tensor) -> Motion:
        return engine.motion(ids, text, seed, verdict, n_frames)

    opened = row == engine.model.transformer.ids.mask
    in_context = fill(engine.model.transformer, states, [row], [seed], engine.settings)[0]
    if not engine.model.is_ours:
        return Edited(motion_of(in_context))
    asked = _asked(engine, text, seed, _edited_sides(engine, opened))
    spans = [(a * FRAMES_PER_TOKEN, b * FRAMES_PER_TOKEN) for a, b in _spans(opened)]
    best: tuple[int, Edited] | None = None
    for ids in _candidates(engine, row, in_context, text, states, seed):
        motion = motion_of(ids)
        missing = [what for a, b in spans for what in asked.missing(motion, a, min(b, len(motion.joints_m)))]
        if not any(act.limb for acts in asked.acts for act in acts) and not _means_stillness(asked):
            missing = missing or ["nothing moves"]
        edited = Edited(motion, sentence(asked.acts), "; ".join(dict.fromkeys(missing)))
        if best is None or len(missing) < best[0]:
            best = (len(missing), edited)
        if not missing:
            break
    assert best is not None
    return best[1]


def _candidates(engine: Engine, row: Tensor, in_context: Tensor, text: str, states: TextStates, seed: int) -> Iterator[Tensor]:
    yield in_context
    opened = row == engine.model.transformer.ids.mask
    for k in range(CANDIDATES):
        ids, seams = row.clone(), torch.zeros(len(row), dtype=torch.bool)
        for start, end in _spans(opened):
            n = end - start
            fresh = _fresh(engine, text, (seed + k * EDIT_STRIDE) % 2**31, n, own_length=bool(k % 2))
            at = start + (n - len(fresh)) // 2
            books = opened[start:end]
            new = ids[start:end].clone()
            new[at - start : at - start + len(fresh)] = fresh
            ids[start:end] = torch.where(books, new, ids[start:end])
            seams |= _seams(opened, start, end)
        ids = torch.where(opened & seams[:, None], engine.model.transformer.ids.mask, ids)
        if bool((ids == engine.model.transformer.ids.mask).any()):
            ids = fill(engine.model.transformer, states, [ids], [seed], engine.settings)[0]
        yield ids


def _fresh(engine: Engine, text: str, seed: int, n_tokens: int, *, own_length: bool) -> Tensor:
    """(at most n_tokens, C) ids of a motion for the text alone: of `n_tokens`, or of the text's own length if that is shorter."""
    if own_length:
        ids = engine.ids_of(engine.generate(text, seed=seed).motion)
        if len(ids) <= n_tokens:
            return ids
    return engine.ids_of(engine.generate(text, seed=seed, seconds=n_tokens * FRAMES_PER_TOKEN / FPS).motion)


def _seams(opened: Tensor, start: int, end: int) -> Tensor:
    """(L,) positions of a segment that stand beside kept ids of the same body part."""
    seams = torch.zeros(len(opened), dtype=torch.bool)
    if end - start <= 2 * SEAM_TOKENS:
        return seams
    if start > 0:
        seams[start : start + SEAM_TOKENS] = True
    if end < len(opened):
        seams[end - SEAM_TOKENS : end] = True
    return seams


def _spans(opened: Tensor) -> list[tuple[int, int]]:
    """First and end position of each segment with [MASK]s."""
    at = torch.nonzero(opened.any(-1)).flatten().tolist()
    starts = [i for i in at if i - 1 not in at]
    return [(i, next(j for j in range(i, len(opened) + 1) if j not in at)) for i in starts]


def _asked(engine: Engine, text: str, seed: int, sides: tuple[str, ...] | None) -> _Asked:
    """What a motion for the text alone shows, of the first of `REFERENCES` seeds that shows gestures with a name."""
    found: _Asked | None = None
    for k in range(REFERENCES):
        made = engine.generate(text, seed=(seed + k * EDIT_STRIDE) % 2**31)
        acts = tuple(_of_text(seen, text, sides) for seen in scenes_seen(made.motion, made.scenes))
        asked = _Asked(made.scenes, acts)
        if asked.is_named:
            return asked
        found = found or asked
    assert found is not None
    return found


def _of_text(acts: Sequence[Act], text: str, sides: tuple[str, ...] | None) -> tuple[Act, ...]:
    """Acts with a name rather than without, on edited arms rather than on others, with the number that the text names."""
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


def _means_stillness(asked: _Asked) -> bool:
    return any(family in STILL_FAMILIES for scene in asked.scenes for family in families_named(scene.words))


def _frames(motion: Motion, start: int, end: int) -> Motion:
    return replace(
        motion, joints_m=motion.joints_m[start:end], head_quat_wxyz=motion.head_quat_wxyz[start:end],
        forearm_twist_rad=motion.forearm_twist_rad[start:end], features=motion.features[start:end], tokens=motion.tokens[:0],
    )  # fmt: skip
