"""A voice assistant's loop: sound in, gestures and stops out, and whoever speaks is listened to at once.

    python docs/examples/assistant.py docs/examples/heard.wav docs/examples/transcript.txt

beside `mmmd run`. Microphone, recogniser and speech are your libraries'. Here a recording stands in for the microphone, block by
block as sound comes, a threshold for the detector of voices, and a transcript, a line for each sentence, for the recogniser.

- Barge-in: as soon as somebody speaks while the robot moves, the motion is cancelled; the robot brakes, holds and listens.
- Each sentence is answered in a task of its own, so that the loop goes on listening while the robot moves.
- A stop word needs no special case: the daemon takes a text that means to stop as a stop (docs/wire/stop_words.md).
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import wave
from collections.abc import AsyncIterator
from pathlib import Path

from daemon.client import AsyncClient, CancelledByError, RefusedError
from daemon.settings.config import Endpoints

BLOCK_S = 0.02
LOUD = 4
"""Mean distance of 8-bit samples from silence, above which a block holds a voice."""
PAUSE_S = 0.3
"""Seconds of silence that end a sentence."""


async def microphone(recording: Path) -> AsyncIterator[bytes]:
    """The blocks of a recording (mono, 8 bits), each when it would have been heard; put your microphone here."""
    loop = asyncio.get_running_loop()
    with wave.open(str(recording)) as sound:
        n = round(BLOCK_S * sound.getframerate())
        next_s = loop.time()
        while block := sound.readframes(n):
            next_s += BLOCK_S
            await asyncio.sleep(max(0.0, next_s - loop.time()))
            yield block


async def heard(sound: AsyncIterator[bytes], sentences: list[str]) -> AsyncIterator[str | None]:
    """None when somebody begins to speak, then what was said; put your voice detector and your recogniser here."""
    recognised, silent_s, speaks = iter(sentences), 0.0, False
    async for block in sound:
        loud = sum(abs(sample - 128) for sample in block) / len(block) > LOUD
        silent_s = 0.0 if loud else silent_s + BLOCK_S
        if loud and not speaks:
            speaks = True
            yield None
        elif speaks and silent_s > PAUSE_S:
            speaks = False
            yield next(recognised)


async def answer(robot: AsyncClient, sentence: str) -> None:
    """Move as a sentence says, and print what a person should be told; put your speech here."""
    try:
        last = (await robot.say(sentence)).events[-1]
        told = getattr(last, "seen", "") or type(last).__name__.lower()
    except CancelledByError as error:
        told = str(error)
    except RefusedError as error:
        told = f"I cannot: {error.event.found}"
    print(f"{sentence!r}: {told}", flush=True)


async def main() -> None:
    """Answer every sentence as it is heard, and wait for the last answers."""
    default = Endpoints.of_environment()
    parser = argparse.ArgumentParser(description="a voice assistant's loop")
    parser.add_argument("recording", type=Path)
    parser.add_argument("transcript", type=Path)
    for name in ("cmd", "ctl", "pub"):
        parser.add_argument(f"--{name}", default=getattr(default, name))
    given = parser.parse_args()
    sentences = given.transcript.read_text("utf-8").splitlines()
    async with AsyncClient(Endpoints(given.cmd, given.ctl, given.pub)) as robot, asyncio.TaskGroup() as answers:
        async for sentence in heard(microphone(given.recording), sentences):
            if sentence is None:
                print("(listening)", flush=True)
                with contextlib.suppress(RefusedError):  # nothing is played that could be cancelled
                    await robot.cancel()
            else:
                answers.create_task(answer(robot, sentence))


if __name__ == "__main__":
    asyncio.run(main())
