"""Long motion from a list of texts, with generated transitions, in constant memory, from the first segment on.

MMM (arXiv 2312.03596) sec. 3.3: each text is a row of its own; between neighbours a few masked tokens are filled with the
end of one and the beginning of the next as context. The paper decodes everything at the end; here the decoder runs over
a moving window, so motion begins with the first segment and a story may last for ever.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

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


@dataclass(frozen=True)
class Scene:
    """One text of a story; `seconds` None lets the model choose."""

    text: str
    seconds: float | None = None


@dataclass(frozen=True)
class _Segment:
    scene: Scene
    verdict: ScopeVerdict
    states: TextStates
    ids: Tensor  # (L, C)


def tell(engine: Engine, scenes: Iterable[Scene], *, seed: int = 0) -> Iterator[Motion]:
    """Pieces of one long motion, in order; joined they are the story. A piece says which text it mainly belongs to.

    Scenes are read as they are needed, at most `READ_AHEAD` + 1 of them before their motion is due. A scene that is
    rejected is left out; its piece has no frames and says why by its status.

    Raises:
        GenerationError: seed or a scene's seconds out of range.
    """
    check_seed(seed)
    decoder, root = StreamingDecoder(engine.model.tokenizer), Root()
    previous: _Segment | None = None
    for segment in _segments(engine, scenes, seed):
        if segment.verdict.status == "rejected":
            yield no_motion(segment.scene.text, seed, segment.verdict)
            continue
        if previous is None:
            new = segment.ids
        else:
            between = transition(engine, previous.states, previous.ids, segment.ids, seed, engine.settings)
            new = torch.cat([between, segment.ids])
        features = decoder.push(new).numpy()
        if len(features):
            yield engine.motion_of_features(features, new, segment.scene.text, seed, segment.verdict, root)
            root = root_after(features, root)
        previous = segment
    rest = decoder.finish().numpy()
    if previous is not None and len(rest):
        yield engine.motion_of_features(rest, previous.ids[:0], previous.scene.text, seed, previous.verdict, root)


def transition(
    engine: Engine, text: TextStates, left: Tensor, right: Tensor, seed: int, settings: SamplingSettings
) -> Tensor:
    """(2, C) ids between two rows, for the left one's text: half of each row is the context."""
    row = transition_row(left, right, engine.model.transformer.ids.mask)
    n_left = _half(left)
    return fill(engine.model.transformer, text, [row], [seed], settings)[0][n_left : n_left + TRANSITION_TOKENS]


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


def _segments(engine: Engine, scenes: Iterable[Scene], seed: int) -> Iterator[_Segment]:
    """Segments in order: the first alone, so that motion begins at once, then in batches."""
    waiting: list[tuple[int, Scene]] = []
    size = 1
    for number, scene in enumerate(scenes):
        waiting.append((number, scene))
        if len(waiting) == size:
            yield from _batch(engine, waiting, seed)
            waiting, size = [], READ_AHEAD
    if waiting:
        yield from _batch(engine, waiting, seed)


def _batch(engine: Engine, scenes: list[tuple[int, Scene]], seed: int) -> Iterator[_Segment]:
    understood = [engine.understand(scene.text) for _, scene in scenes]
    nothing = torch.zeros(0, engine.model.tokenizer.n_codebooks, dtype=torch.int64)
    ids: dict[int, Tensor] = {}
    taken = [i for i, (_, verdict) in enumerate(understood) if verdict.status != "rejected"]
    if taken:
        rows, seeds = [], []
        for i in taken:
            number, scene = scenes[i]
            n_frames = (engine.predicted_frames(understood[i][0]) if scene.seconds is None
                        else frames_for_seconds(scene.seconds, FPS))  # fmt: skip
            rows.append(empty_row(engine.model.transformer, tokens_for_frames(n_frames)))
            seeds.append((seed + 104_729 * number) % 2**31)
        texts = TextStates.stacked([understood[i][0] for i in taken])
        ids = dict(zip(taken, fill(engine.model.transformer, texts, rows, seeds, engine.settings), strict=True))
    for i, (states, verdict) in enumerate(understood):
        yield _Segment(scenes[i][1], verdict, states, ids.get(i, nothing))


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
