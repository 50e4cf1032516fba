"""The model behind the generator's messages: generate, a story's next scene, edit, a motion through poses. Loads torch."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import msgspec

from daemon.generator.generated import Generated, motion_from
from daemon.generator.messages import BetweenMessage, EditMessage, GenerateMessage, SceneMessage, UnfitRequestError
from daemon.wire.requests import LONGEST_S
from mmm_core.errors import GenerationError
from mmm_core.generate.continuation import continue_motion
from mmm_core.generate.editing import Edit, edit, part_names
from mmm_core.generate.engine import Engine
from mmm_core.generate.keyframes import Keyframe, between, features_of
from mmm_core.generate.result import GenerationResult, no_motion, understood_as
from mmm_core.generate.story import Scene, StoryState, continue_story
from mmm_core.language.scope import ScopeVerdict
from mmm_core.language.warming import warmed
from mmm_core.motion.features import RestPose
from mmm_core.motion.motion import Motion

HALVES = {"upper": ("left_arm", "right_arm"), "lower": ("rest",)}
"""Parts for `upper` and `lower` in a model without an upper and a lower codebook: both arms, and the rest of the body."""


_FIRST = (("wave with your right hand", None), ("nod and raise your left hand", LONGEST_S))
"""Texts and seconds of the warm-up motions, which allocate memory."""


class EngineService:
    """Answers requests with one engine."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self.checkpoint_hash = engine.checkpoint_hash

    @classmethod
    def load(cls, model: Path | None, threads: int) -> EngineService:
        """A service with the checkpoint at `model` (None takes the shipped one), warmed up.

        Raises:
            CheckpointError: a file is missing or does not fit the model.
        """
        maker = cls(Engine.load(model, threads=threads))
        warmed()
        for text, seconds in _FIRST:
            list(maker.generate(GenerateMessage(id=0, text=text, seconds=seconds, draft=True)))
        return maker

    def generate(self, request: GenerateMessage) -> Iterator[Generated]:
        """Yield a motion that continues `before`, or a new motion, after a draft of it when one is requested and can be made.

        Raises:
            GenerationError: seconds or prefix out of range.
        """
        text, seed, seconds = request.text, request.seed, request.seconds
        if request.before is not None:
            before = _with_features(motion_from(request.before), self._engine.model.rest_pose)
            yield self._of(continue_motion(self._engine, before, request.prefix_s, text, seed=seed, seconds=seconds))
            return
        generation = self._engine.begin(text, seed=seed, seconds=seconds)
        if request.draft and (draft := generation.preview()) is not None:
            yield self._of(draft, generation.n_frames)
        yield self._of(generation.result())

    def scene(self, request: SceneMessage) -> Generated:
        """The next scene of a story.

        Raises:
            GenerationError: seconds out of range, or `told` of another model.
            msgspec.MsgspecError: `told` is no state of a story.
        """
        began_s = time.perf_counter()
        told = msgspec.msgpack.decode(request.told, type=StoryState) if request.told else StoryState()
        scene = None if request.text is None else Scene(request.text, request.seconds)
        piece, told, verdict = continue_story(self._engine, scene, told, seed=request.seed, last=request.last)
        piece = replace(piece, status=verdict.status, scope_score=verdict.score)
        return self._generated(piece, verdict, began_s, msgspec.msgpack.encode(told))

    def edit(self, request: EditMessage) -> Generated:
        """A motion of which an interval or some parts of the body are generated anew.

        Raises:
            UnfitRequestError: `bad_edit`: the edit does not fit motion or model; `not_reached`: no candidate shows the text.
        """
        parts = self._parts(request.parts)
        what = Edit(request.start_s, request.end_s, parts or None)

        def made() -> Motion:
            motion = _with_features(motion_from(request.motion), self._engine.model.rest_pose)
            edited = edit(self._engine, motion, what, request.text, seed=request.seed)
            if not edited.reached:
                raise UnfitRequestError(
                    "not_reached", f"not reached: {edited.missing}", f"a motion that {edited.asked}"
                )
            return edited.motion

        return self._unless_rejected(request.text, request.seed, made, "bad_edit")

    def between(self, request: BetweenMessage) -> Generated:
        """A motion through poses."""

        def made() -> Motion:
            poses = motion_from(request.poses)
            if len(poses.joints_m) != len(request.at_s):
                raise GenerationError(f"{len(request.at_s)} times for {len(poses.joints_m)} poses", "one for each")
            keys = [Keyframe(at_s, _frame(poses, i)) for i, at_s in enumerate(request.at_s)]
            return between(self._engine, keys, request.text, seed=request.seed)

        return self._unless_rejected(request.text, request.seed, made, "bad_keyframes")

    def _of(self, made: GenerationResult, draft_of: int = 0) -> Generated:
        how = (made.understood, made.reason, made.timings_ms, self.checkpoint_hash)
        commands, denied = (made.read.sentences, made.read.denied) if made.read else ((), ())
        return Generated(made.motion, *how, draft_of=draft_of, scenes=made.scenes, commands=commands, denied=denied)

    def _unless_rejected(self, text: str, seed: int, make: Callable[[], Motion], code: str) -> Generated:
        """The motion that `make` returns, unless the text is out of scope; an empty text is in scope."""
        began_s = time.perf_counter()
        verdict = self._engine.understand(text)[1] if text.strip() else ScopeVerdict("accepted", 1.0, "", "")
        if verdict.status == "rejected":
            return self._generated(no_motion(text, seed, verdict), verdict, began_s)
        try:
            return self._generated(make(), verdict, began_s)
        except GenerationError as error:
            raise UnfitRequestError(code, error.asked, error.allowed) from error

    def _generated(self, motion: Motion, verdict: ScopeVerdict, began_s: float, told: bytes = b"") -> Generated:
        timings_ms = {"made": 1e3 * (time.perf_counter() - began_s)}
        return Generated(motion, understood_as(verdict), verdict.reason, timings_ms, self.checkpoint_hash, told)

    def _parts(self, asked: list[str]) -> tuple[str, ...]:
        """Names of this model's parts; `upper` and `lower` stand for several parts in a model without such a codebook."""
        names = part_names(self._engine)
        found: list[str] = []
        for part in asked:
            halves = HALVES.get(part, ())
            found += halves if halves and part not in names and set(halves) <= set(names) else (part,)
        return tuple(dict.fromkeys(found))


def _with_features(motion: Motion, rest_pose: RestPose) -> Motion:
    """The motion with the features that its joints have for a model, when it came with neither features nor ids."""
    if motion.features.any() or len(motion.tokens):
        return motion
    return replace(motion, features=features_of(motion, rest_pose).numpy())


def _frame(motion: Motion, i: int) -> Motion:
    """Frame `i` of a motion, without ids."""
    return replace(
        motion, joints_m=motion.joints_m[i : i + 1], head_quat_wxyz=motion.head_quat_wxyz[i : i + 1],
        forearm_twist_rad=motion.forearm_twist_rad[i : i + 1], features=motion.features[i : i + 1],
        tokens=motion.tokens[:0],
    )  # fmt: skip
