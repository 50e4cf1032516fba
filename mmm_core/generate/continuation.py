"""Prefix conditioning: generates a motion that continues another one, with the last ids of that one as context.

MMM (arXiv 2312.03596) sec. 3.3: all ids but the committed ones are [MASK]. The committed motion is given as frames of any
origin, and the tokenizer encodes them. A longer prefix continues the old motion more smoothly and shows less of the text
(measured in docs/daemon.md): the model was not trained to begin in the middle of another motion.
"""

from __future__ import annotations

import torch
from torch import Tensor

from mmm_core.errors import GenerationError
from mmm_core.generate.at_once import StepIds, composed, features_of
from mmm_core.generate.editing import TOKEN_S
from mmm_core.generate.engine import Engine
from mmm_core.generate.interpretation import interpret
from mmm_core.generate.motion_model import check_seed
from mmm_core.generate.result import GenerationResult, StageTimer, no_motion, understood_as
from mmm_core.generate.sequence import COMMAND_STRIDE, TOGETHER_STRIDE, Step, joined, steps_of, stretches_of
from mmm_core.model.sampling import empty_row
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS, frames_for_seconds
from mmm_core.motion.motion import FPS, Motion
from mmm_core.motion.performing import performed

LONGEST_PREFIX_TOKENS = 8
"""Tokens of the longest prefix, 1.6 s: our choice; from four tokens on the motion follows its text less (docs/daemon.md)."""


def continue_motion(
    engine: Engine, before: Motion, prefix_s: float, text: str, *, seed: int = 0, seconds: float | None = None
) -> GenerationResult:
    """The motion for `text` that continues `before`. Its first frame follows the last one of `before`, which it does not contain.

    Args:
        engine: the model.
        before: the committed motion. All of it is encoded, so frames before the prefix make the prefix's ids more accurate.
        prefix_s: seconds at the end of `before` that serve as context, 0.2 to 1.6 in steps of 0.2, shortened where the
            first command leaves less room.
        text: a command in English, never mirrored: `before` decides on left and right.
        seed: any integer from 0 to 2^31 - 1.
        seconds: length of the new motion, at most 9.8; None lets the model choose.

    Raises:
        GenerationError: seed, seconds or prefix out of range, `before` shorter than the prefix, or as `Engine.ids_of`.
    """
    check_seed(seed)
    n_frames = None if seconds is None else frames_for_seconds(seconds, FPS)
    ids_before = engine.ids_of(before)
    n_prefix = round(prefix_s / TOKEN_S)
    if not 1 <= n_prefix <= min(len(ids_before), LONGEST_PREFIX_TOKENS):
        asked = f"a prefix of {prefix_s:g} s of a motion of {len(ids_before) * TOKEN_S:.1f} s"
        longest_s = LONGEST_PREFIX_TOKENS * TOKEN_S
        raise GenerationError(asked, f"{TOKEN_S:g} to {longest_s:g} s, and no more than there is")
    timer = StageTimer()
    with torch.inference_mode():
        read = interpret(engine, text, fresh=False)
    verdict, text = read.verdict, read.reading.text
    timer.lap("text")
    if verdict.status == "rejected":
        nothing = no_motion(text, seed, verdict)
        return GenerationResult(nothing, understood_as(verdict), verdict.reason, timer.laps_ms, read=read.reading)
    with torch.inference_mode():
        steps = steps_of(engine, read.steps, n_frames)
        prefix = ids_before[len(ids_before) - min(n_prefix, MAX_TOKENS - steps[0].n_tokens) :]
        made = [
            _step_ids(engine, ids_before[:0] if i else prefix, step, (seed + i * COMMAND_STRIDE) % 2**31)
            for i, step in enumerate(steps)
        ]
        ids = joined(engine, steps, [step.ids for step in made], seed)
        timer.lap("decode")
        n_before, stretches = len(ids_before), stretches_of(steps, [len(step.ids) for step in made])
        begins = [n_before + s.end // FRAMES_PER_TOKEN - len(m.ids) for s, m in zip(stretches, made, strict=True)]
        whole = features_of(engine.model.tokenizer, torch.cat([ids_before, ids]), list(zip(begins, made, strict=True)))
        features = whole[n_before * FRAMES_PER_TOKEN :]
        if any(not s.plain for s in stretches):
            features = performed(features, stretches)[0]
        if any(not s.plain for s in stretches) or any(step.rows for step in made):
            motion = engine.motion_of(features, text, seed, verdict, n_frames)
        else:
            motion = engine.motion_of_features(features[:n_frames], ids, text, seed, verdict)
        timer.lap("motion")
    one = len(steps) == 1 and len(steps[0].commands) == 1
    several = understood_as(verdict) if one else ", then ".join(s.understood for s in steps)
    return GenerationResult(motion, several, verdict.reason, timer.laps_ms, read=read.reading)


def _step_ids(engine: Engine, prefix: Tensor, step: Step, seed: int) -> StepIds:
    """The ids of a step, generated after the ids of the prefix."""
    rows: list[Tensor] = []
    for k, command in enumerate(step.commands):
        row = torch.cat([prefix, empty_row(engine.model.transformer, step.tokens_of(k))])
        one = engine.fill([command.text], command.states, [row], [(seed + k * TOGETHER_STRIDE) % 2**31])[0]
        rows.append(one[len(prefix) :])
    return composed(engine, step.commands, rows)
