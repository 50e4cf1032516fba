"""The asyncio client and the tools for language models, against a running daemon; the ROS example as far as that goes here."""

from __future__ import annotations

import asyncio
import contextlib
import inspect
import io
import json
import os
import signal
import subprocess

import pytest

from daemon.client import AsyncClient, CancelledByError, Client, NoAnswerError, RefusedError
from daemon.client.mcp import TOOLS, McpServer
from daemon.settings.config import Endpoints
from tests.support.harness import MMMD, running_daemon

pytestmark = [pytest.mark.timeout(90), pytest.mark.realtime]


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    with running_daemon("--gestures", str(tmp_path_factory.mktemp("own"))) as daemon:
        yield daemon


def test_the_async_client_gives_up_in_time_where_nobody_is(tmp_path):
    async def main() -> None:
        ends = Endpoints(*(f"ipc://{tmp_path}/{n}" for n in ("a", "b", "c")))
        async with AsyncClient(ends, timeout_s=0.2) as robot:
            with pytest.raises(NoAnswerError, match="mmmd run"):
                await robot.status()

    asyncio.run(main())


def public_calls(kind: type) -> dict[str, list[str]]:
    """The calls of a client and the names of what each takes."""
    found = {name: call for name, call in inspect.getmembers(kind, inspect.isfunction) if name[0] != "_"}
    return {name: list(inspect.signature(call).parameters) for name, call in found.items()}


def test_both_clients_have_the_same_calls():
    assert public_calls(Client) == public_calls(AsyncClient)


@pytest.mark.long
def test_both_clients_go_on_after_a_restart_and_say_nothing_late(running):
    async def main() -> None:
        with Client(running.endpoints, timeout_s=1.0) as plain:
            async with AsyncClient(running.endpoints, timeout_s=1.0) as robot:
                assert plain.say("wave", seconds=0.8).done
                assert (await robot.say("wave", seconds=0.8)).done
                assert running.terminate() == 0
                for ask in (plain.status, lambda: plain.say("wave", seconds=0.8, timeout_s=1.0)):
                    with pytest.raises(NoAnswerError):
                        ask()
                for ask in (robot.status, lambda: robot.say("wave", seconds=0.8, timeout_s=1.0)):
                    with pytest.raises(NoAnswerError):
                        await ask()
                running.start()
                await asyncio.to_thread(running.until_ready)
                after = plain.wait_for("limp", timeout_s=10)
                assert after.command is None  # what nobody heard is not carried out later
                assert (await robot.wait_for("limp", timeout_s=10)).command is None
                assert plain.capabilities().robot == (await robot.capabilities()).robot == "reference"
                assert plain.status().state == (await robot.status()).state == "limp"
                assert plain.gesture("nod").done
                assert (await robot.gesture("nod")).done

    asyncio.run(main())


@pytest.mark.long
def test_the_async_client_says_stops_and_watches_at_once(running):
    async def main() -> None:
        async with AsyncClient(running.endpoints) as robot:
            await robot.arm()
            assert (await robot.say("wave", seconds=0.8)).done
            await robot.wait_for("idle", timeout_s=3)
            saying = asyncio.create_task(robot.say("wave", seconds=6.0))
            await robot.wait_for("moving", timeout_s=5)
            assert (await robot.status()).command is not None  # while the other call waits
            await robot.stop()
            with pytest.raises(CancelledByError, match="stop"):
                await saying
            async with contextlib.aclosing(robot.watch("v1/state")) as states:
                async for topic, state in states:
                    assert topic == "v1/state"
                    if state.state == "holding":
                        break
            with pytest.raises(RefusedError, match="legs"):
                await robot.say("do a somersault")
            assert (await robot.gesture("nod", tempo=2.0, command_id="mine")).id == "mine"
            assert "async_nod" in (await robot.record("async_nod", "mine")).note
            assert (await robot.gesture("async_nod")).done
            assert len((await robot.capabilities()).gestures) >= 60
            assert (await robot.look(10)).verb == "look" and (await robot.look()).note == ""
            assert (await robot.idle(False)).verb == "idle"

    asyncio.run(main())


def result_of(answer: dict) -> str:
    return answer["result"]["content"][0]["text"]


