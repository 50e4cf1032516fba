"""An evaluator together with its word vectors, which maps motions and captions to vectors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.errors import EvaluationError
from mmm_core.evaluation.extractors import Evaluator
from mmm_core.evaluation.pairs import Pair, n_features, to_our_rest_pose
from mmm_core.evaluation.words import WordVectors
from mmm_core.generate.engine import Engine
from mmm_core.model.text import MiniLm

READ_BATCH = 64
Motions = list[NDArray[np.float32]]


class Reader:
    """Maps motions and captions to vectors, with MiniLM's states (our evaluator) or GloVe vectors (the published one)."""

    def __init__(self, evaluator: Evaluator, words: MiniLm | WordVectors) -> None:
        self.evaluator, self.words = evaluator, words
        self._to_ours = False
        has = words.width if isinstance(words, WordVectors) else words.config.width
        if has != evaluator.config.word:
            raise EvaluationError(f"words of width {has}", f"{evaluator.config.word}, as the evaluator was trained on")

    def fit(self, engine: Engine) -> None:
        """Prepare for the motions of a model, which are converted if the evaluator reads another definition of features.

        Raises:
            EvaluationError: the evaluator cannot read the model's features.
        """
        reads, made = self.evaluator.config.n_features, n_features(engine)
        if reads != made:
            raise EvaluationError(f"motions of {made} features", f"{reads}, as the evaluator was trained on")
        theirs, ours = engine.model.rest_pose, self.evaluator.config.rest_pose
        if (theirs, ours) == ("mmmd", "humanml3d"):
            raise EvaluationError("motions with this repository's rest directions and an evaluator that knows HumanML3D's",
                                  "an evaluator of `mmmd train evaluator` on a clips.jsonl folder")  # fmt: skip
        self._to_ours = theirs != ours

    @torch.inference_mode()
    def motions(self, motions: Sequence[NDArray[np.float32]]) -> NDArray[np.float32]:
        """(N, D) vectors of motions."""
        shown = [to_our_rest_pose(m) for m in motions] if self._to_ours else motions
        batches = [shown[i : i + READ_BATCH] for i in range(0, len(shown), READ_BATCH)]
        return torch.cat([self.evaluator.motions([torch.from_numpy(m) for m in some]) for some in batches]).numpy()

    @torch.inference_mode()
    def texts(self, pairs: Sequence[Pair]) -> NDArray[np.float32]:
        """(N, D) vectors of the pairs' captions.

        Raises:
            EvaluationError: the evaluator reads GloVe vectors, and a caption has no tokens.
        """
        parts: list[torch.Tensor] = []
        for i in range(0, len(pairs), READ_BATCH):
            some = pairs[i : i + READ_BATCH]
            if isinstance(self.words, WordVectors):
                parts.append(self.evaluator.texts(*self.words.read([p.words for p in some])))
            else:
                states = self.words.encode([p.text for p in some])
                parts.append(self.evaluator.texts(states.words, None, states.word_mask.sum(1)))
        return torch.cat(parts).numpy()
