"""A motion that is being made: a draft of it after one decoding step, then itself.

MMM (arXiv 2312.03596) sec. 3.3 predicts all tokens in every step, so that after the first there is a whole motion already. Its
beginning stays: the first tokens are not masked again (`DecodeSettings.opening`). So a robot may set out on the draft and go
over to the motion, whose later tokens are decoded with those played as context. Whether or not there was a draft, the motion
is the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import torch
from torch import Tensor

from mmm_core.generate.repetition_editing import ids_of_count
from mmm_core.generate.result import Clock, Generation, no_motion, understood
from mmm_core.generate.sequence import COMMAND_STRIDE, TRANSITION_TOKENS, Command, commands_of, joined
from mmm_core.language.count_words import count_asked
from mmm_core.language.mirroring import mirror_words
from mmm_core.model.sampling import SamplingSettings, empty_row, fill, pseudo_log_likelihood
from mmm_core.model.tokens import FRAMES_PER_TOKEN

if TYPE_CHECKING:
    from mmm_core.generate.engine import Engine

OPENING_TOKENS = 2
"""0.4 s: longer than a motion usually takes to be made and gone over to; what it does to the probes: docs/model.md."""
CANDIDATES_TO_COUNT = 2
"""More take longer and keep a number within one no more often (docs/model.md)."""
CANDIDATE_STRIDE = 7_919_999
"""Between the seeds of candidates, so that neighbouring seeds do not share any."""


class Making:
    """One motion on its way; `Engine.begin` gives it.

    Attributes:
        n_frames: of the motion, as far as is known: one whose strokes are counted may come out longer or shorter.
    """

    def __init__(self, engine: Engine, text: str, seed: int, n_frames: int | None, candidates: int | None) -> None:
        """Read the text; arguments as in `Engine.generate`, checked."""
        self._engine, self._text, self._seed, self._asked_frames = engine, text, seed, n_frames
        self._clock = Clock()
        states, self._verdict, self._mirrored = engine.understand_fresh(text)
        self._ours = engine.model.rest_pose == "mmmd"
        self._candidates, self._count = candidates or 1, None
        self._commands: list[Command] = []
        if self._verdict.status != "rejected":
            done = self._verdict.kept or text
            with torch.inference_mode():
                read = mirror_words(done) if self._mirrored else done
                self._commands = commands_of(engine, read, states, n_frames)
            if candidates != 1 and len(self._commands) == 1 and n_frames is None and self._ours:
                self._count = count_asked(done)
                self._candidates = candidates or (1 if self._count is None else CANDIDATES_TO_COUNT)
        n_tokens = sum(c.n_tokens for c in self._commands) + TRANSITION_TOKENS * max(0, len(self._commands) - 1)
        self.n_frames = n_tokens * FRAMES_PER_TOKEN if n_frames is None else n_frames
        self._clock.lap("text")

    @property
    def settings(self) -> SamplingSettings:
        """How the model is asked."""
        settings = self._engine.settings
        return replace(settings, opening=OPENING_TOKENS) if self._ours and not settings.official else settings

    def draft(self) -> Generation | None:
        """What can be played at once: the first command after a single step; None where there is no motion or no opening.

        Its first 0.4 s are those of the motion, but for what the tokens after them change in their last frames.
        """
        if not self.settings.opening or not self._commands:
            return None
        with torch.inference_mode():
            ids = self._draft_ids
            self._clock.lap("draft")
            n_frames = self._asked_frames if len(self._commands) == 1 else None
            return self._generation(ids, n_frames, "draft motion")

    def finished(self) -> Generation:
        """The motion."""
        if not self._commands:
            nothing = no_motion(self._text, self._seed, self._verdict)
            return Generation(nothing, understood(self._verdict), self._verdict.reason, self._clock.laps_ms)
        with torch.inference_mode():
            rows = [self._row(i, command) for i, command in enumerate(self._commands)]
            ids = joined(self._engine, self._commands, rows, self._seed)
            self._clock.lap("decode")
            return self._generation(ids, self._asked_frames, "motion")

    @cached_property
    def _draft_ids(self) -> Tensor:
        """(n_tokens, C) ids of the first command after one step."""
        command, one_step = self._commands[0], replace(self.settings, steps=1)
        return self._fill(
            command, [empty_row(self._engine.model.transformer, command.n_tokens)], [self._seed], one_step
        )[0]

    def _row(self, i: int, command: Command) -> Tensor:
        """(L, C) ids of a command, the nearest to the number asked for or the likeliest of its candidates."""
        n, settings = self._candidates, self.settings
        seeds = [(self._seed + i * COMMAND_STRIDE) % 2**31 + k * CANDIDATE_STRIDE for k in range(n)]
        row = empty_row(self._engine.model.transformer, command.n_tokens)
        if n > 1 and i == 0 and settings.opening:  # all candidates begin as the draft does
            row[: settings.opening] = self._draft_ids[: settings.opening]
        made = self._fill(command, [row] * n, seeds, settings)
        if self._count is not None:
            return ids_of_count(self._engine, command, made, self._count, self._seed)
        return made[0] if n == 1 else self._likeliest(command, made)

    def _likeliest(self, command: Command, made: Sequence[Tensor]) -> Tensor:
        states = command.states.repeated(len(made))
        likely = pseudo_log_likelihood(self._engine.model.transformer, states, made)
        return made[int(likely.argmax())]

    def _fill(
        self, command: Command, rows: Sequence[Tensor], seeds: Sequence[int], settings: SamplingSettings
    ) -> list[Tensor]:
        states = command.states if len(rows) == 1 else command.states.repeated(len(rows))
        return fill(self._engine.model.transformer, states, rows, seeds, settings)

    def _generation(self, ids: Tensor, n_frames: int | None, lap: str) -> Generation:
        verdict, mirrored = self._verdict, self._mirrored
        motion = self._engine.motion(ids, self._text, self._seed, verdict, n_frames, is_mirrored=mirrored)
        self._clock.lap(lap)
        taken_as = understood(verdict)
        if len(self._commands) > 1:
            several = ", then ".join(c.understood for c in self._commands)
            taken_as = mirror_words(several) if mirrored else several
        return Generation(motion, taken_as, verdict.reason, dict(self._clock.laps_ms))