def calling(request_id: int, name: str, /, **arguments) -> bytes:
    params = {"name": name, "arguments": arguments}
    return json.dumps({"jsonrpc": "2.0", "id": request_id, "method": "tools/call", "params": params}).encode()


def test_a_language_model_can_say_look_and_stop(running):
    async def main() -> None:
        async with AsyncClient(running.endpoints) as client:
            server = McpServer(client)
            await client.arm()

            async def ask(method: str, **parameters) -> dict:
                return (await server.answer(json.dumps({"id": 1, "method": method, "params": parameters}).encode()))[
                    "result"
                ]

            async def call(name: str, /, **arguments) -> dict:
                return (await server.answer(calling(1, name, **arguments)))["result"]

            assert (await ask("initialize", protocolVersion="2025-03-26"))["protocolVersion"] == "2025-03-26"
            assert [t["name"] for t in (await ask("tools/list"))["tools"]] == [t["name"] for t in TOOLS]
            assert "done" in (await call("say", text="wave", seconds=1.0))["content"][0]["text"]
            assert "nod" in (await call("gestures"))["content"][0]["text"]
            assert not (await call("gesture", name="nod", tempo=2.0))["isError"]
            assert "done" in (await call("story", texts=["wave", "nod"]))["content"][0]["text"]
            assert (await call("story", texts="wave"))["isError"]
            assert not (await call("say", text="wave", seconds=9.0, wait=False))["isError"]
            assert not (await call("cancel"))["isError"] and (await client.status()).command is None
            assert not (await call("look", yaw_deg=10))["isError"] and not (await call("look"))["isError"]
            assert not (await call("stop"))["isError"] and "reference" in (await call("status"))["content"][0]["text"]
            refused = await call("say", text="do a somersault")
            assert refused["isError"] and "legs" in refused["content"][0]["text"]
            assert (await call("say", text="wave", tempo=50))["isError"]  # the daemon's own bounds hold

    asyncio.run(main())


@pytest.mark.parametrize("halt", ["stop", "estop"])
def test_a_halt_waits_for_no_text_and_ends_those_not_begun(running, halt):
    """Answered one after the other, a stop came when the motion was over."""

    async def main() -> None:
        async with AsyncClient(running.endpoints) as client:
            server, out = McpServer(client), io.StringIO()
            await client.reset()
            await client.arm()
            inlet, outlet = os.pipe()
            with os.fdopen(inlet, "rb") as source, os.fdopen(outlet, "wb", buffering=0) as host:
                serving = asyncio.create_task(server.serve(source, out))
                host.write(calling(1, "say", text="wave", seconds=9.0) + b"\n")
                while (now := await client.status()).command is None or now.state != "moving":
                    await asyncio.sleep(0.01)
                host.write(
                    b"\n".join([calling(2, "say", text="left wave"), calling(3, "status"), calling(4, halt)]) + b"\n"
                )
                host.close()
                await serving
            answers = {a["id"]: a for a in map(json.loads, out.getvalue().splitlines())}
            assert answers.keys() == {1, 2, 3, 4}
            assert [result_of(answers[n]) for n in (1, 2)] == [f"the command was cancelled by {halt}"] * 2
            assert "reference is" in result_of(answers[3]) and "moving" in result_of(answers[4])
            assert (await client.status()).command is None
            await client.reset()
            await client.arm()

    asyncio.run(main())


def test_the_word_stop_in_a_tool_call_waits_for_no_motion(running):
    """A voice assistant forwards it as a text: it waited for its turn, then the hand rose for a stop sign."""

    async def main() -> None:
        async with AsyncClient(running.endpoints) as client:
            server = McpServer(client)
            await client.reset()
            await client.arm()
            waving = asyncio.create_task(server.answer(calling(1, "say", text="wave", seconds=9.0)))
            while (now := await client.status()).command is None or now.state != "moving":
                await asyncio.sleep(0.01)
            assert "stopped" in result_of(await server.answer(calling(2, "say", text="please stop now")))
            assert "cancelled by stop" in result_of(await waving)
            assert (await client.status()).command is None

    asyncio.run(main())


