"""Long motion from a list of texts, with generated transitions, in constant memory, from the first segment on.

MMM (arXiv 2312.03596) sec. 3.3: each text is a row of its own; between neighbours a few masked tokens are filled with the
end of one and the beginning of the next as context. The paper decodes everything at the end; here the decoder runs over
a moving window, so motion begins with the first segment and a story may last for ever.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice

import torch
from torch import Tensor

from mmm_core.errors import GenerationError
from mmm_core.generate.engine import Engine, check_seed
from mmm_core.generate.result import no_motion
from mmm_core.generate.sequence import COMMAND_STRIDE, Command, commands_of, joined, transitions
from mmm_core.language.scope import ScopeVerdict
from mmm_core.model.sampling import empty_row, fill
from mmm_core.model.streaming_decoder import StreamingDecoder
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import frames_for_seconds
from mmm_core.motion.features import Root, root_after
from mmm_core.motion.motion import FPS, Motion

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
    commands: list[Command]  # none when rejected
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
class Told:
    """Where a story stands after some of its scenes: all that the next one needs, however much was told before.

    Attributes:
        n_scenes: scenes so far, those left out included.
        text: of the last one that was not left out.
        command: the last of that text's commands.
        segment: its ids, L rows of C.
        window: ids that the decoder still needs, rows of C.
        n_context: how many of these have their frames already.
    """

    n_scenes: int = 0
    text: str = ""
    command: str = ""
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
    text, command, segment, new = told.text, told.command, before, before[:0]
    verdict = ScopeVerdict("accepted", 1.0, "", "")
    if scene is not None:
        made = _segments(engine, [(told.n_scenes, scene)], seed)[0]
        verdict = made.verdict
        if len(made.ids):
            text, command, segment, new = scene.text, made.commands[-1].text, made.ids, made.ids
            if len(before):
                said = Command(told.command, engine.understand(told.command)[0], len(before))
                left = _Segment(Scene(told.text), verdict, [said], before)
                new = torch.cat([*_between(engine, [left, made], seed), made.ids])
    features = torch.cat([decoder.push(new), *([decoder.finish()] if last else [])]).numpy()
    name = text if scene is None else scene.text
    some = len(features) > 0
    piece = engine.motion_of_features(features, new, name, seed, verdict) if some else no_motion(name, seed, verdict)
    after = Told(
        told.n_scenes + (scene is not None), text, command, segment.tolist(), decoder.window.tolist(), decoder.n_context
    )
    return piece, after, verdict


def _ids_of(rows: list[list[int]], n_codebooks: int, n_codes: int) -> Tensor:
    """(L, C) ids, checked."""
    if any(len(row) != n_codebooks or not all(0 <= i < n_codes for i in row) for row in rows):
        raise GenerationError(
            "a story of another model's ids was to go on", f"{n_codebooks} ids below {n_codes} a token"
        )
    return torch.tensor(rows, dtype=torch.int64).reshape(len(rows), n_codebooks)


def _between(engine: Engine, segments: list[_Segment], seed: int) -> list[Tensor]:
    """(2, C) ids between neighbouring segments."""
    return transitions(engine, [s.ids for s in segments], [s.commands[-1].states for s in segments], seed)


def _batches(scenes: Iterable[Scene]) -> Iterator[list[tuple[int, Scene]]]:
    """Numbered scenes: the first alone, so that motion begins at once, then several together."""
    numbered = enumerate(scenes)
    size = 1
    while batch := list(islice(numbered, size)):
        yield batch
        size = READ_AHEAD


def _segments(engine: Engine, scenes: list[tuple[int, Scene]], seed: int) -> list[_Segment]:
    """A segment for each scene; all their commands are made in one batch."""
    understood = engine.understand_all([scene.text for _, scene in scenes])
    asked: list[list[Command]] = []
    seeds: list[int] = []
    for (number, scene), (states, verdict) in zip(scenes, understood, strict=True):
        if verdict.status == "rejected":
            asked.append([])
            continue
        n_frames = None if scene.seconds is None else frames_for_seconds(scene.seconds, FPS)
        asked.append(commands_of(engine, verdict.kept or scene.text, states, n_frames))
        seeds += [(seed + SCENE_STRIDE * number + COMMAND_STRIDE * i) % 2**31 for i in range(len(asked[-1]))]
    rows = [empty_row(engine.model.transformer, c.n_tokens) for commands in asked for c in commands]
    texts = [c.states for commands in asked for c in commands]
    made = iter(fill(engine.model.transformer, TextStates.stacked(texts), rows, seeds, engine.settings) if rows else [])
    nothing = torch.zeros(0, engine.model.tokenizer.n_codebooks, dtype=torch.int64)
    return [
        _Segment(
            scene,
            verdict,
            commands,
            joined(engine, commands, [next(made) for _ in commands], seed) if commands else nothing,
        )
        for (_, scene), (_, verdict), commands in zip(scenes, understood, asked, strict=True)
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
