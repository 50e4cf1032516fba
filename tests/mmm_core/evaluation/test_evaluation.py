"""The checks are right on what is right, and wrong on what is mirrored, absent or something else."""

from __future__ import annotations

import re
from functools import partial

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.grammar import base_phrase
from mmm_core.corpus.heldout import HELD_OUT_VERBS, PROBES, TEST_PROBES, Probe, read_sentences
from mmm_core.corpus.plain_commands import known_commands
from mmm_core.corpus.synthesis import ClipSpec, draw_gesture, synthesise, synthesise_spec
from mmm_core.corpus.withheld import is_withheld
from mmm_core.evaluation.probes import evaluate, judge
from mmm_core.evaluation.reconstruction import performed, shown
from mmm_core.evaluation.robot_capability import as_motion, showable
from mmm_core.motion.features import mirror
from mmm_core.motion.posture_features import PostureFeatures
from mmm_core.recognition import checks
from mmm_core.recognition.signs import shows
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from retarget.robot_to_human import shown_on_a_person

LIMB_FAMILIES = (
    "wave", "raise", "point", "clap", "bow", "nod", "shake_head", "look", "tilt_head", "lean",
    "twist", "cross_arms", "hands_on_hips", "salute", "punch", "stop", "t_pose", "hands_up", "think", "heart", "beckon",
)  # fmt: skip
SHOWN_AS = {"alternating": "both"}
COUNTED = ("wave", "clap", "nod", "bow", "punch", "beckon")
DIRECTED = ("look", "point", "lean", "twist", "tilt_head")


def gestures(name: str, n: int = 12) -> list[tuple[Gesture, np.ndarray]]:
    """Clips of one family in all its sides, counts and directions."""
    made, family = [], FAMILIES[name]
    for i in range(n):
        rng = np.random.default_rng((7, i))
        side = family.sides[i % len(family.sides)] if family.sides else ""
        where = family.directions[i % len(family.directions)] if family.directions else ""
        clip = synthesise_spec(ClipSpec((Gesture(name, side, 1 + i % 4 if family.counts else 1, where),)), rng)
        if clip is not None:
            made.append((clip.spec.gestures[0], clip.features))
    return made


@pytest.mark.parametrize("name", LIMB_FAMILIES)
def test_side_and_limb_are_seen_on_motions_that_are_right(name: str) -> None:
    found = [(g, shown(f)) for g, f in gestures(name)]
    assert sum(checks.limb(s) == FAMILIES[name].limb for _, s in found) >= len(found) - 1
    if FAMILIES[name].sides:
        assert sum(s.arms == SHOWN_AS.get(g.side, g.side) for g, s in found) >= len(found) - 1


@pytest.mark.parametrize("name", ["wave", "raise", "salute", "stop"])
def test_a_mirrored_motion_fails_the_side(name: str) -> None:
    other = {"left": "right", "right": "left", "both": "both", "alternating": "both"}
    found = [(g, shown(mirror(f))) for g, f in gestures(name)]
    assert sum(s.arms == other[g.side] for g, s in found) >= len(found) - 1


@pytest.mark.parametrize("name", COUNTED)
def test_counts_are_seen(name: str) -> None:
    found = [
        (g.count, checks.count(shown(f), name))
        for g, f in gestures(name, 16)
        if g.side in ("left", "right", "") or FAMILIES[name].sides == ("both",)
    ]
    assert sum(c is not None and abs(c - asked) <= 1 for asked, c in found) >= 0.9 * len(found), found
    assert sum(c == asked for asked, c in found) >= 0.7 * len(found), found


@pytest.mark.parametrize("name", DIRECTED)
def test_directions_are_seen_and_turn_round_in_a_mirror(name: str) -> None:
    made = gestures(name, 24)
    assert sum(checks.direction(shown(f), name) == g.direction for g, f in made) >= 0.9 * len(made)
    sideways = [(g, f) for g, f in made if g.direction in ("left", "right")]
    assert sum(checks.direction(shown(mirror(f)), name) == g.direction for g, f in sideways) == 0


