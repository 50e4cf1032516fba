"""Arranges steps one after another in one motion: a row of ids for each, and transitions between them (`transitions.py`).

Texts of several commands (`mmm_core.language.reading`) and stories (`mmm_core.generate.story`) use this module.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import torch
from torch import Tensor

from mmm_core.generate.interpretation import ReadCommand
from mmm_core.generate.motion_model import MotionModel
from mmm_core.generate.transitions import TRANSITION_TOKENS, transitions
from mmm_core.language.manner import LONGEST_HOLD_S, Manner
from mmm_core.language.moods import MOODS
from mmm_core.model.text import TextStates
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS, tokens_for_frames
from mmm_core.motion.performing import Stretch

FEWEST_TOKENS = 4
"""Tokens of a command among several at least, however short the requested motion is."""
COMMAND_STRIDE = 15_485_863
"""Distance between the seeds of a text's steps."""
TOGETHER_STRIDE = 1_299_709
"""Distance between the seeds of commands that are done at the same time."""


@dataclass(frozen=True)
class Step:
    """Commands of a text that are done at the same time.

    Attributes:
        commands: one or more.
        n_tokens: length of the step's motion.
        own_tokens: length of each command's own motion; empty where all have `n_tokens`.
    """

    commands: tuple[ReadCommand, ...]
    n_tokens: int
    own_tokens: tuple[int, ...] = ()

    def tokens_of(self, k: int) -> int:
        """Length of the k-th command's own motion. A pose lasts as long as the step, a gesture no longer than it would alone."""
        is_whole = len(self.commands) == 1 or not self.own_tokens or self.commands[k].is_pose
        return self.n_tokens if is_whole else min(self.n_tokens, self.own_tokens[k])

    @property
    def manner(self) -> Manner:
        """The manner of the step: the strongest tempo, size and hold among its commands, and their first mood."""
        manners = [c.manner for c in self.commands]
        return Manner(
            max((m.tempo for m in manners), key=lambda f: abs(f - 1)),
            max((m.size for m in manners), key=lambda f: abs(f - 1)),
            min(LONGEST_HOLD_S, max(m.hold_s for m in manners)),
            next((m.mood for m in manners if m.mood), ""),
        )

    @property
    def words(self) -> str:
        """The words of the step's commands."""
        return " and ".join(c.text for c in self.commands)

    @property
    def understood(self) -> str:
        """The nearest known commands and their scores; empty for a text of one command."""
        return " and ".join(c.understood for c in self.commands if c.understood)

    @property
    def states(self) -> TextStates:
        """Encoder states of the step's first command."""
        return self.commands[0].states


def steps_of(engine: MotionModel, steps: Sequence[tuple[ReadCommand, ...]], n_frames: int | None) -> list[Step]:
    """The steps of a text with their lengths.

    Args:
        engine: predicts the lengths.
        steps: commands of the text, those of a step done at the same time.
        n_frames: length of the whole motion, shared in proportion to the steps' own lengths. None lets the model choose: each
            step of the shipped model is as long as it would be alone, those of others share the longest motion they learnt.

    Raises:
        GenerationError: `n_frames` is None and the model has no length predictor.
    """
    if len(steps) == 1 and len(steps[0]) == 1:
        command = steps[0][0]
        own = engine.predicted_frames(command.states) if n_frames is None else _before_tempo(n_frames, command.manner)
        return [Step(steps[0], tokens_for_frames(own))]
    own = [tuple(tokens_for_frames(engine.predicted_frames(c.states)) for c in step) for step in steps]
    lengths = [max(several) for several in own]
    if n_frames is not None or not engine.model.is_ours:
        whole = MAX_TOKENS if n_frames is None else tokens_for_frames(n_frames)
        most = max(1, (whole + TRANSITION_TOKENS) // (FEWEST_TOKENS + TRANSITION_TOKENS))
        lengths = lengths[:most]  # there is no room for further steps
        room = whole - TRANSITION_TOKENS * (len(lengths) - 1)
        if len(lengths) == 1 and n_frames is not None:
            lengths = [room]
        elif n_frames is not None or sum(lengths) > room:
            lengths = shared_out(room, lengths)
    return [Step(step, n, several) for step, n, several in zip(steps, lengths, own, strict=False)]


def stretches_of(steps: Sequence[Step], n_tokens: Sequence[int]) -> list[Stretch]:
    """The frames and the manner of each step, given the lengths of the steps' rows.

    A transition has the manner of the step after it.
    """
    found: list[Stretch] = []
    for i, (n, step) in enumerate(zip(n_tokens, steps, strict=False)):
        start = found[-1].end if found else 0
        end = start + (n + (TRANSITION_TOKENS if i else 0)) * FRAMES_PER_TOKEN
        manner, mood = step.manner, MOODS.get(step.manner.mood)
        lean_rad = (mood.trunk_pitch_rad, mood.head_pitch_rad) if mood else (0.0, 0.0)
        found.append(Stretch(start, end, manner.tempo, manner.size, manner.hold_s, *lean_rad))
    return found


def _before_tempo(n_frames: int, manner: Manner) -> int:
    """Frames to generate for a motion that has `n_frames` once its tempo is applied."""
    return max(FRAMES_PER_TOKEN, min(MAX_TOKENS * FRAMES_PER_TOKEN, round(n_frames * manner.tempo)))


def shared_out(room: int, wanted: Sequence[int]) -> list[int]:
    """Shares of `room` tokens in proportion to `wanted`, each at least `FEWEST_TOKENS`; their sum is `room`."""
    spare = room - FEWEST_TOKENS * len(wanted)
    ends = [round(spare * sum(wanted[: i + 1]) / sum(wanted)) for i in range(len(wanted))]
    return [FEWEST_TOKENS + end - start for start, end in pairwise([0, *ends])]


def joined(engine: MotionModel, steps: Sequence[Step], rows: Sequence[Tensor], seed: int) -> Tensor:
    """(L, C) ids of the steps' rows and the transitions between them."""
    between = transitions(engine, rows, [s.states for s in steps], seed)
    ids = rows[0]
    for hole, row in zip(between, rows[1:], strict=True):
        ids = torch.cat([ids, hole, row])
    return ids
