"""Texts, an interruption and a stop by WebSocket: `mmmd run --http 127.0.0.1:5880`, then `python docs/examples/hello_websocket.py`.

It needs `pip install tornado` alone; the messages are the same with any other WebSocket library. One socket of `/v1/cmd` takes any
number of texts and gets all their events, each with the `id` of its text. The stop has a socket of its own and waits for no text.
"""

from __future__ import annotations

import asyncio
import json
import sys
from typing import Any

from tornado.websocket import WebSocketClientConnection, websocket_connect


async def say(cmd: WebSocketClientConnection, name: str, text: str, **options: object) -> None:
    """Send a text under an id of our own."""
    await cmd.write_message(json.dumps({"type": "say", "id": name, "text": text, **options}))


async def heard(socket: WebSocketClientConnection, name: str, *kinds: str) -> dict[str, Any]:
    """Print events until one of `kinds` comes for the text `name`; a refusal ends the program."""
    while (message := await socket.read_message()) is not None:
        event = json.loads(message)
        print(
            event["id"], event["type"], event.get("understood") or event.get("by") or event.get("stage", ""), flush=True
        )
        if event["id"] != name:
            continue
        if event["type"] in kinds or event.get("stage") in kinds:
            return event
        if event["type"] in ("rejected", "failed", "error"):
            raise SystemExit(f"{event['found']}; {event['do']}")
    raise SystemExit("the daemon has closed the connection")


async def main(at: str) -> None:
    """Clap until a wave interrupts it, then clap until a stop."""
    cmd, ctl = [await websocket_connect(f"{at}/v1/{kind}") for kind in ("cmd", "ctl")]
    await say(cmd, "clap", "clap your hands", loop=True)
    await heard(cmd, "clap", "moving")
    await say(cmd, "wave", "wave with your right hand")  # takes over: the clapping ends in `cancelled`
    await heard(cmd, "wave", "done")
    await say(cmd, "again", "clap your hands", loop=True)
    await heard(cmd, "again", "moving")
    await ctl.write_message(json.dumps({"type": "stop", "id": "halt"}))
    await heard(ctl, "halt", "ack")
    await heard(cmd, "again", "cancelled")


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1] if len(sys.argv) > 1 else "ws://127.0.0.1:5880"))
