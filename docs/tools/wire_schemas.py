"""JSON schemas of the wire's messages, as files: `python -m docs.tools.wire_schemas docs/wire`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import msgspec

from daemon.wire.events import EVENTS
from daemon.wire.requests import REQUESTS


def schemas() -> dict[str, dict[str, Any]]:
    """File name -> JSON schema of every request and event."""
    found: dict[str, dict[str, Any]] = {}
    for kinds in (REQUESTS, EVENTS):
        for kind in kinds:
            schema = msgspec.json.schema(kind)
            schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
            found[f"{kind.__struct_config__.tag}.schema.json"] = schema
    return found


def text_of(schema: dict[str, Any]) -> str:
    """The file's text."""
    return json.dumps(schema, indent=2) + "\n"


def main(folder: Path) -> None:
    """Write all schemas into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, schema in schemas().items():
        (folder / name).write_text(text_of(schema), "utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/wire"))
