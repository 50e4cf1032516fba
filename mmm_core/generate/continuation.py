"""A motion for a text that goes on from what is there: its last ids are the context of the new ones.

MMM (arXiv 2312.03596) sec. 3.3: everything but the committed ids is [MASK]. What is committed is given as frames, whatever
made them, and read by the tokenizer. The longer the prefix, the more the motion goes on from there, and the less it shows of
the text (measured in docs/daemon.md): the model was not trained to begin in the middle of another motion.
"""

from __future__ import annotations

import torch
from torch import Tensor

from mmm_core.errors import GenerationError
from mmm_core.generate.editing import TOKEN_S
from mmm_core.generate.engine import Engine, check_seed
from mmm_core.generate.result import Clock, Generation, no_motion, understood
from mmm_core.generate.sequence import COMMAND_STRIDE, Command, commands_of, joined
from mmm_core.model.sampling import empty_row, fill
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS, frames_for_seconds
from mmm_core.motion.motion import FPS, Motion

LONGEST_PREFIX_TOKENS = 8
"""Ours; from four on the motion shows less of what the text asks for (docs/daemon.md)."""


def go_on(
    engine: Engine, before: Motion, prefix_s: float, text: str, *, seed: int = 0, seconds: float | None = None
) -> Generation:
    """The motion for `text` that follows `before`; its own frames alone, the first of them next after the last of `before`.

    Args:
        engine: the model.
        before: what is committed; read as a whole, so that more of it than the prefix makes the prefix's ids truer.
        prefix_s: so much of its end is context, 0.2 to 1.6 s in steps of 0.2, as far as there is room beside the first
            command.
        text: a command in English, which is read as it is: what is there decides what is left and right.
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
    clock = Clock()
    states, verdict = engine.understand(text)
    clock.lap("text")
    if verdict.status == "rejected":
        return Generation(no_motion(text, seed, verdict), understood(verdict), verdict.reason, clock.laps_ms)
    with torch.inference_mode():
        commands = commands_of(engine, verdict.kept or text, states, n_frames)
        prefix = ids_before[len(ids_before) - min(n_prefix, MAX_TOKENS - commands[0].n_tokens) :]
        rows = [
            _row(engine, ids_before[:0] if i else prefix, c, (seed + i * COMMAND_STRIDE) % 2**31)
            for i, c in enumerate(commands)
        ]
        ids = joined(engine, commands, rows, seed)
        clock.lap("decode")
        whole = engine.model.tokenizer.decode(torch.cat([ids_before, ids])[None])[0]
        features = whole[len(ids_before) * FRAMES_PER_TOKEN :][:n_frames].numpy()
        motion = engine.motion_of_features(features, ids, text, seed, verdict)
        clock.lap("motion")
    several = ", then ".join(c.understood for c in commands) if len(commands) > 1 else understood(verdict)
    return Generation(motion, several, verdict.reason, clock.laps_ms)


def _row(engine: Engine, prefix: Tensor, command: Command, seed: int) -> Tensor:
    """(n_tokens, C) ids of a command that follow those of the prefix."""
    transformer = engine.model.transformer
    row = torch.cat([prefix, empty_row(transformer, command.n_tokens)])
    return fill(transformer, command.states, [row], [seed], engine.settings)[0][len(prefix) :]