def test_standing_still_shows_nothing() -> None:
    for i in range(5):
        clip = synthesise_spec(ClipSpec((Gesture("stand"),)), np.random.default_rng(i))
        assert clip is not None
        assert checks.limb(shown(clip.features)) == ""


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


@pytest.mark.parametrize(("name", "n"), [("words_dev", 180), ("words_test", 180)])
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


def test_both_sets_of_probes_can_be_measured() -> None:
    """A set is given as it is: what is not performed at all meets nothing of either."""
    still = performed(next(p for p in TEST_PROBES if p.family == "bow"), 0)[:1].repeat(40, 0)
    figures = evaluate(lambda text, _: as_motion(still, text), [0], probes=TEST_PROBES)
    assert figures["n"] == len(TEST_PROBES) and figures["side"] == 0.0 and figures["count_exact"] == 0.0


def drawn(name: str, n: int, seed: int = 3) -> list[tuple[Gesture, np.ndarray]]:
    """Clips of one family as training draws them: any side, count, tempo, size and manner."""
    made: list[tuple[Gesture, np.ndarray]] = []
    for i in range(40):
        if len(made) == n:
            break
        rng = np.random.default_rng((seed, len(name), ord(name[0]), i))
        gesture = draw_gesture(rng, (name,))
        clip = None if gesture.height else synthesise_spec(ClipSpec((gesture,)), rng)
        if clip is not None:
            made.append((gesture, clip.features))
    return made


@pytest.fixture(scope="module")
def everything() -> list[tuple[Gesture, PostureFeatures, PostureFeatures]]:
    """A few clips of every family, each with its mirror image."""
    return [(g, shown(f), shown(mirror(f))) for name in FAMILIES for g, f in drawn(name, 3)]


def asked_side(name: str, side: str) -> str:
    """The side that a family could be asked with, given what another gesture has."""
    sides = FAMILIES[name].sides
    return side if side in sides else "both" if sides == ("both",) else ""


@pytest.fixture(scope="module", params=[6, pytest.param(1, id="every clip", marks=pytest.mark.soak)])
def seen_elsewhere(
    request: pytest.FixtureRequest, everything: list[tuple[Gesture, PostureFeatures, PostureFeatures]]
) -> dict[str, list[bool]]:
    """For each family whether its sign is seen in a sixth of the clips of the other families; in all in the soak run."""
    seen: dict[str, list[bool]] = {name: [] for name in FAMILIES}
    for g, s, _ in everything[:: request.param]:
        for name, family in FAMILIES.items():
            if g.family != name:
                seen[name].append(shows(s, name, asked_side(name, g.side), (family.directions or ("",))[0]))
    return seen


@pytest.mark.parametrize("name", sorted(FAMILIES))
def test_each_family_has_a_sign_that_sees_it_and_little_else(
    name: str, everything: list[tuple[Gesture, PostureFeatures, PostureFeatures]], seen_elsewhere: dict[str, list[bool]]
) -> None:
    """Right: own motions. Mirrored: not with the same arm. Absent: standing. Other: every other family."""
    own = [(g, s, m) for g, s, m in everything if g.family == name]
    assert sum(shows(s, name, g.side, g.direction) for g, s, _ in own) >= len(own) - 1
    one_sided = [(g, m) for g, _, m in own if g.side in ("left", "right")]
    assert not any(shows(m, name, g.side, g.direction) for g, m in one_sided if name not in USES_OTHER_ARM)
    family = FAMILIES[name]
    where = family.directions[0] if family.directions else ""
    if name not in ("stand", "shift"):
        absent = [s for g, s, _ in everything if g.family == "stand"]
        assert not any(shows(s, name, asked_side(name, ""), where) for s in absent)
    assert np.mean(seen_elsewhere[name]) < (0.32 if name in LOOSE else 0.12)


