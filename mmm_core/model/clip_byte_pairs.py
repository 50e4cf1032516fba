"""Turns a text into CLIP's byte-pair ids: repairs the text, then cuts it by the vocabulary.

Radford et al. 2021 (arXiv 2103.00020) sec. 2.4: lower-cased byte pairs. CLIP first repairs a text with ftfy, which also turns
curly quotes and apostrophes into straight ones, and decodes HTML's signs ("&amp;"). Only with the same repairs are the ids
CLIP's own.
"""

from __future__ import annotations

import gzip
import html
import json
from pathlib import Path

from tokenizers import Regex, Tokenizer, decoders, models, pre_tokenizers

from mmm_core.errors import CheckpointError

N_MERGES = 49152 - 256 - 2
"""Number of byte pairs that are read from the published vocabulary file."""
_PIECES = r"<\|startoftext\|>|<\|endoftext\|>|(?i:'s|'t|'re|'ve|'m|'ll|'d)|[\p{L}]+|[\p{N}]|[^\s\p{L}\p{N}]+"


def clean_text(text: str) -> str:
    """`text` repaired by ftfy, with HTML's signs decoded twice, single spaces and lower case, as CLIP does it."""
    import ftfy  # 0.1 s that a model with another text encoder need not wait for

    return " ".join(html.unescape(html.unescape(ftfy.fix_text(text))).split()).lower()


def read_vocabulary(path: Path) -> Tokenizer:
    """CLIP's byte-pair tokenizer from `bpe_simple_vocab_16e6.txt.gz` (or unpacked), or a `tokenizer.json`.

    Raises:
        CheckpointError: the file is missing or neither of the two.
    """
    if not path.is_file():
        raise CheckpointError(path, "", "no such file", "bpe_simple_vocab_16e6.txt.gz or tokenizer.json")
    try:
        if path.suffix == ".json":
            json.loads(path.read_text())
            return Tokenizer.from_file(str(path))
        raw = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
        lines = raw.decode("utf-8").split("\n")[1 : N_MERGES + 1]
        return byte_pairs([(a, b) for a, b in (line.split() for line in lines if line.strip())])
    except (OSError, ValueError) as error:
        expected = "bpe_simple_vocab_16e6.txt.gz or tokenizer.json"
        raise CheckpointError(path, "", f"not a vocabulary ({error})", expected) from error


def byte_pairs(merges: list[tuple[str, str]]) -> Tokenizer:
    """Tokenizer over bytes with `merges`, for texts cleaned by `clean_text`; `</w>` ends a word."""
    letters = _byte_letters()
    vocabulary = [*letters, *(letter + "</w>" for letter in letters), *(a + b for a, b in merges)]
    ids = {piece: i for i, piece in enumerate([*vocabulary, "<|startoftext|>", "<|endoftext|>"])}
    pieces = Tokenizer(models.BPE(ids, merges, end_of_word_suffix="</w>"))
    pieces.pre_tokenizer = pre_tokenizers.Sequence(
        [
            pre_tokenizers.Split(Regex(_PIECES), behavior="removed", invert=True),
            pre_tokenizers.ByteLevel(add_prefix_space=False, use_regex=False),
        ]
    )
    pieces.add_special_tokens(["<|startoftext|>", "<|endoftext|>"])  # a text that holds them gets their ids, as in CLIP
    pieces.decoder = decoders.ByteLevel()
    return pieces


def _byte_letters() -> list[str]:
    """A printable letter for each byte, GPT-2's order: printable bytes first, the others from U+0100 on."""
    printable = [*range(ord("!"), ord("~") + 1), *range(ord("¡"), ord("¬") + 1), *range(ord("®"), ord("ÿ") + 1)]
    others = [b for b in range(256) if b not in printable]
    return [chr(b) for b in printable] + [chr(256 + n) for n in range(len(others))]
