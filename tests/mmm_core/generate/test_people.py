"""Captions of people are filled with the weights for them, and nothing else is."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from mmm_core.corpus.heldout import PROBES
from mmm_core.generate.engine import Engine
from mmm_core.generate.interpretation import interpret_all
from mmm_core.generate.story import Scene, generate_story
from mmm_core.training.caption_training import corpus_sentences

CAPTION = "a person acts like a monkey"
GESTURES = ("wave with your right hand", "a person claps three times", "nod twice, then bow")


@pytest.fixture(name="without", scope="module")
def _without(engine: Engine) -> Engine:
    """The shipped model without weights for captions of people."""
    return Engine(
        engine.model, engine.encoder, engine.checkpoint_hash, engine.settings, engine.precision, engine.reader
    )


@pytest.mark.parametrize("text", GESTURES)
def test_gestures_keep_the_checkpoints_own_weights(engine: Engine, without: Engine, text: str) -> None:
    made, wanted = (e.generate(text, seed=3).motion for e in (engine, without))
    np.testing.assert_array_equal(made.tokens, wanted.tokens)


def test_a_caption_has_weights_of_its_own(engine: Engine, without: Engine) -> None:
    made, other = (e.generate(CAPTION, seed=3, seconds=4).motion for e in (engine, without))
    assert made.status != "rejected" and len(made.joints_m) == len(other.joints_m) == 80
    assert not np.array_equal(made.tokens, other.tokens)
    again = engine.generate(CAPTION, seed=3, seconds=4).motion
    np.testing.assert_array_equal(made.tokens, again.tokens)


def test_a_mirrored_caption_gives_the_mirrored_motion(engine: Engine) -> None:
    texts = (f"{CAPTION} with the {side} hand while turning {side}" for side in ("right", "left"))
    a, b = (engine.generate(text, seed=5, seconds=3).motion.joints_m for text in texts)
    lateral = np.array([-1.0, 1.0, 1.0])
    np.testing.assert_allclose(a[:, 0], b[:, 0] * lateral, atol=1e-4)
    np.testing.assert_allclose(a[:, 20], b[:, 21] * lateral, atol=1e-4)


def test_the_preview_of_a_caption_begins_as_its_motion_does(engine: Engine) -> None:
    """Later tokens reach the last frames of the opening: a decoded frame depends on six tokens to either side."""
    generation = engine.begin(CAPTION, seed=4, seconds=4)
    preview = generation.preview()
    assert preview is not None
    begun, whole = (one.motion.joints_m[:4] for one in (preview, generation.result()))
    np.testing.assert_allclose(begun - begun[:, :1], whole - whole[:, :1], atol=0.1)


def test_a_caption_beside_others_has_ids_of_the_models_own_tokenizer(engine: Engine) -> None:
    states, mask = engine.read([CAPTION]), engine.model.transformer.ids.mask
    row = torch.full((20, engine.model.tokenizer.n_codebooks), mask)
    ids = engine.fill([CAPTION], states, [row], [4])[0]
    made = engine.filled_features([CAPTION], states, [row], [4])[0]
    encoded = engine.model.tokenizer.encode(torch.from_numpy(made)[None])[0]
    assert torch.equal(ids, encoded) and engine.people is not None
    assert not np.allclose(engine.people.tokenizer.decode(ids[None])[0].numpy(), made, atol=0.1)


def test_a_row_that_holds_ids_keeps_them(engine: Engine, without: Engine) -> None:
    """The ids are those of the model's own tokenizer, so the model's own weights fill the rest of the row."""
    states = engine.read([CAPTION])
    row = torch.full((20, engine.model.tokenizer.n_codebooks), engine.model.transformer.ids.mask)
    row[:5] = engine.fill(["wave"], engine.read(["wave"]), [row], [1])[0][:5]
    filled, wanted = (one.fill([CAPTION], states, [row], [2])[0] for one in (engine, without))
    assert torch.equal(filled, wanted) and torch.equal(filled[:5], row[:5])


def test_a_caption_among_gestures_gets_what_it_gets_alone() -> None:
    """In fp32: eight-bit kernels round by the batch's shape."""
    engine = Engine.load(threads=None, precision="fp32")
    words = ["wave with your right hand", CAPTION, "bow"]
    states, mask = engine.read(words), engine.model.transformer.ids.mask
    rows = [torch.full((n, engine.model.tokenizer.n_codebooks), mask) for n in (9, 20, 12)]
    together = engine.fill(words, states, rows, [1, 2, 3])
    for i, row in enumerate(rows):
        assert torch.equal(engine.fill(words[i : i + 1], states.row(i), [row], [i + 1])[0], together[i]), words[i]


def test_a_story_has_captions_and_gestures(engine: Engine) -> None:
    pieces = list(generate_story(engine, [Scene("wave", 2.0), Scene(CAPTION, 3.0), Scene("bow", 2.0)], seed=2))
    assert sum(len(p.joints_m) for p in pieces) == 20 * 7 + 2 * 2 * 4
    assert all(np.isfinite(p.joints_m).all() for p in pieces)


def test_candidates_of_a_caption_are_judged(engine: Engine) -> None:
    best = engine.generate(CAPTION, seed=5, seconds=2, candidates=3).motion
    assert len(best.joints_m) == 40


def test_few_sentences_of_the_corpus_and_no_probe_are_taken_for_captions(engine: Engine) -> None:
    """Two of a hundred third-person sentences may be taken; of 3,000 fresh ones 23 were (docs/model.md)."""
    texts = [*(p.text for p in PROBES[::4]), *corpus_sentences(100, seed=41)]
    commands = [c for one in interpret_all(engine, texts) for step in one.steps for c in step]
    assert len(commands) > 150
    taken = [c.text for c in commands if engine.weights_for(c.text, c.states.sentence[0]) is not None]
    assert len(taken) <= 2, taken
