"""A voice assistant's loop: recognised sentences in, gestures and stops out, a new sentence interrupts the one before.

Microphone, recognition and speech are your libraries'; here lines of text stand in for what they recognise, each with the second at
which it was heard: `python docs/examples/assistant.py docs/examples/transcript.txt`, beside `mmmd run`.

Each sentence is sent as it comes, in a task of its own, so that the loop hears the next one while the robot moves. A stop word
needs no special case: the daemon takes a text that means to stop as a stop (docs/wire/stop_words.md).
"""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

from daemon.client import AsyncClient, CancelledByError, RefusedError
from daemon.settings.config import Endpoints


async def heard(transcript: Path) -> AsyncIterator[str]:
    """The sentences of a transcript ("SECONDS TEXT" a line), each at its time; put your recogniser here."""
    loop = asyncio.get_running_loop()
    began_s = loop.time()
    for line in transcript.read_text("utf-8").splitlines():
        at_s, _, sentence = line.partition(" ")
        await asyncio.sleep(max(0.0, began_s + float(at_s) - loop.time()))
        yield sentence


async def answer(robot: AsyncClient, sentence: str) -> None:
    """Move as a sentence says, and print what a person should be told; put your speech here."""
    try:
        said = await robot.say(sentence)
        told = type(said.events[-1]).__name__.lower()
    except CancelledByError as error:
        told = str(error)
    except RefusedError as error:
        told = f"I cannot: {error.event.found}"
    print(f"{sentence!r}: {told}", flush=True)


async def main() -> None:
    """Answer every sentence as it is heard, and wait for the last answers."""
    default = Endpoints()
    parser = argparse.ArgumentParser(description="a voice assistant's loop")
    parser.add_argument("transcript", type=Path)
    for name in ("cmd", "ctl", "pub"):
        parser.add_argument(f"--{name}", default=getattr(default, name))
    given = parser.parse_args()
    async with AsyncClient(Endpoints(given.cmd, given.ctl, given.pub)) as robot, asyncio.TaskGroup() as answers:
        async for sentence in heard(given.transcript):
            answers.create_task(answer(robot, sentence))


if __name__ == "__main__":
    asyncio.run(main())
