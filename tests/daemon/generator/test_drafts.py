"""Drafts: each comes before its motion, and neither keeps the others waiting."""

from __future__ import annotations

import asyncio

import pytest

from daemon.generator.generated import Generated, GeneratorError, generated_from, generated_message
from daemon.generator.process import MOST_BEGUN
from tests.support.generator_client import ask
from tests.support.kinematic import KinematicGenerator, raised_arm

pytestmark = pytest.mark.realtime


def test_a_draft_comes_before_its_motion(endpoint):
    peer = KinematicGenerator(endpoint)

    async def call(client):
        first, whole = await client.draft("drafted wave", 0, 2.0, 5.0)
        assert client.busy and first.draft_of == 40 and len(first.motion.joints_m) == 20
        motion = (await whole).motion
        assert not client.busy and len(motion.joints_m) == 40
        alone, nothing = await client.draft("wave", 0, 2.0, 5.0)
        assert nothing is None and not alone.draft_of and not client.busy

    try:
        ask(endpoint, call)
    finally:
        peer.close()


def test_the_drafts_of_several_texts_come_before_their_motions(endpoint):
    peer = KinematicGenerator(endpoint)
    came = []

    async def one(client, text):
        first, whole = await client.draft(text, 0, 1.0, 20.0)
        came.append((first.motion.text, "draft"))
        came.append(((await whole).motion.text, "whole"))

    async def call(client):
        await client.draft("slow, so that the others wait together", 0, 1.0, 5.0)
        texts = [f"drafted {i}" for i in range(3)]
        await asyncio.gather(client.generate("slow", 0, 1.0, 5.0), *(one(client, text) for text in texts))
        return texts

    try:
        texts = ask(endpoint, call)
    finally:
        peer.close()
    assert came == [(text, "draft") for text in texts] + [(text, "whole") for text in texts]


@pytest.mark.long
def test_many_drafts_do_not_starve_the_motions(endpoint):
    """When many texts come at once, the first motions are made before the last drafts."""
    peer = KinematicGenerator(endpoint)
    came = []

    async def one(client, i):
        _, whole = await client.draft(f"drafted {i}", 0, 1.0, 20.0)
        came.append(("draft", i))
        await whole
        came.append(("whole", i))

    async def call(client):
        await asyncio.gather(*(one(client, i) for i in range(MOST_BEGUN + 2)))

    try:
        ask(endpoint, call)
    finally:
        peer.close()
    # Draft 8 is sent with motion 0, half a second before draft 9: asyncio may wake their askers in any order.
    assert came.index(("whole", 0)) < came.index(("draft", MOST_BEGUN + 1))


@pytest.mark.parametrize(
    ("end", "code"),
    [
        (lambda client: None, "generator_error"),
        (lambda client: client.mark_down("ended with status 1"), "generator_down"),
        (lambda client: client.mark_starting(), "generator_down"),
    ],
)
def test_a_motion_that_never_follows_its_draft_is_a_named_failure(endpoint, end, code):
    peer = KinematicGenerator(endpoint)

    async def call(client):
        first, whole = await client.draft(
            "drafted wave, lost" if code == "generator_error" else "drafted wave", 0, 2.0, 5.0
        )
        end(client)
        with pytest.raises(GeneratorError) as caught:
            await whole
        assert first.draft_of and not client.busy
        return caught.value

    try:
        assert ask(endpoint, call).code == code
    finally:
        peer.close()


def test_a_draft_that_nobody_asked_for_is_no_motion():
    reply = generated_message(1, Generated(raised_arm(), "", "", {}, "", draft_of=20))
    with pytest.raises(GeneratorError, match="nobody asked for"):
        generated_from(reply)
    assert generated_from(reply, may_be_draft=True).draft_of == 20
