"""Generates long motion from a list of texts, with generated transitions and in constant memory; it begins with the first text.

MMM (arXiv 2312.03596) sec. 3.3: each text is a row of its own; between neighbours a few masked tokens are filled with the
end of one and the beginning of the next as context. The paper decodes all ids at the end; here the decoder runs over
a moving window, so motion begins with the first scene and a story may last for ever.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice

import torch
from torch import Tensor

from mmm_core.errors import GenerationError
from mmm_core.generate.at_once import composed, features_of
from mmm_core.generate.engine import Engine
from mmm_core.generate.interpretation import ReadCommand, interpret_all
from mmm_core.generate.motion_model import check_seed
from mmm_core.generate.result import no_motion
from mmm_core.generate.sequence import (
    COMMAND_STRIDE,
    TOGETHER_STRIDE,
    Step,
    joined,
    steps_of,
    stretches_of,
)
from mmm_core.generate.transitions import transitions
from mmm_core.language.scope import ScopeVerdict
from mmm_core.model.sampling import empty_row
from mmm_core.model.streaming_decoder import StreamingDecoder
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import FRAMES_PER_TOKEN, frames_for_seconds
from mmm_core.motion.features import Root, root_after
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.performing import performed

READ_AHEAD = 8
"""Scenes that are generated in one batch, after the first scene."""
SCENE_STRIDE = 104_729
"""Distance between the seeds of scenes."""


@dataclass(frozen=True)
class Scene:
    """One text of a story; `seconds` None lets the model choose."""

    text: str
    seconds: float | None = None


@dataclass(frozen=True)
class _Segment:
    scene: Scene
    verdict: ScopeVerdict
    steps: list[Step]  # none when rejected
    ids: Tensor  # (L, C)


def generate_story(engine: Engine, scenes: Iterable[Scene], *, seed: int = 0) -> Iterator[Motion]:
    """Yields one long motion in chunks, in order; each chunk carries the text of most of its frames.

    Scenes are read when they are needed, at most `READ_AHEAD` + 1 ahead of their motion. A rejected scene yields a chunk
    without frames and with the status "rejected".

    Raises:
        GenerationError: seed or a scene's seconds out of range.
    """
    check_seed(seed)
    decoder, root = StreamingDecoder(engine.model.tokenizer), Root()
    last: _Segment | None = None
    for batch in _batches(scenes):
        segments = _segments(engine, batch, seed)
        taken = [s for s in segments if len(s.ids)]
        between = iter(_between(engine, [last, *taken] if last else taken, seed))
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
class StoryState:
    """State of a story between two scenes. Its size does not grow with the story.

    Attributes:
        n_scenes: scenes so far, rejected ones included.
        text: text of the last scene that was not rejected.
        command: the last command of that text.
        segment: ids of that scene, L rows of C.
        window: ids that the decoder still needs, rows of C.
        n_context: rows of `window` whose frames are part of an earlier motion.
    """

    n_scenes: int = 0
    text: str = ""
    command: str = ""
    segment: list[list[int]] = field(default_factory=list)
    window: list[list[int]] = field(default_factory=list)
    n_context: int = 0


def continue_story(
    engine: Engine, scene: Scene | None, state: StoryState, *, seed: int = 0, last: bool = False
) -> tuple[Motion, StoryState, ScopeVerdict]:
    """The motion of a story's next scene, the story's state after it, and the scope verdict of its text.

    Scene by scene the ids are those of `generate_story`. The caller keeps the state between the calls and the engine nothing, so
    another engine can continue the story. A motion may have no frames (a rejected scene, or one shorter than the context that
    the decoder needs after a token). The joints of each motion start at the origin.

    Args:
        engine: the model.
        scene: the next scene; None adds none and, with `last`, ends the story.
        state: state from the call before; `StoryState()` for the first scene.
        seed: seed of the story.
        last: whether the story ends here; the motion then includes the last frames.

    Raises:
        GenerationError: seed or seconds out of range, or ids in `state` that this model does not have.
    """
    check_seed(seed)
    n_codebooks = engine.model.tokenizer.n_codebooks
    before, window = (
        _ids_of(rows, n_codebooks, engine.model.transformer.ids.n_codes) for rows in (state.segment, state.window)
    )
    decoder = StreamingDecoder(engine.model.tokenizer, window, state.n_context)
    text, command, segment, new = state.text, state.command, before, before[:0]
    verdict = ScopeVerdict("accepted", 1.0, "", "")
    if scene is not None:
        made = _segments(engine, [(state.n_scenes, scene)], seed)[0]
        verdict = made.verdict
        if len(made.ids):
            text, command, segment, new = scene.text, made.steps[-1].commands[0].text, made.ids, made.ids
            if len(before):
                said = Step((ReadCommand(state.command, engine.read([state.command])),), len(before))
                left = _Segment(Scene(state.text), verdict, [said], before)
                new = torch.cat([*_between(engine, [left, made], seed), made.ids])
    features = torch.cat([decoder.push(new), *([decoder.finish()] if last else [])]).numpy()
    name = text if scene is None else scene.text
    some = len(features) > 0
    piece = engine.motion_of_features(features, new, name, seed, verdict) if some else no_motion(name, seed, verdict)
    after = StoryState(
        state.n_scenes + (scene is not None),
        text,
        command,
        segment.tolist(),
        decoder.window.tolist(),
        decoder.n_context,
    )
    return piece, after, verdict


def _ids_of(rows: list[list[int]], n_codebooks: int, n_codes: int) -> Tensor:
    """(L, C) ids of a story's state, checked against this model."""
    if any(len(row) != n_codebooks or not all(0 <= i < n_codes for i in row) for row in rows):
        raise GenerationError(
            "a story of another model's ids was to go on", f"{n_codebooks} ids below {n_codes} a token"
        )
    return torch.tensor(rows, dtype=torch.int64).reshape(len(rows), n_codebooks)


