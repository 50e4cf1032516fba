"""Builds the two parts of the scope score: the index of known and outside commands, and the classifier of texts.

The classifier is trained on sentences of the corpus, their clauses and the known commands against `outside_texts`, and on none
of the prompts that choose its thresholds or measure it (docs/scope.md). This takes about two minutes on one core, most of it for
encoding the texts.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core.corpus.grammar import caption
from mmm_core.corpus.outside import OUTSIDE, outside_texts
from mmm_core.corpus.plain_commands import known_commands
from mmm_core.corpus.synthesis import draw_spec
from mmm_core.corpus.withheld import is_withheld
from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import load_model, load_text_encoder, save_model
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.scope import ScopeClassifier, ScopeIndex, clauses_of
from mmm_core.model.text import TextEncoder
from mmm_core.training.batches import CORPUS, Clip, captions_of_people, load_clips
from mmm_core.training.recipe import Recipe, ScopeRecipe

log = logging.getLogger(__name__)
INDEX_ROWS = 4
"""Known commands of each row of a family that are kept in the index; the classifier is trained on all of them."""
HIDDEN, DROPOUT, WEIGHT_DECAY, LEARNING_RATE, EPOCHS, BATCH = 64, 0.3, 0.3, 3e-3, 15, 256
SEED = 5
OWN_SHARE = 0.1
"""Least share of own captions among the texts in scope; a handful beside thousands would not be learnt."""


def build_scope(encoder: TextEncoder, recipe: ScopeRecipe, own: Sequence[str] = ()) -> ScopeIndex:
    """The scope of a model of the corpus's gestures; equal arguments give equal results.

    Args:
        encoder: text encoder of the model.
        recipe: numbers of texts.
        own: captions of the training data that are also in scope; they become known commands.
    """
    commands = sorted({*known_commands(INDEX_ROWS), *own})
    inside, outside = scope_sentences(recipe)
    if own:
        inside += [*own] * math.ceil(OWN_SHARE * len(inside) / len(own))
    log.info("scope: reading %d texts", len(inside) + len(outside))
    can, cannot = sentence_vectors(inside, encoder), sentence_vectors(outside, encoder)
    vectors = sentence_vectors([*commands, *OUTSIDE], encoder)
    return ScopeIndex([*commands, *OUTSIDE], vectors, len(commands), train_classifier(can, cannot))


def renew_scope(recipe: Recipe, made: Path, out: Path) -> None:
    """Build the scope again for the finished checkpoint at `made` and write the model to `out`; all other weights stay.

    Raises:
        CheckpointError: `made` is missing, or is an imported model, which has no scope.
    """
    model = load_model(made)
    if model.text is not None or model.scope is None:
        raise CheckpointError(made, "scope", "a model without one", "a model of synthesised gestures that reads MiniLM")
    clips = load_clips(made.parent / CORPUS) if recipe.scope.own_captions else []
    model.scope = build_scope(load_text_encoder(), recipe.scope, own_captions(recipe, clips))
    save_model(out, model)


def own_captions(recipe: Recipe, clips: Iterable[Clip]) -> list[str]:
    """Captions of people's clips, each once; none unless the recipe counts them as in scope."""
    return captions_of_people(clips) if recipe.scope.own_captions else []


def scope_sentences(recipe: ScopeRecipe) -> tuple[list[str], list[str]]:
    """Texts in scope, and texts out of scope.

    Texts in scope are sentences of the corpus, clauses of some of them, and at most as many known commands, spread evenly.
    """
    rng = np.random.default_rng(SEED)
    known = sorted(known_commands())
    inside = known[:: -(-len(known) // max(1, recipe.sentences))]
    for _ in range(recipe.sentences):
        spec = draw_spec(rng)
        said = caption(list(spec.gestures), spec.parallel, rng)
        inside += [said, *(clauses_of(said) if rng.random() < 0.3 else [])]
    outside = [*OUTSIDE, *outside_texts(recipe.outside, rng)]
    outside = [t for t in outside if not is_known_phrase(t)]  # "play hide and seek" is a gesture, too
    return [t for t in inside if not is_withheld(t)], [t for t in outside if not is_withheld(t)]


def sentence_vectors(texts: list[str], encoder: TextEncoder, batch: int = 64) -> Tensor:
    """(N, D) unit vectors of texts, encoded in batches of similar length, which need little padding."""
    order = sorted(range(len(texts)), key=lambda i: len(texts[i]))
    read = [encoder.encode([texts[i] for i in order[j : j + batch]]).sentence for j in range(0, len(order), batch)]
    vectors = torch.cat(read)
    return vectors[torch.argsort(torch.tensor(order))].clone()


def train_classifier(can: Tensor, cannot: Tensor) -> ScopeClassifier:
    """A classifier trained on sentence vectors (N, D) of texts in and out of scope, both with the same total weight."""
    x = torch.cat([can, cannot])
    y = torch.cat([torch.ones(len(can)), torch.zeros(len(cannot))])
    weight = torch.where(y > 0, 0.5 * len(y) / len(can), 0.5 * len(y) / len(cannot))
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(SEED)
        classifier = ScopeClassifier(x.shape[1], HIDDEN)
        optimiser = torch.optim.AdamW(classifier.parameters(), lr=LEARNING_RATE, weight_decay=WEIGHT_DECAY)
        for _ in range(EPOCHS):
            for rows in torch.randperm(len(x)).split(BATCH):
                kept = F.dropout(x[rows], DROPOUT)
                loss = F.binary_cross_entropy_with_logits(classifier(kept), y[rows], weight[rows])
                optimiser.zero_grad()
                loss.backward()
                optimiser.step()
    return classifier.eval().requires_grad_(False)
