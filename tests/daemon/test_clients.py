"""The asyncio client and the tools for language models, against a running daemon; the ROS example as far as that goes here."""

from __future__ import annotations

import asyncio
import contextlib
import io
import json
import subprocess
import sys
from pathlib import Path

import pytest

from daemon.async_client import AsyncClient
from daemon.client import CancelledByError, NoAnswerError, RefusedError
from daemon.config import Endpoints
from daemon.mcp import TOOLS, McpServer
from tests.end_to_end.harness import MMMD, RunningDaemon

pytestmark = pytest.mark.timeout(90)
EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"


@pytest.fixture(scope="module")
def running():
    daemon = RunningDaemon()
    try:
        yield daemon.until_ready()
        assert daemon.terminate() == 0
    finally:
        daemon.close()


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
            assert (await robot.gesture("nod", tempo=2.0)).done
            assert len((await robot.capabilities()).gestures) >= 60
            assert (await robot.look(10)).verb == "look" and (await robot.look()).note == ""
            assert (await robot.idle(False)).verb == "idle"

    asyncio.run(main())


def test_the_async_client_gives_up_in_time_where_nobody_is(tmp_path):
    async def main() -> None:
        ends = Endpoints(*(f"ipc://{tmp_path}/{n}" for n in ("a", "b", "c")))
        async with AsyncClient(ends, timeout_s=0.2) as robot:
            with pytest.raises(NoAnswerError, match="mmmd run"):
                await robot.status()

    asyncio.run(main())


def ask(server: McpServer, method: str, **parameters) -> dict:
    return server.answer(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": parameters}))


def test_a_language_model_can_say_look_and_stop(running):
    with running.client() as client:
        server = McpServer(client)
        client.arm()
        assert ask(server, "initialize", protocolVersion="2025-03-26")["result"]["protocolVersion"] == "2025-03-26"
        assert [t["name"] for t in ask(server, "tools/list")["result"]["tools"]] == [t["name"] for t in TOOLS]

        def call(name: str, /, **arguments) -> dict:
            return ask(server, "tools/call", name=name, arguments=arguments)["result"]

        assert "done" in call("say", text="wave", seconds=1.0)["content"][0]["text"]
        assert "nod" in call("gestures")["content"][0]["text"]
        assert not call("gesture", name="nod", tempo=2.0)["isError"]
        assert not call("look", yaw_deg=10)["isError"] and not call("look")["isError"]
        assert not call("stop")["isError"] and "reference" in call("status")["content"][0]["text"]
        refused = call("say", text="do a somersault")
        assert refused["isError"] and "legs" in refused["content"][0]["text"]
        assert call("say", text="wave", tempo=50)["isError"]  # the daemon's own bounds hold


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
def test_what_is_no_request_is_answered_with_its_error(running, line, code):
    with running.client() as client:
        assert McpServer(client).answer(line)["error"]["code"] == code


def test_notifications_get_no_answer_and_lines_are_answered_in_turn(running):
    with running.client() as client:
        out = io.StringIO()
        lines = ['{"method": "notifications/initialized"}', "", '{"id": 7, "method": "ping"}']
        McpServer(client).serve(io.StringIO("\n".join(lines) + "\n"), out)
        assert [json.loads(x) for x in out.getvalue().splitlines()] == [{"jsonrpc": "2.0", "id": 7, "result": {}}]


def test_the_command_serves_stdio(running):
    talk = '{"id": 1, "method": "tools/call", "params": {"name": "status"}}\n'
    result = subprocess.run(
        [*MMMD, "mcp", *running.at], input=talk, capture_output=True, text=True, timeout=30, check=False
    )
    assert result.returncode == 0 and "reference" in json.loads(result.stdout)["result"]["content"][0]["text"]


def test_the_ros_example_is_valid_python():
    """ROS is not installed here: only its syntax, and that what it takes from mmmd exists, is tested."""
    source = (EXAMPLES / "ros2_bridge.py").read_text()
    compile(source, "ros2_bridge.py", "exec")
    ours = "\n".join(line for line in source.splitlines() if line.startswith("from daemon"))
    assert subprocess.run([sys.executable, "-c", ours], check=False, timeout=30).returncode == 0
