"""What docs/examples/ros2 takes of ROS 2, which Debian does not have: enough to run the bridge's own code against a real daemon.

It stands in for rclpy, for the message types, and for the classes that ROS makes of `Say.action`, with the file's fields.
It does not model: middleware, executors, quality of service, types of fields, time.
"""

from __future__ import annotations

import logging
import re
import sys
import threading
import types
import uuid
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest


class Message:
    """A message of known fields; another one is refused, as by the classes that ROS makes."""

    fields: tuple[str, ...] = ()

    def __init__(self, **given: Any) -> None:
        self.__dict__.update({name: SimpleNamespace() if name == "header" else None for name in self.fields})
        for name, value in given.items():
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        assert name in self.fields, f"{type(self).__name__} has no field {name}: {self.fields}"
        super().__setattr__(name, value)


def message(name: str, *fields: str) -> type[Message]:
    return type(name, (Message,), {"fields": fields})


def action_of(file: Path) -> SimpleNamespace:
    """Goal, Result and Feedback of an .action file."""
    parts = re.sub(r"#.*", "", file.read_text()).split("---")
    names = [tuple(line.split()[1] for line in part.splitlines() if line.strip()) for part in parts]
    return SimpleNamespace(**{k: message(k, *n) for k, n in zip(("Goal", "Result", "Feedback"), names, strict=True)})


@dataclass
class Goal:
    """A goal that is being carried out.

    Attributes:
        request: what is asked.
        feedback: what was sent back meanwhile.
        outcome: succeed, canceled or abort, once it has ended.
        is_cancel_requested: whether its client wants it ended.
    """

    request: Message
    feedback: list[Message] = field(default_factory=list)
    outcome: str = ""
    is_cancel_requested: bool = False
    goal_id: Any = field(default_factory=lambda: SimpleNamespace(uuid=list(uuid.uuid4().bytes)))

    def publish_feedback(self, feedback: Message) -> None:
        self.feedback.append(feedback)

    def succeed(self) -> None:
        self.outcome = "succeed"

    def canceled(self) -> None:
        self.outcome = "canceled"

    def abort(self) -> None:
        self.outcome = "abort"


class Node:
    """A node whose parameters are given beforehand, and which keeps what it publishes and serves."""

    parameters: ClassVar[dict[str, Any]] = {}

    def __init__(self, name: str) -> None:
        self.name, self.services = name, dict[str, Callable]()
        self.published, self.has_published = list[Message](), threading.Event()

    def declare_parameter(self, name: str, default: Any) -> SimpleNamespace:
        return SimpleNamespace(value=self.parameters.get(name, default))

    def create_publisher(self, _: type, topic: str, depth: int) -> SimpleNamespace:
        assert topic and depth > 0

        def publish(sent: Message) -> None:
            self.published.append(sent)
            self.has_published.set()

        return SimpleNamespace(publish=publish)

    def create_service(self, _: type, name: str, callback: Callable, callback_group: object) -> None:
        assert callback_group is not None
        self.services[name] = callback

    def get_clock(self) -> SimpleNamespace:
        return SimpleNamespace(now=lambda: SimpleNamespace(to_msg=lambda: "now"))

    def get_logger(self) -> logging.Logger:
        return logging.getLogger(self.name)


class ActionServer:
    """Keeps the last server that was made."""

    made: ActionServer

    def __init__(self, node: Node, action: Any, name: str, execute: Callable, **options: Any) -> None:
        self.node, self.action, self.name, self.execute, self.options = node, action, name, execute, options
        type(self).made = self


def installed(monkeypatch: pytest.MonkeyPatch, action: Path, parameters: dict[str, Any]) -> threading.Event:
    """Let `import rclpy` and the rest find the stand-in; the event ends `rclpy.ok()`."""
    ended = threading.Event()
    monkeypatch.setattr(Node, "parameters", parameters)
    names = {
        "rclpy": {"ok": lambda: not ended.is_set(), "init": lambda: None, "spin": lambda *_, **__: None},
        "rclpy.action": {
            "ActionServer": ActionServer,
            "GoalResponse": SimpleNamespace(ACCEPT="accept"),
            "CancelResponse": SimpleNamespace(ACCEPT="accept"),
        },
        "rclpy.callback_groups": {"ReentrantCallbackGroup": object},
        "rclpy.executors": {"MultiThreadedExecutor": object, "ExternalShutdownException": InterruptedError},
        "rclpy.node": {"Node": Node},
        "sensor_msgs.msg": {"JointState": message("JointState", "header", "name", "position", "velocity", "effort")},
        "std_srvs.srv": {"Trigger": SimpleNamespace(Response=message("Response", "success", "message"))},
        f"{action.parents[1].name}.action": {action.stem: action_of(action)},
    }
    for name, content in names.items():
        module = types.ModuleType(name)
        module.__dict__.update(content)
        monkeypatch.setitem(sys.modules, name, module)
    return ended
