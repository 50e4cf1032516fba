"""A language model with the robot as its tools: `python docs/examples/language_model.py`, beside `mmmd run`.

It needs the official SDK of MCP, `pip install 'mmmd[mcp]'`. The model is yours: it gets the instructions and the tools of `mmmd
mcp`, as every model's library takes them. Recorded turns stand in for it: what a person says, and which tool a model called.

Two rules keep it safe. A person's stop does not wait for the model: this program calls `stop` itself, whatever is under way. And
the model tells the person a tool's result, which is what was seen on the robot, not what was asked of it.
"""

from __future__ import annotations

import argparse
import asyncio
import sys
from dataclasses import dataclass
from typing import Any

from mcp import Client, StdioServerParameters, Tool, stdio_client

RECORDED: list[tuple[str, str, dict[str, Any]]] = [
    ("Greet our visitors, please.", "say", {"text": "wave with your right hand"}),
    ("Walk to the door and do a somersault.", "say", {"text": "do a somersault"}),
    ("Which gestures do you know?", "gestures", {}),
    ("Then dance for us!", "story", {"texts": ["clap your hands", "raise both arms", "wave"] * 3, "tempo": 0.5}),
    ("Stop!", "", {}),
]


@dataclass
class RecordedModel:
    """Stands in for a language model.

    Attributes:
        instructions: for the model's system prompt.
        tools: with a name, a description and a JSON schema each.
    """

    instructions: str
    tools: list[Tool]

    def decide(self, sentence: str) -> tuple[str, dict[str, Any]]:
        """The tool and the arguments that a model answers a sentence with; put your model here."""
        name, arguments = next((name, arguments) for said, name, arguments in RECORDED if said == sentence)
        schema = next(tool.input_schema for tool in self.tools if tool.name == name)
        assert arguments.keys() <= schema["properties"].keys(), f"{name} takes {schema['properties'].keys()}"
        return name, arguments


async def call(robot: Client, name: str, arguments: dict[str, Any]) -> None:
    """Call a tool and print its result, which the model gets to read."""
    result = await robot.call_tool(name, arguments)
    text = " ".join(part.text for part in result.content if part.type == "text")
    print(f"{name} {'refused' if result.is_error else 'answers'}: {text}", flush=True)


async def main() -> None:
    """Let the recorded model answer each sentence of a person."""
    parser = argparse.ArgumentParser(description="a language model with the robot as its tools")
    for name in ("cmd", "ctl", "pub"):
        parser.add_argument(f"--{name}", default="")
    given = parser.parse_args()
    at = [word for name, endpoint in vars(given).items() if endpoint for word in (f"--{name}", endpoint)]
    server = StdioServerParameters(command=sys.executable, args=["-m", "daemon.cli", "mcp", *at])
    async with Client(stdio_client(server)) as robot, asyncio.TaskGroup() as calls:
        model = RecordedModel(robot.instructions or "", (await robot.list_tools()).tools)
        print(f"tools: {', '.join(tool.name for tool in model.tools)}")
        for sentence, _, _ in RECORDED:
            print(f"person: {sentence}", flush=True)
            if sentence.casefold().strip(" .!") == "stop":
                await call(robot, "stop", {})
                continue
            name, arguments = model.decide(sentence)
            task = calls.create_task(call(robot, name, arguments))
            await asyncio.wait([task], timeout=8.0)  # a person goes on talking, whether the robot still moves or not


if __name__ == "__main__":
    asyncio.run(main())
