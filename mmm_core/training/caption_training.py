"""Trains what tells captions of people from the corpus's own sentences about a person, by their sentence vectors.

Both kinds have the same form ("a person ..."), so that the form alone would send many of the corpus's sentences to the weights
for people.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.corpus.grammar import caption
from mmm_core.corpus.synthesis import draw_spec
from mmm_core.corpus.withheld import is_withheld
from mmm_core.errors import TrainingDataError
from mmm_core.inference.checkpoint import Model
from mmm_core.language.known_phrases import SUBJECT_BEFORE_VERB
from mmm_core.model.text import TextEncoder
from mmm_core.training.batches import Clip, captions_of_people
from mmm_core.training.recipe import Recipe
from mmm_core.training.scope_training import sentence_vectors

N_SENTENCES = 6000
"""Sentences of the corpus."""
SQUARES_WEIGHT = 1e-5
"""Weight of the squared weights in the loss."""
STEPS = 300
"""Most steps of L-BFGS."""
SEED = 77


def train_captions(captions: list[str], encoder: TextEncoder) -> nn.Linear:
    """A logistic regression on unit sentence vectors (D,): log-odds that a sentence is a caption of people.

    Args:
        captions: captions of people's clips.
        encoder: text encoder of the model.
    """
    theirs, ours = (sentence_vectors(texts, encoder) for texts in (captions, corpus_sentences(N_SENTENCES)))
    return _regression(theirs, ours)


def check_changes(recipe: Recipe, start: Model | None, clips: Sequence[Clip], folder: Path) -> None:
    """Raises TrainingDataError if a recipe with a rank has nothing to change, or no clip of a person, in the run of `folder`."""
    if recipe.tokenizer.rank and not recipe.transformer.rank:
        allowed = "0, or transformer.rank above 0 as well: only such a transformer learns the changed ids"
        raise TrainingDataError(folder, "tokenizer.rank", f"{recipe.tokenizer.rank} without transformer.rank", allowed)
    if recipe.tokenizer.rank and recipe.tokenizer.layout != "parts":
        raise TrainingDataError(
            folder,
            "tokenizer.rank",
            f"{recipe.tokenizer.rank} with layout '{recipe.tokenizer.layout}'",
            "layout 'parts'",
        )
    if start is None:
        raise TrainingDataError(folder, "transformer.rank", "no start", "0, or a start whose weights are changed")
    if not captions_of_people(clips):
        raise TrainingDataError(folder, "transformer.rank", "no clip of a person", "0, or --data with some")


def corpus_sentences(n: int, seed: int = SEED) -> list[str]:
    """Sentences of the gesture corpus whose subject is a person."""
    rng, found = np.random.default_rng(seed), list[str]()
    while len(found) < n:
        spec = draw_spec(rng)
        said = caption(list(spec.gestures), spec.parallel, rng)
        found += [said] if SUBJECT_BEFORE_VERB.match(said.lower()) and not is_withheld(said) else []
    return found


def _regression(ones: Tensor, zeros: Tensor) -> nn.Linear:
    """Log-odds that a vector (D,) is like the rows of `ones` (N, D), not of `zeros`, which have the same total weight."""
    x = torch.cat([ones, zeros])
    y = torch.cat([torch.ones(len(ones), 1), torch.zeros(len(zeros), 1)])
    weight = torch.where(y > 0, 0.5 / len(ones), 0.5 / len(zeros))
    line = nn.Linear(x.shape[1], 1)
    for parameter in line.parameters():
        nn.init.zeros_(parameter)
    optimiser = torch.optim.LBFGS(line.parameters(), max_iter=STEPS, line_search_fn="strong_wolfe")

    def loss() -> Tensor:
        optimiser.zero_grad()
        entropy = F.binary_cross_entropy_with_logits(line(x), y, weight, reduction="sum")
        value = entropy + SQUARES_WEIGHT * line.weight.square().sum()
        value.backward()
        return value

    optimiser.step(loss)
    return line.eval().requires_grad_(False)
