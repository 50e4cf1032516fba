"""The training corpus: synthesised gestures, and real motion where a data folder is given."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.progress import track

from mmm_core.corpus.cmu import read_clips
from mmm_core.corpus.synthesis import ClipSpec, synthesise


@dataclass(frozen=True)
class CorpusClip:
    """One clip of the corpus; `spec` is None for real motion."""

    features: NDArray[np.float32]
    captions: list[str]
    is_real: bool
    spec: ClipSpec | None


def make_corpus(n_synthesised: int, data_dir: Path | None, seed: int) -> list[CorpusClip]:
    """`n_synthesised` gesture clips and the real clips of `data_dir`; clip i depends on `seed` and i alone."""
    clips: list[CorpusClip] = []
    for i in track(range(n_synthesised), description="gestures"):
        made = synthesise(np.random.default_rng((seed, i)))
        clips.append(CorpusClip(made.features, made.captions, False, made.spec))
    if data_dir is not None:
        clips += [CorpusClip(features, captions, True, None) for features, captions in read_clips(data_dir)]
    return clips
