"""Long motion from a list of texts, with generated transitions, in constant memory, from the first segment on.

MMM (arXiv 2312.03596) sec. 3.3: each text is a row of its own; between neighbours a few masked tokens are filled with the
end of one and the beginning of the next as context. The paper decodes everything at the end; here the decoder runs over
a moving window, so motion begins with the first segment and a story may last for ever.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import islice, pairwise

import torch
from torch import Tensor

from mmm_core.engine import Engine, check_seed, no_motion
from mmm_core.errors import GenerationError
from mmm_core.features import Root, root_after
from mmm_core.motion import FPS, Motion
from mmm_core.sampling import SamplingSettings, empty_row, fill
from mmm_core.scope import ScopeVerdict
from mmm_core.streaming import StreamingDecoder
from mmm_core.text import TextStates
from mmm_core.tokens import MAX_TOKENS, frames_for_seconds, tokens_for_frames

TRANSITION_TOKENS = 2
"""Generated between two segments: 0.4 s, as in the released model."""
READ_AHEAD = 8
"""Segments made in one batch once the first is on its way."""
SCENE_STRIDE = 104_729
"""Between the seeds of scenes."""


@dataclass(frozen=True)
class Scene:
    """One text of a story; `seconds` None lets the model choose."""

    text: str
    seconds: float | None = None


@dataclass(frozen=True)
class _Segment:
    scene: Scene
    verdict: ScopeVerdict
    text: TextStates
    ids: Tensor  # (L, C); none when rejected


def tell(engine: Engine, scenes: Iterable[Scene], *, seed: int = 0) -> Iterator[Motion]:
    """Pieces of one long motion, in order; joined they are the story. A piece says which text it mainly belongs to.

    Scenes are read as they are needed, at most `READ_AHEAD` + 1 of them before their motion is due. A scene that is
    rejected is left out; its piece has no frames and says why by its status.

    Raises:
        GenerationError: seed or a scene's seconds out of range.
    """
    check_seed(seed)
    decoder, root = StreamingDecoder(engine.model.tokenizer), Root()
    last: _Segment | None = None
    for batch in _batches(scenes):
        segments = _segments(engine, batch, seed)
        taken = [s for s in segments if len(s.ids)]
        between = iter(_transitions(engine, [last, *taken] if last else taken, seed))
        for segment in segments:
            if not len(segment.ids):
                yield no_motion(segment.scene.text, seed, segment.verdict)
                continue
            new = segment.ids if last is None else torch.cat([next(between), segment.ids])
            features = decoder.push(new).numpy()
            if len(features):
                yield engine.motion_of_features(features, new, segment.scene.text, seed, segment.verdict, root)
                root = root_after(features, root)
            last = segment
    rest = decoder.finish().numpy()
    if last is not None and len(rest):
        yield engine.motion_of_features(rest, last.ids[:0], last.scene.text, seed, last.verdict, root)


@dataclass(frozen=True)
class Told:
    """Where a story stands after some of its scenes: all that the next one needs, however much was told before.

    Attributes:
        n_scenes: scenes so far, those left out included.
        text: of the last one that was not left out.
        segment: its ids, L rows of C.
        window: ids that the decoder still needs, rows of C.
        n_context: how many of these have their frames already.
    """

    n_scenes: int = 0
    text: str = ""
    segment: list[list[int]] = field(default_factory=list)
    window: list[list[int]] = field(default_factory=list)
    n_context: int = 0


def tell_on(
    engine: Engine, scene: Scene | None, told: Told, *, seed: int = 0, last: bool = False
) -> tuple[Motion, Told, ScopeVerdict]:
    """One scene more of a story: its next piece, where it stands then, how the text was taken.

    Piece by piece this gives the ids that `tell` gives, without anything being kept between the calls: whoever asks keeps
    `Told`, so a story goes on with another engine when the first is gone. A piece may have no frames (a rejected scene, or
    one too short for the decoder's halo). Joints start at the origin in each piece.

    Args:
        engine: the model.
        scene: what comes next; None only leads to the end.
        told: what the call before gave; `Told()` for the first.
        seed: of the story.
        last: whether the story ends here; its last frames are then given too.

    Raises:
        GenerationError: seed or seconds out of range, or ids in `told` that this model does not have.
    """
    check_seed(seed)
    n_codebooks = engine.model.tokenizer.n_codebooks
    before, window = (
        _ids_of(rows, n_codebooks, engine.model.transformer.ids.n_codes) for rows in (told.segment, told.window)
    )
    decoder = StreamingDecoder(engine.model.tokenizer, window, told.n_context)
    text, segment, new = told.text, before, before[:0]
    verdict = ScopeVerdict("accepted", 1.0, "", "")
    if scene is not None:
        made = _segments(engine, [(told.n_scenes, scene)], seed)[0]
        verdict = made.verdict
        if len(made.ids):
            text, segment, new = scene.text, made.ids, made.ids
            if len(before):
                left = _Segment(Scene(told.text), verdict, engine.understand(told.text)[0], before)
                new = torch.cat([*_transitions(engine, [left, made], seed), made.ids])
    features = torch.cat([decoder.push(new), *([decoder.finish()] if last else [])]).numpy()
    name = text if scene is None else scene.text
    some = len(features) > 0
    piece = engine.motion_of_features(features, new, name, seed, verdict) if some else no_motion(name, seed, verdict)
    after = Told(
        told.n_scenes + (scene is not None), text, segment.tolist(), decoder.window.tolist(), decoder.n_context
    )
    return piece, after, verdict


def _ids_of(rows: list[list[int]], n_codebooks: int, n_codes: int) -> Tensor:
    """(L, C) ids, checked."""
    if any(len(row) != n_codebooks or not all(0 <= i < n_codes for i in row) for row in rows):
        raise GenerationError(
            "a story of another model's ids was to go on", f"{n_codebooks} ids below {n_codes} a token"
        )
    return torch.tensor(rows, dtype=torch.int64).reshape(len(rows), n_codebooks)


def _transitions(engine: Engine, segments: list[_Segment], seed: int) -> list[Tensor]:
    """(2, C) ids between neighbours, for the left one's text: half of each row is the context. One step, one batch."""
    if len(segments) < 2:
        return []
    transformer = engine.model.transformer
    rows = [transition_row(a.ids, b.ids, transformer.ids.mask) for a, b in pairwise(segments)]
    text = TextStates.stacked([s.text for s in segments[:-1]])
    settings = replace(engine.settings, fewest_steps=1, most_steps=1)
    filled = fill(transformer, text, rows, [seed] * len(rows), settings)
    return [new[(row == transformer.ids.mask).any(-1)] for new, row in zip(filled, rows, strict=True)]


def transition_row(left: Tensor, right: Tensor, mask_id: int) -> Tensor:
    """End of `left`, [MASK]s, beginning of `right`."""
    hole = left.new_full((TRANSITION_TOKENS, left.shape[1]), mask_id)
    return torch.cat([left[len(left) - _half(left) :], hole, right[: _half(right)]])


def official_transition_settings(settings: SamplingSettings) -> SamplingSettings:
    """As the released code fills transitions: one step at temperature 1."""
    return replace(settings, official=True, most_steps=1, fewest_steps=1, temperature=1.0)


def _half(ids: Tensor) -> int:
    """Half of a row, as context; the longest rows give one token less, so that both halves and the hole fit."""
    half = len(ids) // 2
    return half - 1 if 2 * half >= MAX_TOKENS - 1 else half


def _batches(scenes: Iterable[Scene]) -> Iterator[list[tuple[int, Scene]]]:
    """Numbered scenes: the first alone, so that motion begins at once, then several together."""
    numbered = enumerate(scenes)
    size = 1
    while batch := list(islice(numbered, size)):
        yield batch
        size = READ_AHEAD


def _segments(engine: Engine, scenes: list[tuple[int, Scene]], seed: int) -> list[_Segment]:
    """A segment for each scene, made in one batch."""
    understood = engine.understand_all([scene.text for _, scene in scenes])
    rows, seeds, texts = [], [], []
    for (number, scene), (text, verdict) in zip(scenes, understood, strict=True):
        if verdict.status != "rejected":
            n_frames = (
                engine.predicted_frames(text) if scene.seconds is None else frames_for_seconds(scene.seconds, FPS)
            )
            rows.append(empty_row(engine.model.transformer, tokens_for_frames(n_frames)))
            seeds.append((seed + SCENE_STRIDE * number) % 2**31)
            texts.append(text)
    made = iter(fill(engine.model.transformer, TextStates.stacked(texts), rows, seeds, engine.settings) if rows else [])
    nothing = torch.zeros(0, engine.model.tokenizer.n_codebooks, dtype=torch.int64)
    return [
        _Segment(scene, verdict, text, nothing if verdict.status == "rejected" else next(made))
        for (_, scene), (text, verdict) in zip(scenes, understood, strict=True)
    ]


def check_scenes(scenes: list[Scene]) -> None:
    """Raises GenerationError for an empty story or a scene whose seconds are out of range, naming its number."""
    if not scenes:
        raise GenerationError("a story without a text", "at least one text")
    for number, scene in enumerate(scenes, 1):
        if scene.seconds is not None:
            try:
                frames_for_seconds(scene.seconds, FPS)
            except GenerationError as error:
                raise GenerationError(f"scene {number} ('{scene.text[:40]}'): {error.asked}", error.allowed) from None
