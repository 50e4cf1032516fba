"""Loads the networks that read sentences, and runs them on whole sentences and on commands by themselves."""

from __future__ import annotations

from collections.abc import Sequence

from mmm_core.errors import CheckpointError
from mmm_core.generate.encoded_sentence import Encoded, Networks, seen_in_mirror
from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.onednn_linear import Packing, pack
from mmm_core.inference.own_layers_file import PARSER_FILE, load_classifier, load_parser, load_tagger
from mmm_core.language.gesture_steps import tokens
from mmm_core.language.mirroring import canonical
from mmm_core.language.phrase_gestures import gesture_of_phrase
from mmm_core.language.plain_gestures import Meant, gesture_of
from mmm_core.language.tagged_words import words_of
from mmm_core.language.word_tables import REMEMBERED
from mmm_core.model.gesture_classifier import meant_by
from mmm_core.model.sentence_tagger import word_states
from mmm_core.model.text import MiniLm

_KEPT = 4
"""Encoded sentences that are kept: a sentence, the same with its manner in plain words, and the same with its spelling mended."""


class WordModels:
    """The networks that read sentences.

    Args:
        encoder: the text encoder whose lower layers they use.
        networks: those above it.
    """

    def __init__(self, encoder: MiniLm, networks: Networks) -> None:
        self._encoder, self._networks = encoder, networks
        self._classified: dict[str, Meant] = {}
        self._encoded: dict[tuple[tuple[str, ...], bool], Encoded] = {}

    @classmethod
    def load(cls, encoder: MiniLm | None = None, precision: Packing = "fp32") -> WordModels:
        """The packed networks.

        Args:
            encoder: text encoder that is loaded already; the packed one when None.
            precision: of their own layers.

        Raises:
            CheckpointError: a file is missing or does not fit.
        """
        tagger, classifier, parser = load_tagger(), load_classifier(), load_parser()
        if parser.config.tokens != tokens():
            raise CheckpointError(
                PARSER_FILE,
                "tokens",
                "other gestures",
                "those of plain_gestures.txt; make a new one: mmmd train parser",
            )
        # The decoder's matrices have one to four rows. On an AMD EPYC without AVX-512 its search takes 18 ms with plain layers and
        # 22 with packed ones.
        for one in (tagger, classifier, parser.layers):
            pack(one, precision)
        return cls(encoder or load_text_encoder(), Networks(tagger, classifier, parser))

    def encode(self, sentence: str) -> Encoded:
        """A sentence as the networks see it; one that differs from one of the last few in capitals alone is not encoded anew."""
        image, is_image = canonical(sentence)
        if len(words_of(image)) != len(words_of(sentence)):  # tags are of the sentence's own words
            image, is_image = sentence, False
        words = tuple(image[start:end].lower() for start, end in words_of(image))
        found = self._encoded.get((words, is_image))
        if found is None:
            states = word_states(self._encoder, self._networks.tagger.config.n_shared, [words])[0]
            found = Encoded(states, is_image, self._networks)
            last = list(self._encoded.items())[1 - _KEPT :]
            self._encoded = dict([*last, ((words, is_image), found)])
        return found

    def classes(self, commands: Sequence[str]) -> dict[str, Meant]:
        """The gesture that each command most likely asks for by itself, with its probability."""
        if new := [text for text in commands if text not in self._classified]:
            if len(self._classified) > REMEMBERED:
                self._classified = {text: self._classified[text] for text in commands if text not in new}
            self._classified |= {
                text: Meant(gesture, 1.0) for text in new if (gesture := gesture_of(text) or gesture_of_phrase(text))
            }
            if others := [text for text in new if text not in self._classified]:
                self._classify(others)
        return {text: self._classified[text] for text in commands}

    def _classify(self, commands: Sequence[str]) -> None:
        images = [canonical(text) for text in commands]
        found = meant_by(self._networks.classifier, self._encoder, [image for image, _ in images])
        for text, one, (_, is_image) in zip(commands, found, images, strict=True):
            self._classified[text] = seen_in_mirror(Meant(*one)) if is_image else Meant(*one)