def interrupted(running, n_signals: int) -> tuple[int, str]:
    """Exit status and errors of `mmmd say` after Ctrl-C in the middle of the motion."""
    say = [*MMMD, "say", "wave", "--seconds", "9", *running.at]
    process = subprocess.Popen(say, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stderr is not None
    while "first servo frame" not in (line := process.stdout.readline()):
        assert line, process.stderr.read()
    errors = ""
    for _ in range(n_signals):
        process.send_signal(signal.SIGINT)
        if not errors:
            errors += process.stderr.readline() + process.stderr.readline()
    errors += process.communicate(timeout=20)[1]
    return process.returncode, errors


def test_ctrl_c_cancels_what_was_said(running):
    """It ended the command line alone: the robot went on moving."""
    with running.armed() as robot:
        status, errors = interrupted(running, 1)
        assert status == 130 and "cancelling 'wave'" in errors and "mmmd: cancelled 'wave'" in errors
        assert robot.wait_for("holding", timeout_s=3).command is None


def test_a_second_ctrl_c_says_what_goes_on(running):
    """With a front that does not answer, the first one waits; the second one leaves."""
    with running.armed():
        say = [*MMMD, "say", "wave", "--seconds", "9", *running.at]
        process = subprocess.Popen(say, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert process.stdout is not None and process.stderr is not None
        while "first servo frame" not in (line := process.stdout.readline()):
            assert line, process.stderr.read()
        os.kill(running.process.pid, signal.SIGSTOP)
        try:
            process.send_signal(signal.SIGINT)
            assert process.stderr.readline() == "\n" and "cancelling" in process.stderr.readline()
            process.send_signal(signal.SIGINT)
            errors = process.communicate(timeout=20)[1]
        finally:
            os.kill(running.process.pid, signal.SIGCONT)
            process.kill()  # after a failure it would wait for a daemon that is gone
        assert process.returncode == 130 and "mmmd stop" in errors and "may go on" in errors


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("no json", -32700),
        ("[1]", -32600),
        ('{"id": 1}', -32600),
        ('{"id": 1, "method": "dance"}', -32601),
        ('{"id": 1, "method": "tools/call", "params": {"name": "arm"}}', -32602),
        ('{"id": 1, "method": "tools/call", "params": {"name": "say", "arguments": {}}}', -32602),
        ('{"id": 1, "method": "tools/call", "params": {"name": "say", "arguments": {"text": "a", "x": 1}}}', -32602),
    ],
)
def test_what_is_no_request_is_answered_with_its_error(line, code):
    async def main() -> None:
        async with AsyncClient() as client:
            assert (await McpServer(client).answer(line.encode()))["error"]["code"] == code

    asyncio.run(main())


def test_notifications_get_no_answer():
    async def main() -> None:
        async with AsyncClient() as client:
            out = io.StringIO()
            lines = ['{"method": "notifications/initialized"}', "", '{"id": 7, "method": "ping"}']
            await McpServer(client).serve(io.BytesIO(("\n".join(lines) + "\n").encode()), out)
            assert [json.loads(x) for x in out.getvalue().splitlines()] == [{"jsonrpc": "2.0", "id": 7, "result": {}}]

    asyncio.run(main())


@pytest.mark.long
def test_the_command_serves_stdio(running):
    talk = '{"id": 1, "method": "tools/call", "params": {"name": "status"}}\n'
    result = subprocess.run(
        [*MMMD, "mcp", *running.at], input=talk, capture_output=True, text=True, timeout=30, check=False
    )
    assert result.returncode == 0 and "reference" in json.loads(result.stdout)["result"]["content"][0]["text"]


def test_ctrl_c_in_a_verb_that_moves_stops_the_robot(running):
    """`mmmd arm` ended, and the robot went on to its rest pose without a word."""
    with running.client() as robot:
        robot.torque_off()
        arming = subprocess.Popen(
            [*MMMD, "arm", *running.at], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        robot.wait_for("arming", timeout_s=20)
        arming.send_signal(signal.SIGINT)
        out, errors = arming.communicate(timeout=20)
        assert arming.returncode == 130 and "arming is stopped" in errors, errors
        assert "stop: the robot was arming" in out
        assert robot.status().state in ("holding", "limp")
        robot.arm()
