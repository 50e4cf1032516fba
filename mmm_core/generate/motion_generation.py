"""Generates one motion: first a preview after one decoding step, then the motion.

MMM (arXiv 2312.03596) sec. 3.3 predicts all tokens in every step, so that the first step yields a whole motion already. The
first tokens of that preview are not masked again (`DecodeSettings.opening`): a robot may begin with the preview and continue
with the motion, whose later tokens are decoded with those of the opening as context. The motion does not depend on whether
the preview was asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import torch
from torch import Tensor

from mmm_core.generate.at_once import StepIds, arms_of, composed, features_of, mirrored_ids
from mmm_core.generate.interpretation import ReadCommand, interpret
from mmm_core.generate.kept_sizes import with_kept_sizes
from mmm_core.generate.lasting_strokes import with_lasting_strokes
from mmm_core.generate.motion_model import MotionModel
from mmm_core.generate.repeated_strokes import expected_tokens, repeated, with_few_strokes
from mmm_core.generate.result import GenerationResult, StageTimer, no_motion, understood_as
from mmm_core.generate.sequence import (
    COMMAND_STRIDE,
    TOGETHER_STRIDE,
    Step,
    joined,
    steps_of,
    stretches_of,
)
from mmm_core.generate.transitions import TRANSITION_TOKENS
from mmm_core.inference.checkpoint import Model
from mmm_core.inference.people_weights import PeopleWeights
from mmm_core.language.mirroring import mirror_words
from mmm_core.model.sampling import FirstStep, SamplingSettings, empty_row, pseudo_log_likelihood
from mmm_core.model.tokens import FRAMES_PER_TOKEN, tokens_for_frames
from mmm_core.motion.body_parts import BodyPart
from mmm_core.motion.motion import FPS
from mmm_core.motion.performing import performed
from mmm_core.recognition.seen import Scene

OPENING_TOKENS = 2
"""Tokens that the preview and the motion share: 0.4 s, longer than generating and retargeting the motion usually takes.
docs/model.md says what they cost in probes."""
CANDIDATE_STRIDE = 7_919_999
"""Distance between the seeds of candidates, so that neighbouring seeds share none."""


class MotionGeneration:
    """One motion to generate; `Engine.begin` makes it.

    Attributes:
        n_frames: expected length of the motion; a motion whose strokes are repeated may become longer or shorter.
    """

    def __init__(self, engine: MotionModel, text: str, seed: int, n_frames: int | None, candidates: int) -> None:
        """Read the text; arguments as in `Engine.generate`, checked."""
        self._engine, self._seed, self._asked_frames = engine, seed, n_frames
        self._timer = StageTimer()
        with torch.inference_mode():
            self._read = interpret(engine, text)
            self._text = self._read.reading.text
            steps, self._repetitions = list(self._read.steps), [None] * len(self._read.steps)
            if n_frames is None and engine.model.is_ours:
                steps = with_lasting_strokes(engine, steps)
            self._steps_in_full = steps
            if n_frames is None and engine.model.is_ours:
                steps, self._repetitions = with_few_strokes(engine, steps)
            self._steps = steps_of(engine, steps, n_frames) if steps else []
        self._people = self._weights_of_the_whole()
        self._verdict, self._mirrored = self._read.verdict, self._read.is_mirrored
        self._first_steps = [FirstStep() for _ in self._steps[0].commands] if self._steps else []
        self._candidates = candidates
        n_tokens = sum(expected_tokens(s.n_tokens, n) for s, n in zip(self._steps, self._repetitions, strict=False))
        n_tokens += TRANSITION_TOKENS * max(0, len(self._steps) - 1)
        self.n_frames = n_tokens * FRAMES_PER_TOKEN if n_frames is None else n_frames
        if len(self._steps) == 1 and n_frames is None:
            self.n_frames = round(self.n_frames / self._steps[0].manner.tempo)
        self._timer.lap("text")

    def _weights_of_the_whole(self) -> PeopleWeights | None:
        """The weights for captions of people if the text is one command that they are for; its ids are those of their tokenizer.

        Commands beside others have ids of the model's own tokenizer (`MotionModel.fill`), so that they can be joined.
        """
        if len(self._steps) != 1 or len(self._steps[0].commands) != 1:
            return None
        command = self._steps[0].commands[0]
        return None if command.is_mirrored else self._engine.weights_for(command.text, command.states.sentence[0])

    @property
    def settings(self) -> SamplingSettings:
        """Sampling settings of the engine, with an opening where the model can have one."""
        settings = self._engine.settings
        has_opening = self._engine.model.is_ours and not settings.official
        return replace(settings, opening=OPENING_TOKENS) if has_opening else settings

    def preview(self) -> GenerationResult | None:
        """The first command's motion after a single decoding step; None where there is no motion or no opening.

        Preview and motion share their first 0.4 s, but for the last frames of these, which later tokens still change. A text
        with words of size or hold has no opening, because they depend on the whole motion.
        """
        if not self._steps or not self._opens:
            return None
        with torch.inference_mode():
            first = self._preview_ids
            self._timer.lap("draft")
            n_frames = self._asked_frames if len(self._steps) == 1 else None
            return self._result_of(first.ids, [first], n_frames, "draft motion")

    def result(self) -> GenerationResult:
        """The motion, or an empty one and the reason where the text is rejected."""
        if not self._steps:
            nothing = no_motion(self._text, self._seed, self._verdict)
            understood = understood_as(self._verdict)
            return GenerationResult(
                nothing, understood, self._verdict.reason, self._timer.laps_ms, read=self._read.reading
            )
        with torch.inference_mode():
            made = [self._step_ids(i, step) for i, step in enumerate(self._steps)]
            ids = joined(self._engine, self._steps, [step.ids for step in made], self._seed)
            self._timer.lap("decode")
            return self._result_of(ids, made, self._asked_frames, "motion")

    @property
    def _weights(self) -> Model | PeopleWeights:
        """The transformer that fills the rows, and the tokenizer of their ids."""
        return self._people or self._engine.model

    @property
    def _opens(self) -> bool:
        """Whether the preview of the first step begins as the motion does."""
        manner = self._steps[0].manner
        return bool(self.settings.opening) and manner.size == 1.0 and not manner.hold_s

    @cached_property
    def _drafts(self) -> list[Tensor]:
        """(L, C) ids of each command of the first step after one decoding step: the likeliest ids, without randomness."""
        step, one_step = self._steps[0], replace(self.settings, steps=1, temperature=0.0)
        rows = [empty_row(self._engine.model.transformer, step.tokens_of(k)) for k in range(len(step.commands))]
        return [
            self._fill(command, [row], [self._seed_of(0, k)], one_step, self._first_steps[k])[0]
            for k, (command, row) in enumerate(zip(step.commands, rows, strict=True))
        ]

    @cached_property
    def _preview_ids(self) -> StepIds:
        """The ids of the first step after one decoding step."""
        return self._together(self._steps[0], self._drafts)

    @cached_property
    def _preview_arms(self) -> list[tuple[BodyPart, ...]]:
        """The arms of each command of the first step; a command whose words name none has the arms that its draft moves."""
        commands = self._steps[0].commands
        return arms_of(self._engine, commands, self._mirrored_where_asked(commands, self._drafts))

    def _step_ids(self, i: int, step: Step) -> StepIds:
        """The ids of a step; the first one begins as its preview does."""
        rows = [self._command_row(i, k, command, step.tokens_of(k)) for k, command in enumerate(step.commands)]
        made = self._together(step, rows)
        if i == 0 and self._opens:
            made.ids[: self.settings.opening] = self._preview_ids.ids[: self.settings.opening]
        return made

    def _together(self, step: Step, rows: Sequence[Tensor]) -> StepIds:
        """The ids of a step's commands, done at once."""
        rows = self._mirrored_where_asked(step.commands, rows)
        has_opening = len(rows) > 1 and step is self._steps[0] and self._opens
        return composed(self._engine, step.commands, rows, self._preview_arms if has_opening else None)

    def _mirrored_where_asked(self, commands: Sequence[ReadCommand], rows: Sequence[Tensor]) -> list[Tensor]:
        return [mirrored_ids(self._engine, r) if c.is_mirrored else r for c, r in zip(commands, rows, strict=True)]

    def _command_row(self, i: int, k: int, command: ReadCommand, n_tokens: int) -> Tensor:
        """(L, C) ids of a command: the likeliest candidate, with as many strokes as its words name."""
        n, settings = self._candidates, self.settings
        seeds = [self._seed_of(i, k) + c * CANDIDATE_STRIDE for c in range(n)]
        row = empty_row(self._engine.model.transformer, n_tokens)
        if n > 1 and i == 0 and self._opens:  # all candidates begin as the preview does
            row[: settings.opening] = self._drafts[k][: settings.opening]
        first = self._first_steps[k] if i == 0 and n == 1 else None
        candidates = self._fill(command, [row] * n, seeds, settings, first)
        ids = candidates[0] if n == 1 else self._likeliest(command, candidates)
        repetition = self._repetitions[i]
        if repetition is None:
            return ids
        many = repeated(self._engine, self._weights.tokenizer, command, ids, repetition, settings.opening)
        return self._as_said(i, seeds[0]) if many is None else many

    def _as_said(self, i: int, seed: int) -> Tensor:
        """(L, C) ids of a step of one command whose strokes cannot be repeated: the model makes as many as it can."""
        command = self._steps_in_full[i][0]
        row = empty_row(
            self._engine.model.transformer, tokens_for_frames(self._engine.predicted_frames(command.states))
        )
        return self._fill(command, [row], [seed], self.settings)[0]

    def _seed_of(self, i: int, k: int) -> int:
        """The seed of the k-th command of a step."""
        return (self._seed + i * COMMAND_STRIDE + k * TOGETHER_STRIDE) % 2**31

    def _likeliest(self, command: ReadCommand, candidates: Sequence[Tensor]) -> Tensor:
        likely = pseudo_log_likelihood(self._weights.transformer, command.states.repeated(len(candidates)), candidates)
        return candidates[int(likely.argmax())]

    def _fill(
        self, command: ReadCommand, rows: Sequence[Tensor], seeds: Sequence[int], settings: SamplingSettings,
        first: FirstStep | None = None,
    ) -> list[Tensor]:  # fmt: skip
        states = command.states if len(rows) == 1 else command.states.repeated(len(rows))
        if self._people is not None:
            return self._engine.fill_with(self._people, states, rows, seeds, settings, first)
        return self._engine.fill([command.text] * len(rows), states, rows, seeds, settings, first)

    def _result_of(self, ids: Tensor, made: Sequence[StepIds], n_frames: int | None, lap: str) -> GenerationResult:
        verdict, mirrored = self._verdict, self._mirrored
        stretches = stretches_of(self._steps, [len(step.ids) for step in made])
        ends = [stretch.end for stretch in stretches]
        if any(not s.plain for s in stretches) or any(step.rows for step in made):
            begins = [end // FRAMES_PER_TOKEN - len(step.ids) for end, step in zip(ends, made, strict=True)]
            features = features_of(self._weights.tokenizer, ids, list(zip(begins, made, strict=True)))
            if any(not s.plain for s in stretches):
                words = self._words_of_steps[: len(made)]
                kept = with_kept_sizes(features, stretches, words, widens=n_frames is None)
                features, ends = performed(features, kept)
            motion = self._engine.motion_of(features, self._text, self._seed, verdict, n_frames, is_mirrored=mirrored)
        else:
            motion = self._engine.motion(
                ids, self._text, self._seed, verdict, n_frames, is_mirrored=mirrored, people=self._people
            )
        self._timer.lap(lap)
        understood = understood_as(verdict)
        if len(self._steps) > 1 or len(self._steps[0].commands) > 1:
            several = ", then ".join(step.understood for step in self._steps)
            understood = mirror_words(several) if mirrored else several
        timings = dict(self._timer.laps_ms)
        return GenerationResult(motion, understood, verdict.reason, timings, self._scenes(ends), self._read.reading)

    def _scenes(self, ends: Sequence[int]) -> tuple[Scene, ...]:
        """One scene for each step, with the second at which it ends; a transition belongs to the step after it."""
        if len(ends) < len(self._steps):  # a preview has the first step alone
            ends = [*ends, *(ends[-1] + s.n_tokens * FRAMES_PER_TOKEN for s in self._steps[len(ends) :])]
        return tuple(Scene(end / FPS, words) for end, words in zip(ends, self._words_of_steps, strict=True))

    @property
    def _words_of_steps(self) -> list[str]:
        """For each step, words that may name its gestures."""
        return [f"{step.words}\n{step.understood or self._verdict.nearest}" for step in self._steps]