def _between(engine: Engine, segments: list[_Segment], seed: int) -> list[Tensor]:
    """(2, C) ids between neighbouring segments."""
    return transitions(engine, [s.ids for s in segments], [s.steps[-1].states for s in segments], seed)


def _batches(scenes: Iterable[Scene]) -> Iterator[list[tuple[int, Scene]]]:
    """Numbered scenes in batches: the first scene alone, so that motion begins at once, then `READ_AHEAD` together."""
    numbered = enumerate(scenes)
    size = 1
    while batch := list(islice(numbered, size)):
        yield batch
        size = READ_AHEAD


def _segments(engine: Engine, scenes: list[tuple[int, Scene]], seed: int) -> list[_Segment]:
    """A segment for each scene; the commands of all scenes are generated in one batch."""
    with torch.inference_mode():
        read = interpret_all(engine, [scene.text for _, scene in scenes], fresh=False)
    asked: list[list[Step]] = []
    seeds: list[int] = []
    for (number, scene), one in zip(scenes, read, strict=True):
        n_frames = None if scene.seconds is None else frames_for_seconds(scene.seconds, FPS)
        asked.append(steps_of(engine, one.steps, n_frames) if one.steps else [])
        begin = seed + SCENE_STRIDE * number
        seeds += [
            (begin + COMMAND_STRIDE * i + TOGETHER_STRIDE * k) % 2**31
            for i, step in enumerate(asked[-1])
            for k, _ in enumerate(step.commands)
        ]
    flat = [(c, step.tokens_of(k)) for steps in asked for step in steps for k, c in enumerate(step.commands)]
    rows = [empty_row(engine.model.transformer, n) for _, n in flat]
    words, texts = [c.text for c, _ in flat], [c.states for c, _ in flat]
    made = iter(engine.fill(words, TextStates.stacked(texts), rows, seeds) if rows else [])
    nothing = torch.zeros(0, engine.model.tokenizer.n_codebooks, dtype=torch.int64)
    return [
        _Segment(scene, one.verdict, steps, _ids(engine, steps, made, seed) if steps else nothing)
        for (_, scene), one, steps in zip(scenes, read, asked, strict=True)
    ]


def _ids(engine: Engine, steps: list[Step], made: Iterator[Tensor], seed: int) -> Tensor:
    """(L, C) ids of a scene's steps in their manner, given the rows of all commands in order.

    Commands done at the same time are put together as body parts of a motion, which is encoded again, because the decoder of a
    story takes ids only.
    """
    rows = [[next(made) for _ in step.commands] for step in steps]
    with torch.inference_mode():
        whole = [composed(engine, s.commands, r) for s, r in zip(steps, rows, strict=True)]
        ids = joined(engine, steps, [step.ids for step in whole], seed)
        stretches = stretches_of(steps, [len(step.ids) for step in whole])
        if all(s.plain for s in stretches) and not any(step.rows for step in whole):
            return ids
        begins = [s.end // FRAMES_PER_TOKEN - len(step.ids) for s, step in zip(stretches, whole, strict=True)]
        features = features_of(engine.model.tokenizer, ids, list(zip(begins, whole, strict=True)))
        if any(not s.plain for s in stretches):
            features, _ = performed(features, stretches)
        n_frames = len(features) // FRAMES_PER_TOKEN * FRAMES_PER_TOKEN
        return engine.model.tokenizer.encode(torch.from_numpy(features[None, :n_frames]))[0]


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
