"""Words for a mood become tempo and posture of the motion; where they are part of a gesture's name they stay."""

from __future__ import annotations

import numpy as np
import pytest

from mmm_core.generate.engine import Engine
from mmm_core.language.commands import exactly
from mmm_core.language.manner import manner_of
from mmm_core.language.moods import MOODS, mood_of
from mmm_core.language.reading import read
from mmm_core.motion.motion import Motion
from mmm_core.motion.posture_features import posture_features
from tests.support.sizes import few_and_long


@pytest.mark.parametrize(
    ("clause", "rest", "mood"),
    [
        ("wave sadly", "wave", "sad"), ("wave, very happily", "wave", "happy"), ("sadly, wave", "wave", "sad"),
        ("bow to the queen proudly", "bow to the queen", "proud"), ("knock twice, a bit nervously", "knock twice", "shy"),
        ("shake your head sadly", "shake your head", "sad"), ("nod like a machine", "nod", "stiff"),
        ("cheer with joy", "cheer", "happy"),
    ],
)  # fmt: skip
def test_a_mood_is_taken_out(clause: str, rest: str, mood: str) -> None:
    assert mood_of(clause) == (rest, mood)
    assert manner_of(clause)[1].tempo == pytest.approx(MOODS[mood].tempo)


@pytest.mark.parametrize(
    "clause",
    [
        "wave", "dance mechanically", "move your arms stiffly like a robot", "go crazy with joy", "stand nervously", "slump sadly",
        "be beside yourself with joy", "jump with joy", "sadly", "with joy", "like a machine gun's rattle", "the sad clown waves",
    ],
)  # fmt: skip
def test_a_gesture_of_its_own_keeps_its_mood(clause: str) -> None:
    assert mood_of(clause) == (clause, "")


def test_tempo_and_mood_multiply_and_belong_to_one_command() -> None:
    (wave,), (bow,) = read("wave slowly and sadly, then bow").steps
    assert wave.manner.mood == "sad" and wave.manner.tempo == pytest.approx(0.5), (
        "0.62 times 0.72, but no slower than half"
    )
    assert bow.manner.plain
    assert read(exactly([[wave], [bow]])).sentences == read("wave slowly and sadly, then bow").sentences


def pitches_deg(motion: Motion) -> np.ndarray:
    """(T, 2) pitch of trunk and head in the world, degrees."""
    s = posture_features(motion.joints_m, motion.head_quat_wxyz, motion.forearm_twist_rad)
    return np.stack([s.trunk_pitch_deg, s.trunk_pitch_deg + s.head_pitch_deg], -1)


@pytest.mark.parametrize(
    ("word", "mood"), few_and_long([("sadly", "sad")], [("proudly", "proud"), ("shyly", "shy"), ("happily", "happy")])
)
def test_a_mood_is_shown_by_trunk_head_and_tempo(engine: Engine, word: str, mood: str) -> None:
    plain, moody = (engine.generate(text).motion for text in ("wave your right hand", f"wave your right hand {word}"))
    more = pitches_deg(moody).mean(0) - pitches_deg(plain).mean(0)
    asked = np.rad2deg([MOODS[mood].trunk_pitch_rad, MOODS[mood].trunk_pitch_rad + MOODS[mood].head_pitch_rad])
    np.testing.assert_allclose(more, asked, atol=1.5)
    assert len(moody.joints_m) == pytest.approx(len(plain.joints_m) / MOODS[mood].tempo, abs=1)


def test_a_mood_of_one_command_does_not_bend_its_neighbours(engine: Engine) -> None:
    made = engine.generate("nod, then wave your right hand sadly, then nod")
    first, second, _ = (round(scene.end_s * 20) for scene in made.scenes)
    trunk = pitches_deg(made.motion)[:, 0]
    assert trunk[first + 12 : second - 8].mean() > trunk[: first - 2].mean() + 4
    assert abs(trunk[second + 14 :].mean() - trunk[: first - 2].mean()) < 2.5
    assert np.abs(np.diff(trunk)).max() < 4, "no jump"
