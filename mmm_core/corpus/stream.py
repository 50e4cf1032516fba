"""Makes the training corpus: synthesised gestures, and real motion from a data folder."""

from __future__ import annotations

from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.progress import track

from mmm_core.corpus.cmu import read_clips
from mmm_core.corpus.synthesis import ClipSpec, synthesise

_WORTH_A_PROCESS = 500
"""Clips for each process from which on several processes are started; fewer are made before a process has started."""


@dataclass(frozen=True)
class CorpusClip:
    """One clip of the corpus; `spec` is None for real motion."""

    features: NDArray[np.float32]
    captions: list[str]
    is_real: bool
    spec: ClipSpec | None


def make_corpus(n_synthesised: int, data_dir: Path | None, seed: int, processes: int = 1) -> list[CorpusClip]:
    """`n_synthesised` gesture clips and the real clips of `data_dir`; clip i depends on nothing but `seed` and i.

    Args:
        n_synthesised: number of gesture clips.
        data_dir: folder of real motion; None for gestures alone.
        seed: seed of the gestures.
        processes: number of processes that make gestures; it does not change the clips.
    """
    jobs = ((seed, i) for i in range(n_synthesised))
    shown = {"description": "gestures", "total": n_synthesised}
    if processes > 1 and n_synthesised > _WORTH_A_PROCESS * processes:
        with get_context("spawn").Pool(processes) as pool:
            clips = list(track(pool.imap(_made, jobs, chunksize=100), **shown))
    else:
        clips = list(track(map(_made, jobs), **shown))
    if data_dir is not None:
        clips += [CorpusClip(features, captions, True, None) for features, captions in read_clips(data_dir)]
    return clips


def _made(job: tuple[int, int]) -> CorpusClip:
    made = synthesise(np.random.default_rng(job))
    return CorpusClip(made.features, made.captions, False, made.spec)
