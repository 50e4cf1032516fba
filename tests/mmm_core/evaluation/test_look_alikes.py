"""The checks tell two gestures apart that look alike: a held out fist shows no handshake, and a handshake shows one."""

from __future__ import annotations

import pytest

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.heldout import Command, Sentence
from mmm_core.evaluation.sentences import judge_sentence, shows_as_usual
from mmm_core.generate.engine import Engine
from mmm_core.motion.posture_features import PostureFeatures, posture_features
from mmm_core.recognition.checks import count

PAIRS = [
    ("hold out your right fist for a bump", "fist_bump", "shake my hand", "handshake"),
    ("hold out your left fist for a bump", "fist_bump", "punch with your left fist", "punch"),
    ("punch with your right fist", "punch", "throw a right hook", "hook"),
    ("make a stop sign", "stop", "do a karate chop", "karate_chop"),
    ("cover your eyes with both hands", "cover_eyes", "put your hand over your mouth", "cover_mouth"),
    ("lean forward", "lean", "bow", "bow"),
]


@pytest.mark.parametrize(("text", "family", "denied_text", "denied"), PAIRS)
def test_a_denied_look_alike_is_seen_where_it_is_done_alone(
    engine: Engine, text: str, family: str, denied_text: str, denied: str
) -> None:
    sentence = Sentence(text, "denial", ((Command(family, FAMILIES[family].limb),),), denied=(denied,))
    assert judge_sentence(sentence, _shown(engine, text))["denial"]
    done = _shown(engine, denied_text)
    assert shows_as_usual(done, denied)
    assert not judge_sentence(sentence, done)["denial"]


def test_a_deep_breath_may_bend_the_trunk(engine: Engine) -> None:
    sentence = Sentence("breathe, do not yawn", "denial", ((Command("breathe", ""),),), denied=("yawn",))
    assert judge_sentence(sentence, _shown(engine, "breathe deeply"))["denial"]
    assert not judge_sentence(sentence, _shown(engine, "bow"))["denial"]
    assert not judge_sentence(sentence, _shown(engine, "yawn"))["denial"]


def test_a_slow_wave_has_as_many_strokes_as_a_plain_one(engine: Engine) -> None:
    assert [count(_shown(engine, text), "wave") for text in ("wave twice", "wave twice, very slowly")] == [2, 2]


def _shown(engine: Engine, text: str) -> PostureFeatures:
    motion = engine.generate(text, seed=0).motion
    return posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
