"""Reads sentences: by rules, and where these are not sure, with the help of a tagger above the text encoder."""

from __future__ import annotations

from dataclasses import replace

from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.onednn_linear import Packing, pack
from mmm_core.inference.tagger_file import load_tagger
from mmm_core.language.commands import Reading
from mmm_core.language.reading import read
from mmm_core.language.tagged_reading import is_sure, read_with_tags
from mmm_core.language.tagged_words import likeliest_tags, words_of
from mmm_core.model.sentence_tagger import SentenceTagger, log_probability
from mmm_core.model.text import MAX_WORD_PIECES, MiniLm, strip_emoji

_FIRST_SENTENCE = "nod, and once you have done that, wave to the people who are waiting"
"""A sentence for the tagger, read when it is loaded: the first one takes several times as long as the others."""


class SentenceReader:
    """Reads texts into plain commands.

    Args:
        encoder: the text encoder whose lower layers the tagger uses.
        tagger: the tagger.
    """

    def __init__(self, encoder: MiniLm, tagger: SentenceTagger) -> None:
        self._encoder, self._tagger = encoder, tagger

    @classmethod
    def load(cls, encoder: MiniLm | None = None, precision: Packing = "fp32") -> SentenceReader:
        """The reader with the packed tagger.

        Args:
            encoder: text encoder that is loaded already; the packed one when None.
            precision: of the tagger's own layers.

        Raises:
            CheckpointError: a file is missing or does not fit.
        """
        tagger = load_tagger()
        pack(tagger, precision)
        reader = cls(encoder or load_text_encoder(), tagger)
        reader.read(_FIRST_SENTENCE)
        return reader

    def read(self, text: str) -> Reading:
        """The commands of a text."""
        by_rules = read(text)
        if is_sure(by_rules) or by_rules.text != text:
            return by_rules
        words = strip_emoji(text)
        without_emoji, spans = read(words), words_of(words)
        if is_sure(without_emoji) or not 0 < len(spans) <= MAX_WORD_PIECES:
            return by_rules
        scores = log_probability(self._tagger, self._encoder, [words[start:end] for start, end in spans])
        return replace(read_with_tags(without_emoji, likeliest_tags(scores.numpy())), text=text)
