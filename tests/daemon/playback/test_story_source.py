"""A story as stretches: what is asked of the generator and when, tempo over borders, losses, ends; poses that are met."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from daemon.generator.generated import Generated, GeneratorError
from daemon.playback.sources import story_source as story_score
from daemon.playback.sources.story_source import PIECES_AHEAD, StorySource
from daemon.poses.key_poses import KeyPose, led_through
from daemon.poses.pose_sequence import at_tempo, distance_deg, joined, posture_of, standing
from daemon.state.replies import NotPlayableError
from daemon.wire.requests import SceneOf, Story
from tests.support.kinematic import motion_of, raised_arm
from tests.support.sizes import few_and_long

MOTION = raised_arm("right", 1.0, 1.0)


class Teller:
    """Stands for the generator: remembers what it was asked; texts with "away" are left out, errors are raised in turn."""

    state = "ready"

    def __init__(self, *errors: GeneratorError, seconds: float = 1.0) -> None:
        self.asked: list[tuple[str | None, bytes, bool]] = []
        self.errors, self.seconds = list(errors), seconds

    async def scene(self, text, seed, seconds, told, timeout_s, *, last) -> Generated:
        await asyncio.sleep(0)
        if self.errors:
            raise self.errors.pop(0)
        self.asked.append((text, told, last))
        if text is not None and "away" in text:
            motion = motion_of(np.zeros((0, 22, 3)), text, "rejected", 0.2)
            return Generated(motion, "", "unknown", {}, "k", told)
        return Generated(raised_arm(text or "", self.seconds, 1.0), "u", "", {}, "k", str(len(self.asked)).encode())


def story(*texts: str, **options) -> Story:
    return Story(scenes=[SceneOf(text=t) for t in texts], **options)


async def tell(request: Story, teller: Teller, most: int = 100) -> tuple[StorySource, list, bool]:
    """Play up to `most` stretches."""
    score = StorySource(request, teller, 5.0)
    await score.begin()
    stretches = []
    for _ in range(most):
        while not score.ready:
            await asyncio.sleep(0.001)
        stretch, last = score.next()
        stretches.append(stretch)
        assert len(score._pieces) <= PIECES_AHEAD
        if last:
            return score, stretches, True
    return score, stretches, False


def lost(code: str = "generator_down") -> GeneratorError:
    return GeneratorError(code, "a scene", "killed", "", "")


def test_scenes_are_asked_in_order_each_with_what_was_told():
    teller = Teller()
    score, stretches, ended = asyncio.run(tell(story("a", "b", "c"), teller))
    assert teller.asked == [("a", b"", False), ("b", b"1", False), ("c", b"2", True)]
    assert ended and sum(map(len, stretches)) == 60
    assert [(n.scene, n.status) for n in score.reports(1)] == [(1, "accepted"), (2, "accepted"), (3, "accepted")]


def test_a_scene_may_refer_to_the_one_before_it():
    """The scene "again" was left out, and "slower" was a motion of its own; a scene that is lost is asked for as it was."""
    teller = Teller()
    score, _, _ = asyncio.run(tell(story("wave", "again", "slower", "now clap", "slower", repeat=2), teller))
    slow, clap = "exactly: wave (0.65 times as fast)", "now clap"
    once = ["wave", "exactly: wave", slow, clap, "exactly: clap (0.65 times as fast)"]
    assert [text for text, _, _ in teller.asked] == once * 2
    assert [news.text for news in score.reports(1)][:3] == ["wave", "again", "slower"]
    teller = Teller()

    async def lose_the_second() -> None:
        score = StorySource(story("wave", "slower", "slower"), teller, 5.0)
        assert score._in_full("wave", 0) == "wave"
        score._n_asked = 1
        assert [score._in_full("slower", 1) for _ in range(2)] == [slow] * 2

    asyncio.run(lose_the_second())


def test_repeats_go_round_the_whole_story_in_one_motion():
    teller = Teller()
    asyncio.run(tell(story("a", "b", repeat=3), teller))
    assert [t for t, _, _ in teller.asked] == list("ababab") and [x for _, _, x in teller.asked] == [False] * 5 + [True]


def test_a_loop_has_no_end_and_never_more_than_two_pieces_in_hand():
    teller = Teller()
    _, stretches, ended = asyncio.run(tell(story("a", "b", loop=True), teller, 50))
    assert not ended and len(stretches) == 50 and len(teller.asked) <= 50 + PIECES_AHEAD + 1


@pytest.mark.parametrize("told", [1, 2, 3, 4])
def test_a_loop_that_is_finished_ends_with_its_round(told):
    async def run() -> None:
        teller = Teller()
        score = StorySource(story("a", "b", loop=True), teller, 5.0)
        await score.begin()
        while len(teller.asked) < told:
            if score.ready and len(score._pieces) == PIECES_AHEAD:
                score.next()
            await asyncio.sleep(0.001)
        score.finish()
        last = False
        while not last:
            await asyncio.sleep(0.001)
            if score.ready:
                _, last = score.next()
        texts = [t for t, _, _ in teller.asked]
        assert len([t for t in texts if t]) % 2 == 0  # whole rounds
        assert teller.asked[-1][2] and not any(x for _, _, x in teller.asked[:-1])

    asyncio.run(run())


def test_short_scenes_are_joined_to_stretches_worth_playing():
    _, stretches, _ = asyncio.run(tell(story(*"abcdefgh"), Teller(seconds=0.2)))
    assert all(len(s) >= 16 for s in stretches[:-1]) and sum(map(len, stretches)) == 32


def test_what_is_left_out_is_told_and_the_rest_goes_on():
    score, stretches, ended = asyncio.run(tell(story("away", "b", "away", "d"), Teller()))
    assert ended and sum(map(len, stretches)) == 40
    assert [n.status for n in score.reports(1)] == ["rejected", "accepted", "rejected", "accepted"]


@pytest.mark.parametrize("options", [{}, {"loop": True}, {"repeat": 1000}], ids=str)
def test_a_story_of_nothing_that_can_be_done_is_empty_and_ends(options):
    async def run() -> None:
        score = StorySource(story("away", "away", **options), teller := Teller(), 5.0)
        news = await score.begin()
        assert score.empty and len(news) == 2 == len(teller.asked)

    asyncio.run(run())


@pytest.mark.parametrize("tempo", few_and_long([0.7], [0.5, 0.7, 1.3, 2.0]))
@given(sizes=st.lists(st.integers(4, 30), min_size=1, max_size=5))
def test_tempo_steps_over_the_borders_of_pieces_as_within(tempo, sizes):
    whole = joined([posture_of(raised_arm("r", n / 20, 1.0)) for n in sizes])
    resampler, at, parts = story_score._Tempo(tempo), 0, []
    for n in sizes:
        parts.append(resampler.of(whole[at : at + n]))
        at += n
    made = joined(parts)
    places = tempo * np.arange(len(made))
    assert len(made) == int((len(whole) - 1) / tempo + 1e-9) + 1
    whole_fast = whole.at(np.round(places).astype(int))
    exact = np.isclose(places, np.round(places))
    assert distance_deg(made, whole_fast)[exact].max() < 1e-3
    if tempo == 0.5:
        assert len(made) == pytest.approx(len(at_tempo(whole, tempo)), abs=1)


@pytest.mark.parametrize("code", ["generator_down", "generator_timeout"])
def test_a_generator_that_is_lost_and_comes_back_loses_no_scene(code, monkeypatch):
    monkeypatch.setattr(story_score, "RETRY_S", 0.001)
    monkeypatch.setattr(story_score, "AFTER_TIMEOUT_S", 0.001)

    async def run() -> None:
        teller = Teller()
        score = StorySource(story("a", "b", "c"), teller, 5.0)
        await score.begin()
        teller.errors = [lost(code)] * 5
        last = False
        while not last:
            await asyncio.sleep(0.001)
            if score.ready:
                _, last = score.next()
        assert [t for t, _, _ in teller.asked] == ["a", "b", "c"]

    asyncio.run(run())


@pytest.mark.parametrize(
    ("code", "patience_s"), [("generator_down", 0.0), ("generator_error", 30.0), ("bad_motion", 30.0)]
)
def test_what_does_not_come_back_ends_the_story_in_its_name(code, patience_s, monkeypatch):
    monkeypatch.setattr(story_score, "PATIENCE_S", patience_s)

    async def run() -> None:
        teller = Teller()
        score = StorySource(story("a", "b"), teller, 5.0)
        await score.begin()
        teller.errors = [lost(code)] * 1000
        assert len(score.next()[0]) == 20  # what was made is played
        while not score.ready:
            await asyncio.sleep(0.001)
        with pytest.raises(NotPlayableError) as caught:
            score.next()
        assert caught.value.event.code == code and "ready" in caught.value.event.found

    asyncio.run(run())


POSES = [posture_of(raised_arm("right", 1.0, a))[10:11] for a in (0.3, 1.1)]


@given(st.lists(st.floats(0, 3), min_size=1, max_size=4, unique=True), st.integers(0, 1))
@example([3.0, 2.9375], 0)  # at 20 fps 3 s are 60 frames: both are for the last of them
def test_poses_are_met_in_their_frame(at_s, which):
    keys = [KeyPose(t, POSES[(i + which) % 2]) for i, t in enumerate(sorted(at_s))]
    frames = [min(round(k.at_s * 20), 59) for k in keys]
    if len(set(frames)) < len(frames):
        return  # two in one frame cannot be asked for: the wire wants 0.2 s between them
    made = led_through(posture_of(raised_arm("left", 3.0, 0.6, "left")), keys)
    for key, frame in zip(keys, frames, strict=True):
        assert distance_deg(key.pose, made[frame : frame + 1])[0] < 0.01


def test_a_pose_changes_nothing_that_is_far_from_it():
    p = posture_of(raised_arm("left", 4.0, 0.6, "left"))
    made = led_through(p, [KeyPose(0.5, standing())])
    assert distance_deg(made[31:], p[31:]).max() < 1e-3
    assert distance_deg(made[1:], made[:-1]).max() < 20
