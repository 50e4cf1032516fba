"""The front stands a generator that is silent, down, restarted or loading, and answers that come out of order."""

from __future__ import annotations

import asyncio

import pytest

from daemon.generator import client as client_module
from daemon.generator.generated import GeneratorError
from tests.support.generator_client import ask
from tests.support.kinematic import KinematicGenerator

pytestmark = pytest.mark.realtime


def test_a_generator_that_is_silent_is_a_named_failure(endpoint):
    async def call(client):
        with pytest.raises(GeneratorError) as caught:
            await client.generate("wave", 0, None, 0.1)
        assert client.timeouts == 1 and not client.busy
        return caught.value

    assert ask(endpoint, call).code == "generator_timeout"


def test_a_restarted_generator_is_not_blamed_for_its_predecessor(endpoint):
    """It was killed right after its start: the supervisor restarts a generator that leaves a text unanswered."""

    async def call(client):
        asking = asyncio.create_task(client.generate("wave", 0, None, 0.2))
        await asyncio.sleep(0.05)
        client.mark_starting()
        client.mark_ready("k")
        with pytest.raises(GeneratorError):
            await asking
        return client.timeouts

    assert ask(endpoint, call) == 0


@pytest.mark.parametrize("lose", [lambda c: c.mark_down("ended with status -9"), lambda c: c.mark_starting()])
def test_an_open_request_fails_at_once_when_its_generator_ends(endpoint, lose):
    """It waited for its whole time-out, some seconds in which the robot stood still and nobody was told why."""

    async def call(client):
        asking = asyncio.create_task(client.generate("wave", 0, None, 60.0))
        async with asyncio.timeout(10.0):
            while not client.busy:
                await asyncio.sleep(0)
            lose(client)
            with pytest.raises(GeneratorError) as caught:
                await asking
        assert client.timeouts == 0 and not client.busy
        return caught.value

    assert ask(endpoint, call).code == "generator_down"


def test_a_silent_generator_elsewhere_may_still_answer_what_is_open(endpoint):
    peer = KinematicGenerator(endpoint)

    async def call(client):
        asking = asyncio.create_task(client.generate("wave", 0, None, 20.0))
        async with asyncio.timeout(10.0):
            while not client.busy:
                await asyncio.sleep(0)
        client.mark_down("no answer", ended=False)
        return await asking

    try:
        assert len(ask(endpoint, call).motion.joints_m)
    finally:
        peer.close()


def test_a_generator_that_is_down_fails_at_once(endpoint):
    async def call(client):
        client.mark_down("ended with status 1")
        with pytest.raises(GeneratorError, match="ended with status 1") as caught:
            await client.generate("wave", 0, None, 5.0)
        return caught.value

    assert ask(endpoint, call).code == "generator_down"


def test_a_text_that_comes_while_the_model_loads_is_told_to_come_again(endpoint, monkeypatch):
    """The refusal said that the generator is "starting" and named the daemon's output, where nothing is wrong."""
    monkeypatch.setattr(client_module, "START_TIMEOUT_S", 0.2)

    async def call(client):
        client.mark_starting()
        with pytest.raises(GeneratorError) as caught:
            await client.generate("wave", 0, None, 5.0)
        return caught.value

    error = ask(endpoint, call)
    assert error.code == "generator_down"
    assert "has been loading for 0 s" in error.found and error.do.startswith("send it again in some seconds")


def test_answers_reach_the_right_asker_in_any_order(endpoint):
    peer = KinematicGenerator(endpoint)

    async def call(client):
        return await asyncio.gather(
            *(client.generate(t, 0, None, 5.0) for t in ("wave", "slow left", "left", "wave 2"))
        )

    try:
        assert [g.motion.text for g in ask(endpoint, call)] == ["wave", "slow left", "left", "wave 2"]
    finally:
        peer.close()
