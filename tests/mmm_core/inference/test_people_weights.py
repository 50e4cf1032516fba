"""The file of the weights for captions of people: read as written, with its checkpoint alone, and refused where it does not fit."""

from __future__ import annotations

from pathlib import Path

import pytest
import torch
from torch import nn

from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import file_hash
from mmm_core.inference.people_weights import PeopleWeights, load_people, people_file, save_people
from mmm_core.model.low_rank import add_changes
from mmm_core.model.tokenizer import Tokenizer, TokenizerConfig
from mmm_core.model.transformer import MotionTransformer, TransformerConfig

SIZES = TransformerConfig(n_codes=8, n_codebooks=2, code_dim=4, width=16, n_heads=2, n_cross=1, n_self=1, text_dim=12)


def transformer(sizes: TransformerConfig = SIZES) -> MotionTransformer:
    """A new transformer, always with the same weights."""
    torch.manual_seed(1)
    return MotionTransformer(sizes).eval()


def tokenizer(width: int = 8) -> Tokenizer:
    """A new tokenizer, always with the same weights."""
    torch.manual_seed(2)
    return Tokenizer(TokenizerConfig(n_codes=8, code_dim=4, decoder_width=width)).eval()


@pytest.fixture(name="checkpoint")
def _checkpoint(tmp_path: Path) -> Path:
    """A file that stands for the checkpoint, with weights for captions of people beside it."""
    path = tmp_path / "model.safetensors"
    path.write_bytes(b"a checkpoint")
    trained, decoding = transformer(), tokenizer()
    for module in (trained, decoding):
        add_changes(module, 2)
        for name, parameter in module.named_parameters():
            if name.endswith(".up"):
                nn.init.normal_(parameter, std=0.05)
    save_people(people_file(path), trained, decoding, nn.Linear(12, 1), path, 2.5, {"seed": 1})
    return path


def test_a_checkpoint_without_the_file_has_none(tmp_path: Path) -> None:
    assert load_people(transformer(), tokenizer(), tmp_path / "model.safetensors", "") is None


def test_what_is_read_is_what_was_trained(checkpoint: Path) -> None:
    own, decoding = transformer(), tokenizer()
    people = load_people(own, decoding, checkpoint, file_hash(checkpoint))
    assert people is not None and people.guidance == 2.5 and people.captions.weight.shape == (1, 12)
    plain = transformer()
    assert all(torch.equal(own.state_dict()[name], tensor) for name, tensor in plain.state_dict().items()), "a copy"
    moved = float((people.transformer.head.weight - plain.head.weight).detach().abs().max())
    assert 1e-3 < moved < 1
    for name, tensor in tokenizer().state_dict().items():
        assert torch.equal(decoding.state_dict()[name], tensor), "a copy"
        changed = not torch.equal(people.tokenizer.state_dict()[name], tensor)
        assert changed == (name.endswith("weight") and not name.startswith("quantizers")), name


def test_the_file_of_another_checkpoint_is_refused(checkpoint: Path) -> None:
    with pytest.raises(CheckpointError, match=r"model_people\.safetensors.*start.*no such file"):
        load_people(transformer(), tokenizer(), checkpoint, "0" * 64)


def test_changes_that_do_not_fit_are_refused(checkpoint: Path) -> None:
    wider = transformer(TransformerConfig(**{**vars(SIZES), "width": 32}))
    with pytest.raises(CheckpointError, match="a change that does not fit"):
        load_people(wider, tokenizer(), checkpoint, file_hash(checkpoint))
    with pytest.raises(CheckpointError, match="a change that does not fit"):
        load_people(transformer(), tokenizer(width=16), checkpoint, file_hash(checkpoint))
    people_file(checkpoint).write_bytes(b"nothing of the kind")
    with pytest.raises(CheckpointError, match="not a readable safetensors file"):
        load_people(transformer(), tokenizer(), checkpoint, file_hash(checkpoint))


@pytest.mark.parametrize(
    ("text", "logit", "expected"),
    [
        ("a person dribbles a basketball", 3.0, True),
        ("a person dribbles a basketball", 0.5, False),
        ("a person waves with their right hand", 9.0, False),
        ("dribble a basketball", 9.0, False),
    ],
)
def test_they_are_for_captions_that_no_phrase_has(text: str, logit: float, expected: bool) -> None:
    line = nn.Linear(12, 1)
    nn.init.zeros_(line.weight)
    nn.init.constant_(line.bias, logit)
    assert PeopleWeights(transformer(), tokenizer(), line, 1.0).are_for(text, torch.zeros(12)) == expected
