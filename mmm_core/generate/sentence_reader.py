"""Reads sentences: by rules, and where these may be wrong, with the help of networks above the text encoder.

A tagger divides the sentence and finds its manner, a classifier tells which gestures its words mean, and a parser which gestures
the whole sentence asks for. Of all readings that come of it the likeliest is taken (`mmm_core.language.candidates`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import chain, takewhile

import numpy as np

from mmm_core.generate.encoded_sentence import Encoded
from mmm_core.generate.pointed_numbers import with_pointed_numbers
from mmm_core.generate.surely_parsed import LOG_SURE, as_surely_parsed
from mmm_core.generate.word_models import WordModels
from mmm_core.inference.onednn_linear import Packing
from mmm_core.language.asides import without_asides
from mmm_core.language.candidates import (
    Candidate,
    Ways,
    chosen,
    commands_of,
    in_sentence,
    is_task,
    merged,
    share_of_phrases,
)
from mmm_core.language.commands import EXACTLY, Reading
from mmm_core.language.contrasts import contrasted
from mmm_core.language.denial import surely_denies
from mmm_core.language.gesture_steps import NO_GESTURE, GestureSteps, is_all_gestures
from mmm_core.language.hard_phrases import without_hard_phrases
from mmm_core.language.impossible_counts import within_counts
from mmm_core.language.joined import with_parted_commands
from mmm_core.language.manner_words import likely_manners
from mmm_core.language.meant_command import with_meant_command
from mmm_core.language.parsed_reading import denies_itself, keeps_denials, reading_in, steps_asked
from mmm_core.language.plain_gestures import (
    OUTSIDE,
    SURELY_DENIED,
    alternates,
    in_plain_words,
    is_likely_outside,
    is_sure_of,
    may_deny,
    without_denied_acts,
)
from mmm_core.language.positions import in_said_order
from mmm_core.language.reading import read
from mmm_core.language.said_arm import with_said_arm, without_denied_arm
from mmm_core.language.said_at_once import said_at_once, without_repeats
from mmm_core.language.sides_said import contradicts_sides
from mmm_core.language.spelling import mended
from mmm_core.language.stop_words import before_a_stop
from mmm_core.language.sure_reading import is_sure, needs_networks, needs_tags, unknown_commands
from mmm_core.language.tagged_manner import manner_phrases, with_left_manner, with_likely_manner, with_plain_manner
from mmm_core.language.tagged_reading import can_be_read, reading_of, without_splits
from mmm_core.language.tagged_words import MANNERS, MarkedCommands, likely_tags, marked_commands, words_of
from mmm_core.language.whole_gestures import with_plain_repetitions
from mmm_core.model.text import MAX_WORD_PIECES, MiniLm, strip_emoji

_DIVISIONS = 8
"""Sequences of tags that are looked at, at most."""
_PROPOSALS = 4
"""Answers of the parser that are looked at, at most."""
_LOG_NOTHING = math.log(0.8)
"""Least log-probability that a sentence without negative words asks for nothing, as "my cat waved at me" does, to be read so."""
_FIRST_SENTENCE = "nod, and once you have done that, wave to the people who are waiting"
"""A sentence for the networks, read when they are loaded: the first one takes several times as long as the others."""


class SentenceReader:
    """Reads texts into plain commands.

    Args:
        models: the networks.
    """

    def __init__(self, models: WordModels) -> None:
        self._models = models

    @classmethod
    def load(cls, encoder: MiniLm | None = None, precision: Packing = "fp32") -> SentenceReader:
        """The reader with the packed networks.

        Args:
            encoder: text encoder that is loaded already; the packed one when None.
            precision: of the networks' own layers.

        Raises:
            CheckpointError: a file is missing or does not fit.
        """
        reader = cls(WordModels.load(encoder, precision))
        reader.read(_FIRST_SENTENCE)
        return reader

    def read(self, text: str) -> Reading:
        """The commands of a text."""
        found = without_denied_arm(with_said_arm(self._read(text)))
        if text.startswith(EXACTLY):
            return found
        found = without_hard_phrases(text, with_pointed_numbers(within_counts(found), self._models))
        return with_plain_repetitions(found, self._models.classes)

    def _read(self, text: str) -> Reading:
        by_rules = read(text)
        if by_rules.too_many:
            return by_rules
        words = self._words_to_understand(by_rules, text)
        if not words:
            return self._as_surely_parsed(by_rules) if by_rules.text == text and not by_rules.steps else by_rules
        states = self._models.encode(words)
        ways = self._ways(text, words, states)
        if ways:
            found = chosen(ways)
        else:
            found = with_left_manner(by_rules, words, manner_phrases(words, states.manners))
            found = said_at_once(without_repeats(found))
        whole = states.meant
        outside = max(whole.probability if whole.name == OUTSIDE else 0.0, ways.outside if ways else 0.0)
        manners = likely_manners(words, whole.manners, _of_tags(states))
        found = without_denied_acts(with_likely_manner(found, manners), whole)
        found = with_likely_manner(as_surely_parsed(found, states, self._models.classes), manners)
        return replace(found, outside=outside)

    def _as_surely_parsed(self, nothing: Reading) -> Reading:
        """A reading without commands, by the rules alone, or the parser's answer if it is sure of another one."""
        words = _to_encode(nothing.text)
        return as_surely_parsed(nothing, self._models.encode(words), self._models.classes) if words else nothing

    def manner_evidence(self, text: str) -> tuple[Mapping[str, float], Mapping[str, float]]:
        """The probability of each tempo and size by what a text means as a whole, and the greatest one of any of its words."""
        states = self._models.encode(_in_order(strip_emoji(text)))
        return states.meant.manners, _of_tags(states)

    def ways_to_read(self, text: str) -> Ways | None:
        """The ways to read a text among which one is chosen; None where the rules alone read it or no way is known."""
        words = self._words_to_understand(read(text), text)
        return self._ways(text, words, self._models.encode(words)) if words else None

    def _words_to_understand(self, by_rules: Reading, text: str) -> str:
        """The words of a text that the networks read; empty where the rules alone do."""
        if by_rules.text != text or not needs_networks(by_rules):
            return ""
        return _to_encode(text)

    def _ways(self, text: str, words: str, states: Encoded) -> Ways | None:
        """The ways to read the words of a text: by the rules, by tags and by the parser, also with its manner in plain words."""
        by_rules = within_counts(read(words))
        is_denial = not by_rules.steps and surely_denies(words)
        if is_denial or not needs_tags(by_rules) or (not by_rules.denied and is_likely_outside(states.meant)):
            return None
        phrases = manner_phrases(words, states.manners)
        found: list[Candidate] = []
        plain = with_plain_manner(words, phrases)
        if plain != words and 0 < len(words_of(plain)) <= MAX_WORD_PIECES:
            of_plain = self._models.encode(plain)
            found += [replace(one, by_rules=False, sure_rules=False) for one in self._candidates(plain, of_plain)]
        found += self._candidates(words, states)
        if by_rules.denied:  # what is denied must not be done
            found = [one for one in found if one.reading.denied]
        if alternates(by_rules):  # tags take the arms of one command for commands
            found = [one for one in found if one.by_rules]
        readings = [within_counts(replace(one.reading, text=text)) for one in found]
        self._models.classes(
            list(dict.fromkeys(chain.from_iterable(map(unknown_commands, readings))))
        )  # all in one pass
        finished = [self._in_plain_words(with_left_manner(one, words, phrases), states) for one in readings]
        candidates = merged(
            replace(one, reading=said_at_once(without_repeats(plain)), phrases=share_of_phrases(reading))
            for one, reading, plain in zip(found, readings, finished, strict=True)
        )
        candidates = self._without_contradictions(candidates)
        candidates, outside = self._parsed(candidates, text, states)
        return Ways(candidates, self._models.classes(commands_of(candidates)), states.meant, outside)

    def _without_contradictions(self, candidates: list[Candidate]) -> list[Candidate]:
        """Candidates without those that ask for what they deny; all of them where nothing else remains."""
        denied = list(dict.fromkeys(chain.from_iterable(one.reading.denied for one in candidates)))
        if not denied:
            return candidates
        acts, meant = self._models.classes(denied), self._models.classes(commands_of(candidates))
        return [one for one in candidates if not denies_itself(one.reading, meant, acts)] or candidates

    def _parsed(self, candidates: list[Candidate], text: str, states: Encoded) -> tuple[list[Candidate], float]:
        """Candidates and those that the parser proposes, each with its probability by the parser; and that of no gesture."""
        answers = [*self._answers(candidates), NO_GESTURE, ()]
        logs = states.parse.log_likelihoods(answers)
        *_, outside, nothing = logs
        if nothing >= _LOG_NOTHING and not may_deny(text):
            return [Candidate(Reading(text, ()), by_parser=True, log_parsed=nothing)], math.exp(outside)
        best, answer = max(zip(logs, answers, strict=True))
        likeliest = [answer] if best >= LOG_SURE else states.parse.likeliest(_PROPOSALS)
        found = [*candidates, *self._proposed(candidates, text, states, likeliest)]
        asked = self._answers(found)
        logs = states.parse.log_likelihoods(asked)
        parsed = [replace(one, log_parsed=log) for one, log in zip(found, logs, strict=True)]
        fitting = [one for one, steps in zip(parsed, asked, strict=True) if not contradicts_sides(steps, text)]
        return merged(fitting or parsed), math.exp(outside)

    def _answers(self, candidates: Sequence[Candidate]) -> list[GestureSteps]:
        """The answer of the parser that each candidate would be."""
        meant = self._models.classes(commands_of(candidates))
        return [steps_asked(one.reading, meant) for one in candidates]

    def _proposed(
        self, candidates: Sequence[Candidate], text: str, states: Encoded, likeliest: Sequence[GestureSteps]
    ) -> list[Candidate]:
        """Readings in the gestures that the parser finds likeliest.

        None where another reading has a task that must be refused, or is one command of arms in turn. A sentence that may deny and
        in all likelihood asks for nothing has no commands.
        """
        readings = [one.reading for one in candidates]
        meant = self._models.classes(commands_of(candidates))
        if any(map(alternates, readings)) or any(is_task(command, one) for command, one in meant.items()):
            return []
        acts = self._models.classes(list(dict.fromkeys(chain.from_iterable(one.denied for one in readings))))
        may_be_nothing = may_deny(text)
        is_nothing = may_be_nothing and states.meant.denied >= SURELY_DENIED
        # Answers after one with something that is no gesture are dropped: they would leave out what must be refused.
        answers = list(takewhile(is_all_gestures, likeliest))
        allowed = (
            steps
            for steps, log in zip(answers, states.parse.log_likelihoods(answers), strict=True)
            if (not is_nothing if steps else may_be_nothing) and keeps_denials(steps, readings, meant, acts, log)
        )
        found = (reading_in(steps, text, readings, meant) for steps in allowed)
        return [Candidate(one, by_parser=True, phrases=share_of_phrases(one)) for one in found if one is not None]

    def _candidates(self, words: str, states: Encoded) -> list[Candidate]:
        """The readings of words by the rules and by each likely sequence of tags."""
        divisions: dict[MarkedCommands, float] = {}
        for sequence, log in likely_tags(states.tags, _DIVISIONS):
            marked = marked_commands(words, without_splits(words, sequence))
            if can_be_read(marked) and (may_deny(words) or not marked.denied):
                divisions.setdefault(marked, log)
        meant = states.classes(list(divisions))
        best = max(divisions.values(), default=0.0)
        by_rules = within_counts(read(words))
        found = [Candidate(by_rules, by_rules=True, sure_rules=is_sure(by_rules))]
        for (marked, log), means in zip(divisions.items(), meant, strict=True):
            reading = reading_of(words, marked, means)
            found.append(Candidate(reading, in_sentence=in_sentence(means), log_share=log - best))
        return found

    def _in_plain_words(self, found: Reading, states: Encoded) -> Reading:
        """The reading in plain words where it is likely which gestures are meant."""
        unknown = unknown_commands(found)
        if not unknown:
            return found
        whole = states.meant
        if sum(map(len, found.steps)) == 1 and not found.denied and is_sure_of(whole):  # it may name what is denied
            return in_plain_words(found, whole, {unknown[0]: whole})
        by_text = self._models.classes(unknown)
        parted = with_parted_commands(found, by_text, self._models.classes)
        if parted is not found:
            return self._in_plain_words(parted, states)
        by_words = {text: one.manners for text, one in by_text.items()}
        return in_plain_words(with_likely_manner(without_asides(found, by_text), {}, by_words), whole, by_text)


def _to_encode(text: str) -> str:
    """The words of a text as the networks read them; empty for none, and for more than they can read."""
    words = _in_order(strip_emoji(text))
    return words if 0 < len(words_of(words)) <= MAX_WORD_PIECES else ""


def _of_tags(states: Encoded) -> dict[str, float]:
    """The greatest probability of each manner among the words of a sentence."""
    return dict(zip(MANNERS, np.exp(states.manners.max(0)).tolist(), strict=True))


def _in_order(words: str) -> str:
    """A sentence with its clauses in order, without acts that are set aside or taken back and without a stop at its end.

    The networks hardly know to find these.
    """
    words = before_a_stop(words)
    lower, said = words.lower(), mended(words)
    ordered = in_said_order(contrasted(said))
    return words if ordered == said and with_meant_command(lower) == lower else ordered
