"""CLIP as the released model reads texts: its tower, its byte pairs, and texts that it mends before it cuts them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import torch
from torch import Tensor

from mmm_core.errors import CheckpointError
from mmm_core.imports.clip_weights import clip_from_openai
from mmm_core.model.clip_byte_pairs import byte_pairs, clean_text, read_vocabulary
from tests.support.golden import GOLDEN, golden, needs_golden
from tests.support.official import TOLERANCE

pytestmark = needs_golden


@pytest.mark.long
def test_clip_text_tower(io: dict[str, Tensor]) -> None:
    tower = clip_from_openai(golden("clip_text_tiny"), GOLDEN, n_heads=4)
    states = tower.states(io["clip.in.tokens"])
    torch.testing.assert_close(states.words, io["clip.out.word"], **TOLERANCE)
    torch.testing.assert_close(states.sentence, io["clip.out.sent"], **TOLERANCE)


class TestClipIds:
    """Ids of CLIP's own tokenizer, cut with a part of its byte pairs, for texts that it mends before it cuts them.

    Curly quotes and apostrophes, HTML's signs, wrongly decoded bytes, full-width letters and the like gave other ids.
    """

    DATA = Path(__file__).parent / "clip_ids.json"

    def test_ids_of_texts_that_are_mended(self) -> None:
        content = json.loads(self.DATA.read_text())
        pieces = byte_pairs([(a, b) for a, b in (merge.split() for merge in content["merges"])])
        assert len(content["texts"]) >= 40
        for text, ids in content["texts"].items():
            assert pieces.encode(clean_text(text), add_special_tokens=False).ids == ids, repr(text)

    def test_everyday_quotes_and_apostrophes(self) -> None:
        assert (
            clean_text("\u201cwave\u201d, she\u2019s   ready &amp; waiting\u2026")
            == '"wave", she\'s ready & waiting\u2026'
        )


class TestClipVocabulary:
    MERGES = (("w", "a"), ("v", "e</w>"), ("wa", "ve</w>"), ("t", "h"), ("th", "e</w>"))

    def test_pieces_by_hand(self) -> None:
        """Ids: 256 bytes, the same at a word's end, then the merges; case and spaces do not matter."""
        pieces = byte_pairs(list(self.MERGES))
        wave, the = 512 + 2, 512 + 4
        assert pieces.encode(clean_text("The   WAVE"), add_special_tokens=False).ids == [the, wave]
        comma = 256 + (ord(",") - ord("!"))
        assert pieces.encode("wave, the", add_special_tokens=False).ids == [wave, comma, the]
        assert pieces.get_vocab_size() == 512 + 5 + 2

    def test_the_published_files_form_is_read(self, tmp_path: Path) -> None:
        import gzip

        lines = ['"bpe_simple_vocab_16e6.txt#version: 0.2', *(f"{a} {b}" for a, b in self.MERGES)]
        (tmp_path / "v.txt.gz").write_bytes(gzip.compress("\n".join(lines).encode()))
        pieces = read_vocabulary(tmp_path / "v.txt.gz")
        assert pieces.encode("the wave", add_special_tokens=False).ids == [516, 514]

    def test_what_is_no_vocabulary_is_named(self, tmp_path: Path) -> None:
        (tmp_path / "v.txt.gz").write_bytes(b"no gzip")
        with pytest.raises(CheckpointError, match="not a vocabulary"):
            read_vocabulary(tmp_path / "v.txt.gz")
