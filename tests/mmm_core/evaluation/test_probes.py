"""The sets of probes: their sentences stay out of training, name what there is, and share nothing."""

from __future__ import annotations

import re
from functools import partial

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.grammar import base_phrase
from mmm_core.corpus.heldout import HELD_OUT_VERBS, PROBES, TEST_PROBES, read_sentences
from mmm_core.corpus.plain_commands import known_commands
from mmm_core.corpus.synthesis import ClipSpec, synthesise, synthesise_spec
from mmm_core.corpus.withheld import is_withheld
from mmm_core.evaluation.probes import evaluate, judge
from mmm_core.evaluation.reconstruction import performed, shown
from mmm_core.evaluation.robot_capability import as_motion, showable
from mmm_core.motion.features import mirror
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from retarget.robot_to_human import shown_on_a_person
from tests.support.sizes import few_and_long


@pytest.mark.long
def test_no_probe_is_a_sentence_of_the_grammar_and_some_words_are_new() -> None:
    """Thousands of drawn captions and every plain phrase: the probes' words stay out of training."""

    def plain(text: str) -> str:
        return re.sub(r"[^a-z0-9 ]", "", text.lower()).strip()

    said = {plain(text) for text in known_commands(10_000)}
    for i in range(150):
        said |= {plain(text) for text in synthesise(np.random.default_rng((1, i))).captions}
    assert not said & {plain(p.text) for p in (*PROBES, *TEST_PROBES)}
    assert not [text for text in said if is_withheld(text)], "but for politeness, articles and digits"
    words = {word for text in said for word in text.split()}
    assert not [v for v in HELD_OUT_VERBS if {v, v + "s", v + "es", v + "ing", v[:-1] + "ing"} & words]


def test_a_phrase_that_is_a_probe_but_for_its_trimmings_is_withheld() -> None:
    for probe in PROBES:
        assert is_withheld(probe.text)
        assert is_withheld(f"Robot, {probe.text.replace('two', '2')}, please!")
    assert not is_withheld("wave your left hand")
    gesture = Gesture("bow", count=2)
    drawn_phrases = {base_phrase(gesture, np.random.default_rng(i)) for i in range(400)}
    assert not [p for p in drawn_phrases if is_withheld(p)], "two bows are a probe, and a pattern says {N} bows"


def test_probes_name_families_limbs_and_directions_that_exist() -> None:
    for probe in (*PROBES, *TEST_PROBES):
        assert FAMILIES[probe.family].limb == probe.limb, probe.text
        assert probe.direction in ("", *FAMILIES[probe.family].directions), probe.text


def test_the_test_set_shares_no_sentence_with_the_development_set() -> None:
    assert len({p.text for p in TEST_PROBES}) == len(TEST_PROBES) >= 198
    assert not {p.text.lower() for p in TEST_PROBES} & {p.text.lower() for p in PROBES}


@pytest.mark.parametrize(
    ("name", "n"),
    [
        ("words_dev", 560),
        ("words_dev_2", 659),
        ("words_dev_3", 1904),
        ("words_dev_4", 1893),
        ("words_dev_5", 298),
        ("words_test", 310),
        ("words_test_singles", 231),
        ("words_test_denials", 221),
        ("words_test_denials_2", 208),
        ("words_test_5", 215),
        ("words_test_4", 223),
        ("words_test_3", 219),
        ("words_test_2", 218),
        ("words_test_1", 220),
        ("words_phrases_dev", 287),
        ("words_phrases_test", 148),
    ],
)
def test_sentences_as_people_say_them_name_gestures_that_exist(name: str, n: int) -> None:
    """Each was written by someone who had seen neither rules nor corpus nor the other."""
    sentences = read_sentences(name)
    assert len({s.text for s in sentences}) == len(sentences) == n
    for s in sentences:
        assert bool(s.commands) != s.nothing and bool(s.clean) == (s.kind == "slips"), s.text
        assert set(s.denied) <= set(FAMILIES), s.text
        for c in (c for at_once in s.commands for c in at_once):
            family = FAMILIES[c.family]
            assert c.limb == family.limb and c.side in ("", *family.sides), s.text
            assert c.direction in ("", *family.directions) and c.size in ("", "small", "large"), s.text


@pytest.mark.long
def test_both_sets_of_probes_can_be_measured() -> None:
    """A set is given as it is: what is not performed at all meets nothing of either."""
    still = performed(next(p for p in TEST_PROBES if p.family == "bow"), 0)[:1].repeat(40, 0)
    figures = evaluate(lambda text, _: as_motion(still, text), [0], probes=TEST_PROBES)
    assert figures["n"] == len(TEST_PROBES) and figures["side"] == 0.0 and figures["count_exact"] == 0.0


@pytest.mark.long
def test_what_the_corpus_performs_passes_the_whole_suite() -> None:
    met: dict[str, list[bool]] = {}
    for i, probe in enumerate(PROBES):
        for key, ok in judge(probe, shown(performed(probe, i)), with_pose=True).items():
            met.setdefault(key, []).append(ok)
    assert set(met) == {"limb", "pose", "side", "count", "count_exact", "direction", "hold", "tempo", "order"}
    shares = {key: np.mean(values) for key, values in met.items()}
    assert min(shares.values()) >= 0.95, shares
    assert shares["side"] >= 0.99
    assert shares["limb"] >= 0.99


@pytest.mark.parametrize("every", few_and_long([6], [1]))
def test_standing_still_and_the_mirror_image_fail_the_suite(every: int) -> None:
    stands = synthesise_spec(ClipSpec((Gesture("stand"),)), np.random.default_rng(0))
    assert stands is not None
    still = shown(stands.features)
    assert not any(all(judge(p, still, with_pose=True).values()) for p in PROBES)
    one_sided = [p for p in PROBES if p.side in ("left", "right") and p.then is None]
    assert not any(judge(p, shown(mirror(performed(p, i))))["side"] for i, p in enumerate(one_sided[::every]))


def test_what_a_robot_can_show_is_told_apart_from_what_was_understood() -> None:
    texts = ("bow deeply before the queen", "do two bows", "left arm up", "wag your head no")
    some = [p for p in PROBES if p.text in texts]
    on_a_person = showable(lambda motion: motion, probes=some)
    assert on_a_person["do two bows"] == {"limb", "pose", "count", "count_exact"}
    assert on_a_person["left arm up"] == {"limb", "pose", "side"}
    without_a_waist = showable(partial(shown_on_a_person, Retargeter(load_robot("op3"))), probes=some)
    assert not without_a_waist["bow deeply before the queen"], "OP3 has no waist"
    assert without_a_waist["left arm up"] >= {"limb", "side"} and "limb" in without_a_waist["wag your head no"]


def test_an_expectation_that_cannot_be_shown_is_counted_only_in_all() -> None:
    standing = synthesise_spec(ClipSpec((Gesture("stand"),)), np.random.default_rng(0))
    assert standing is not None
    still = as_motion(standing.features)
    limbs = {p.text: frozenset({"limb"} if p.then is None and p.limb == "arm" else ()) for p in PROBES}
    figures = evaluate(lambda _text, _seed: still, (0,), showable=limbs)
    assert figures["limb"] == figures["of_showable"]["limb"] == 0, "a person who stands shows no limb"
    assert figures["of_showable"]["n_each"] == {"limb": sum("limb" in keys for keys in limbs.values())}
    assert figures["n_each"]["limb"] > figures["of_showable"]["n_each"]["limb"]
