"""Lines on the standard input of `mmmd mcp` that are no calls: each is one error, and the e-stop after them is carried out."""

from __future__ import annotations

import json
import subprocess

import pytest

from tests.support.harness import MMMD, running_daemon

pytestmark = [pytest.mark.timeout(120), pytest.mark.realtime]


@pytest.fixture(scope="module")
def running():
    with running_daemon() as daemon:
        yield daemon


def tool(name: bytes, arguments: bytes = b"{}", call_id: bytes = b"1") -> bytes:
    params = b'{"name": ' + name + b', "arguments": ' + arguments + b"}"
    return b'{"id": ' + call_id + b', "method": "tools/call", "params": ' + params + b"}"


DEEP = b"[" * 900 + b"]" * 900
ESTOP = tool(b'"estop"', call_id=b"99")
HOSTILE = {
    "an id of 5,000 digits": b'{"id": ' + b"9" * 5000 + b', "method": "ping"}',
    "an id of an array": b'{"id": [[1]], "method": "ping"}',
    "an id of deep arrays": b'{"id": ' + DEEP + b', "method": "ping"}',
    "an id beyond every float": b'{"id": 1e999, "method": "ping"}',
    "an id of 1,000 characters": b'{"id": "' + b"x" * 1000 + b'", "method": "ping"}',
    "half of a surrogate pair as id": b'{"id": "\\ud800", "method": "dance"}',
    "a method of deep arrays": b'{"id": 1, "method": ' + DEEP + b"}",
    "a method of 100 kB": b'{"id": 1, "method": "' + b"x" * 100_000 + b'"}',
    "arrays without end": b"[" * 100_000,
    "a byte that is not UTF-8": b'{"id": 1, "method": "\xff"}',
    "only such bytes": bytes(range(128, 256)),
    "a zero byte": b"\0",
    "two megabytes": b'{"id": 1, "method": "' + b"x" * 2_000_000 + b'"}',
    "repeat of 400 digits": tool(b'"say"', b'{"text": "wave", "repeat": ' + b"9" * 400 + b"}"),
    "a text of deep arrays": tool(b'"say"', b'{"text": ' + DEEP + b"}"),
    "a text of an object": tool(b'"say"', b'{"text": {"a": 1}}'),
    "half of a surrogate pair as text": tool(b'"say"', b'{"text": "\\ud800"}'),
    "a tool of deep arrays": tool(DEEP),
    "a tool of 100 kB": tool(b'"' + b"x" * 100_000 + b'"'),
    "4,000 unknown arguments": tool(b'"stop"', b"{" + b", ".join(b'"a%d": 1' % n for n in range(4000)) + b"}"),
}


def told(answer: dict) -> str:
    return answer["result"]["content"][0]["text"]


def test_no_line_keeps_a_language_model_from_its_estop(running):
    """An id of 5,000 digits ended the server; a byte that is not UTF-8 ended its reader: the e-stop after it was never read."""
    talk = b"".join(line + b"\n" for line in [*HOSTILE.values(), ESTOP])
    with running.armed():
        result = subprocess.run([*MMMD, "mcp", *running.at], input=talk, capture_output=True, timeout=60, check=False)
    answers = list(map(json.loads, result.stdout.splitlines()))
    assert result.returncode == 0 and b"Traceback" not in result.stderr
    assert len(answers) == len(HOSTILE) + 1
    assert all("error" in a or a["result"]["isError"] for a in answers if a["id"] != 99)
    assert all(len(json.dumps(a)) < 2000 for a in answers)
    assert "e-stop is latched" in told(next(a for a in answers if a["id"] == 99))
    with running.client() as robot:
        assert robot.status().state == "estop"
        robot.reset()


def test_a_host_that_reads_no_answer_does_not_delay_an_estop(running):
    """Answers were written by the loop that carries out calls: with 64 kB of them unread it stood still."""
    process = subprocess.Popen([*MMMD, "mcp", *running.at], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        assert process.stdin is not None
        process.stdin.write(b'{"id": 1, "method": "tools/list"}\n' * 200)
        process.stdin.flush()
        with running.armed() as robot:
            process.stdin.write(ESTOP + b"\n")
            process.stdin.flush()
            assert robot.wait_for("estop", timeout_s=30).state == "estop"
            robot.reset()
    finally:
        process.kill()
        process.communicate()


@pytest.mark.long
def test_more_motions_than_64_do_not_wait(running):
    """Each one that waits is memory; a stop ends all that wait."""
    says = b"".join(tool(b'"say"', b'{"text": "wave", "seconds": 9}', b"%d" % n) + b"\n" for n in range(200))
    with running.armed():
        process = subprocess.Popen([*MMMD, "mcp", *running.at], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        out, _ = process.communicate(says + tool(b'"stop"', call_id=b"99") + b"\n", timeout=60)
    texts = [told(json.loads(line)) for line in out.splitlines()]
    assert len(texts) == 201 and sum("motions wait already" in text for text in texts) >= 200 - 65
