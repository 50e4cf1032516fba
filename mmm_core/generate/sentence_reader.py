"""Reads sentences: by rules, and where these do not know every word, with the help of a tagger above the text encoder."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.onednn_linear import Packing, pack
from mmm_core.inference.tagger_file import load_tagger
from mmm_core.language.commands import Reading
from mmm_core.language.reading import read
from mmm_core.language.tagged_manner import manner_phrases, with_plain_manner
from mmm_core.language.tagged_reading import is_sure, names_acts, needs_tags, read_with_tags
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
        if by_rules.text != text or not needs_tags(by_rules):
            return by_rules
        words = strip_emoji(text)
        without_emoji = read(words)
        if not needs_tags(without_emoji) or not 0 < len(words_of(words)) <= MAX_WORD_PIECES:
            return by_rules
        tags, manners = self._tagged(words)
        plain = with_plain_manner(words, manner_phrases(words, manners))
        in_plain = read(plain) if plain != words else without_emoji
        loses_an_act = names_acts(without_emoji) and not names_acts(in_plain)
        if plain == words or loses_an_act:
            return by_rules if is_sure(without_emoji) else replace(read_with_tags(without_emoji, tags), text=text)
        return replace(in_plain if is_sure(in_plain) else read_with_tags(in_plain, self._tagged(plain)[0]), text=text)

    def _tagged(self, sentence: str) -> tuple[list[str], NDArray[np.float32]]:
        """The likeliest tags of a sentence's words, and the (N, 5) log-probabilities of their manners."""
        words = [sentence[start:end] for start, end in words_of(sentence)]
        tags, manners = log_probability(self._tagger, self._encoder, words)
        return likeliest_tags(tags.numpy()), manners.numpy()