USES_OTHER_ARM = ("disco", "dab", "superhero")
# fmt: off
LOOSE = ("point", "beckon", "go_away", "punch", "hook", "uppercut", "karate_chop", "lift_weight", "knock", "hammer",
         "conduct", "dance_pump", "handshake", "wave", "draw_circle", "sword", "paint", "fist_pump",
         "push", "pull")
# fmt: on
"""Signs of up-and-down and to-and-fro movements, which many gestures have."""


def test_signs_together_seldom_see_what_is_not_there(seen_elsewhere: dict[str, list[bool]]) -> None:
    assert np.mean([np.mean(seen) for seen in seen_elsewhere.values()]) < 0.06


@pytest.mark.parametrize(("first", "second"), [
    (Gesture("raise", "left"), Gesture("bow")), (Gesture("bow"), Gesture("raise", "right")),
    (Gesture("nod", count=2), Gesture("clap", "both", 3)),
    (Gesture("look", direction="left"), Gesture("look", direction="right")), (Gesture("raise", "left"), Gesture("raise", "right")),
])  # fmt: skip
def test_order_is_seen_and_the_other_order_is_not(first: Gesture, second: Gesture) -> None:
    def probe(a: Gesture, b: Gesture) -> Probe:
        then = Probe("", b.family, FAMILIES[b.family].limb, b.side, None, b.direction)
        return Probe("", a.family, FAMILIES[a.family].limb, a.side, None, a.direction, then=then)

    made = [synthesise_spec(ClipSpec((first, second)), np.random.default_rng(i)) for i in range(8)]
    seen = [shown(clip.features) for clip in made if clip is not None]
    assert sum(judge(probe(first, second), s)["order"] for s in seen) >= len(seen) - 1
    assert not any(judge(probe(second, first), s)["order"] for s in seen)


@pytest.mark.parametrize("seconds", [1.0, 3.0, 5.0])
def test_holds_are_seen(seconds: float) -> None:
    for name, side, where in (
        ("raise", "left", ""),
        ("t_pose", "both", ""),
        ("look", "", "left"),
        ("lean", "", "right"),
    ):
        probe = Probe("", name, FAMILIES[name].limb, side, None, where, hold_s=seconds)
        longer = Probe("", name, FAMILIES[name].limb, side, None, where, hold_s=seconds + 3)
        for seed in range(4):
            gesture = Gesture(name, side, direction=where, hold_s=seconds)
            clip = synthesise_spec(ClipSpec((gesture,)), np.random.default_rng(seed))
            assert clip is not None
            assert judge(probe, shown(clip.features))["hold"]
            assert not judge(longer, shown(clip.features))["hold"]


@pytest.mark.parametrize("name", ["wave", "clap", "nod", "shake_head", "punch"])
def test_slow_and_fast_are_told_apart(name: str) -> None:
    side = {"clap": "both", "wave": "right", "punch": "left"}.get(name, "")
    for tempo, word, other in ((0.65, "slow", "fast"), (1.4, "fast", "slow")):
        for seed in range(4):
            clip = synthesise_spec(ClipSpec((Gesture(name, side, 4, tempo=tempo),)), np.random.default_rng(seed))
            assert clip is not None
            limb = FAMILIES[name].limb
            assert judge(Probe("", name, limb, side, tempo=word), shown(clip.features))["tempo"]
            assert not judge(Probe("", name, limb, side, tempo=other), shown(clip.features))["tempo"]


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


def test_standing_still_and_the_mirror_image_fail_the_suite() -> None:
    stands = synthesise_spec(ClipSpec((Gesture("stand"),)), np.random.default_rng(0))
    assert stands is not None
    still = shown(stands.features)
    assert not any(all(judge(p, still, with_pose=True).values()) for p in PROBES)
    one_sided = [p for p in PROBES if p.side in ("left", "right") and p.then is None]
    assert not any(judge(p, shown(mirror(performed(p, i))))["side"] for i, p in enumerate(one_sided))


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
