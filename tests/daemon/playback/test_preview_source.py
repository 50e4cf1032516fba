"""A draft, until the motion comes: before it is played, while it is, after it, or never."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import numpy as np

from daemon.generator.generated import Generated
from daemon.playback.sources.preview_source import HEAD_FRAMES, PreviewSource, still_frames, without_stillness
from daemon.poses.pose_sequence import PoseSequence, joined, posture_of
from mmm_core.motion.motion import Motion
from tests.support.kinematic import raised_arm

LONG = raised_arm(seconds=4.0, angle_rad=0.6)
LONGER = raised_arm(seconds=5.0, angle_rad=1.2)
DRAFT, WHOLE = raised_arm(seconds=1.0, angle_rad=0.6), raised_arm(seconds=2.0, angle_rad=1.2)
STILL, LONG_STILL = still_frames(posture_of(DRAFT)), still_frames(posture_of(LONG))


async def score_of(draft: Motion = DRAFT) -> tuple[PreviewSource, Callable[..., Awaitable[None]]]:
    """A score, and what lets its motion come, or an error."""
    comes: asyncio.Future[Generated] = asyncio.get_running_loop().create_future()

    async def wait() -> Generated:
        return await comes

    whole = asyncio.create_task(wait())

    async def come(error: Exception | None = None, motion: Motion = WHOLE) -> None:
        if error is None:
            comes.set_result(Generated(motion, "", "", {}, ""))
        else:
            comes.set_exception(error)
        await asyncio.wait({whole})

    return PreviewSource(posture_of(draft), whole, lambda generated: posture_of(generated.motion)), come


def same(a: PoseSequence, b: PoseSequence) -> bool:
    return np.array_equal(a.bones, b.bones)


def test_a_motion_that_is_there_in_time_is_played_alone():
    async def run():
        score, come = await score_of()
        assert score.ready and not score.revised
        await come()
        stretch, last = score.next()
        assert last and same(stretch, posture_of(WHOLE)[STILL:]) and not score.revised

    asyncio.run(run())


def test_a_motion_that_comes_while_the_draft_is_played_takes_its_place():
    async def run():
        score, come = await score_of()
        stretch, last = score.next()
        assert not last and same(stretch, posture_of(DRAFT)[STILL:])
        assert not score.ready and not score.revised
        await come()
        assert score.ready and score.revised
        assert same(score.rest(n_left=len(DRAFT.joints_m) - 5), posture_of(WHOLE)[5:])

    asyncio.run(run())


def test_a_motion_that_comes_after_the_draft_goes_on_from_there():
    async def run():
        score, come = await score_of()
        score.next()
        await come()
        stretch, last = score.next()
        assert last and same(stretch, posture_of(WHOLE)[len(DRAFT.joints_m) :])

    asyncio.run(run())


def test_without_a_motion_the_draft_is_all():
    async def run():
        score, come = await score_of()
        score.next()
        await come(ValueError("the generator was killed"))
        assert score.ready and not score.revised
        stretch, last = score.next()
        assert last and same(stretch, posture_of(DRAFT).at(np.full(2, len(DRAFT.joints_m) - 1)))

    asyncio.run(run())


def test_a_long_draft_yields_its_first_frames_first():
    async def run():
        score, come = await score_of(LONG)
        draft = posture_of(LONG)
        head, last = score.next()
        assert not last and same(head, draft[LONG_STILL:][:HEAD_FRAMES]) and score.ready
        others, last = score.next()
        assert not last and same(others, draft[LONG_STILL + HEAD_FRAMES :]) and not score.ready
        await come(motion=LONGER)
        assert score.revised and same(score.rest(n_left=10), posture_of(LONGER)[len(draft) - 10 :])
        rest, last = score.next()
        assert last and same(rest, posture_of(LONGER)[len(draft) :])

    asyncio.run(run())


def test_a_motion_goes_on_from_the_first_frames_of_a_long_draft():
    async def run():
        score, come = await score_of(LONG)
        score.next()
        await come(motion=LONGER)
        assert score.revised and same(score.rest(n_left=HEAD_FRAMES - 3), posture_of(LONGER)[LONG_STILL + 3 :])
        rest, last = score.next()
        assert last and same(rest, posture_of(LONGER)[LONG_STILL + HEAD_FRAMES :])

    asyncio.run(run())


def test_without_a_motion_a_long_draft_is_played_to_its_end():
    async def run():
        score, come = await score_of(LONG)
        score.next()
        await come(ValueError("the generator was killed"))
        rest, last = score.next()
        assert last and same(rest, posture_of(LONG)[LONG_STILL + HEAD_FRAMES :])

    asyncio.run(run())


def test_frames_before_the_person_moves_are_left_out():
    moving = posture_of(raised_arm(seconds=2.0, angle_rad=1.2))
    standing = moving.at(np.zeros(20, np.intp))
    for n_standing, left_out in ((0, 0), (1, 0), (2, 1), (10, 3)):  # the last frame of standing stays
        whole = joined([standing[:n_standing], moving[10:]])  # moves 3 degrees and more from one frame to the next
        assert still_frames(whole) == left_out, n_standing
    assert still_frames(standing) == 3 and len(without_stillness(standing)) == 17
    assert still_frames(standing[:1]) == 0 and len(without_stillness(standing[:1])) == 1
