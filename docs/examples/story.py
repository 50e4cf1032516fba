"""A story of several scenes as one motion, with what became of each scene: `python docs/examples/story.py`, beside `mmmd run`.

The robot moves with the first scene while the generator makes the later ones; a scene that it cannot show is left out and named.
Ctrl-C ends the story: the robot brakes and holds.
"""

from __future__ import annotations

import argparse
import uuid

from daemon.client import Client
from daemon.settings.config import Endpoints
from daemon.wire.events import Done, Progress, Refusal
from daemon.wire.requests import SceneOf, Story

SCENES = [
    SceneOf(text="stretch both arms up", seconds=2.0),  # she wakes up
    SceneOf(text="wave with your right hand"),  # greets the sun
    SceneOf(text="do a somersault"),  # which no upper body can show
    SceneOf(text="clap your hands twice"),
    SceneOf(text="bow", seconds=2.0),
]


def main() -> int:
    """Tell the story; 0 when it was played to its end."""
    default = Endpoints.of_environment()
    parser = argparse.ArgumentParser(description="a story of several scenes")
    for name in ("cmd", "ctl", "pub"):
        parser.add_argument(f"--{name}", default=getattr(default, name))
    given = parser.parse_args()
    story = Story(id=uuid.uuid4().hex, scenes=SCENES)
    with Client(Endpoints(given.cmd, given.ctl, given.pub)) as robot:
        try:
            for event in robot.events_of(story):
                if isinstance(event, Progress) and event.scene is not None:
                    shown = f"left out, {event.reason}" if event.status == "rejected" else event.understood
                    print(f"{event.scene}. {event.text}: {shown}", flush=True)
                elif isinstance(event, Done):
                    print(f"the end, after {event.duration_s:.1f} s")
                    return 0
                elif isinstance(event, Refusal):
                    print(event.message)
        except KeyboardInterrupt:
            robot.cancel(story.id)
    return 1


if __name__ == "__main__":
    raise SystemExit(main())
