"""The generation of one motion: a preview of it after one decoding step, then the motion.

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

from mmm_core.generate.motion_model import MotionModel
from mmm_core.generate.repetition_editing import ids_of_count
from mmm_core.generate.result import GenerationResult, StageTimer, no_motion, understood_as
from mmm_core.generate.sequence import COMMAND_STRIDE, TRANSITION_TOKENS, Command, commands_of, joined
from mmm_core.language.count_words import count_asked
from mmm_core.language.mirroring import mirror_words
from mmm_core.model.sampling import SamplingSettings, empty_row, fill, pseudo_log_likelihood
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.motion import FPS
from mmm_core.recognition.seen import Scene

OPENING_TOKENS = 2
"""Tokens that the preview and the motion share: 0.4 s, longer than generating and retargeting the motion usually takes.
Their cost in probes: docs/model.md."""
CANDIDATES_TO_COUNT = 2
"""Candidates for a text that names a number. More take longer and are within one of it no more often (docs/model.md)."""
CANDIDATE_STRIDE = 7_919_999
"""Distance between the seeds of candidates, so that neighbouring seeds share none."""


class MotionGeneration:
    """One motion to generate; `Engine.begin` makes it.

    Attributes:
        n_frames: length of the motion as far as it is known: a motion whose strokes are counted may become longer or
            shorter.
    """

    def __init__(self, engine: MotionModel, text: str, seed: int, n_frames: int | None, candidates: int | None) -> None:
        """Read the text; arguments as in `Engine.generate`, checked."""
        self._engine, self._text, self._seed, self._asked_frames = engine, text, seed, n_frames
        self._timer = StageTimer()
        states, self._verdict, self._mirrored = engine.understand_fresh(text)
        self._candidates, self._count = candidates or 1, None
        self._commands: list[Command] = []
        if self._verdict.status != "rejected":
            done = self._verdict.kept or text
            with torch.inference_mode():
                read = mirror_words(done) if self._mirrored else done
                self._commands = commands_of(engine, read, states, n_frames)
            if candidates != 1 and len(self._commands) == 1 and n_frames is None and engine.model.is_ours:
                self._count = count_asked(done)
                self._candidates = candidates or (1 if self._count is None else CANDIDATES_TO_COUNT)
        n_tokens = sum(c.n_tokens for c in self._commands) + TRANSITION_TOKENS * max(0, len(self._commands) - 1)
        self.n_frames = n_tokens * FRAMES_PER_TOKEN if n_frames is None else n_frames
        self._timer.lap("text")

    @property
    def settings(self) -> SamplingSettings:
        """Sampling settings of the engine, with an opening where the model can have one."""
        settings = self._engine.settings
        has_opening = self._engine.model.is_ours and not settings.official
        return replace(settings, opening=OPENING_TOKENS) if has_opening else settings

    def preview(self) -> GenerationResult | None:
        """The first command's motion after a single decoding step; None where there is no motion or no opening.

        Its first 0.4 s are those of the motion, but for the last frames, which later tokens still change.
        """
        if not self.settings.opening or not self._commands:
            return None
        with torch.inference_mode():
            ids = self._preview_ids
            self._timer.lap("draft")
            n_frames = self._asked_frames if len(self._commands) == 1 else None
            return self._result_of(ids, n_frames, "draft motion")

    def result(self) -> GenerationResult:
        """The motion, or an empty one and the reason where the text is rejected."""
        if not self._commands:
            nothing = no_motion(self._text, self._seed, self._verdict)
            return GenerationResult(nothing, understood_as(self._verdict), self._verdict.reason, self._timer.laps_ms)
        with torch.inference_mode():
            rows = [self._row(i, command) for i, command in enumerate(self._commands)]
            ids = joined(self._engine, self._commands, rows, self._seed)
            self._timer.lap("decode")
            return self._result_of(ids, self._asked_frames, "motion")

    @cached_property
    def _preview_ids(self) -> Tensor:
        """(n_tokens, C) ids of the first command after one step."""
        command, one_step = self._commands[0], replace(self.settings, steps=1)
        row = empty_row(self._engine.model.transformer, command.n_tokens)
        return self._fill(command, [row], [self._seed], one_step)[0]

    def _row(self, i: int, command: Command) -> Tensor:
        """(L, C) ids of a command: the candidate nearest to the count that the text names, else the likeliest one."""
        n, settings = self._candidates, self.settings
        seeds = [(self._seed + i * COMMAND_STRIDE) % 2**31 + k * CANDIDATE_STRIDE for k in range(n)]
        row = empty_row(self._engine.model.transformer, command.n_tokens)
        if n > 1 and i == 0 and settings.opening:  # all candidates begin as the preview does
            row[: settings.opening] = self._preview_ids[: settings.opening]
        candidates = self._fill(command, [row] * n, seeds, settings)
        if self._count is not None:
            return ids_of_count(self._engine, command, candidates, self._count, self._seed)
        return candidates[0] if n == 1 else self._likeliest(command, candidates)

    def _likeliest(self, command: Command, candidates: Sequence[Tensor]) -> Tensor:
        states = command.states.repeated(len(candidates))
        likely = pseudo_log_likelihood(self._engine.model.transformer, states, candidates)
        return candidates[int(likely.argmax())]

    def _fill(
        self, command: Command, rows: Sequence[Tensor], seeds: Sequence[int], settings: SamplingSettings
    ) -> list[Tensor]:
        states = command.states if len(rows) == 1 else command.states.repeated(len(rows))
        return fill(self._engine.model.transformer, states, rows, seeds, settings)

    def _result_of(self, ids: Tensor, n_frames: int | None, lap: str) -> GenerationResult:
        verdict, mirrored = self._verdict, self._mirrored
        motion = self._engine.motion(ids, self._text, self._seed, verdict, n_frames, is_mirrored=mirrored)
        self._timer.lap(lap)
        understood = understood_as(verdict)
        if len(self._commands) > 1:
            several = ", then ".join(c.understood for c in self._commands)
            understood = mirror_words(several) if mirrored else several
        return GenerationResult(motion, understood, verdict.reason, dict(self._timer.laps_ms), self._scenes())

    def _scenes(self) -> tuple[Scene, ...]:
        """Where each command ends, were it made in full; a transition belongs to the command that it leads to."""
        found: list[Scene] = []
        n_tokens = 0
        for command in self._commands:
            n_tokens += command.n_tokens + (TRANSITION_TOKENS if found else 0)
            words = f"{command.text}\n{command.understood or self._verdict.nearest}"
            found.append(Scene(n_tokens * FRAMES_PER_TOKEN / FPS, words))
        return tuple(found)
