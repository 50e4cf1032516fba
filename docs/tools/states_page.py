"""The table of states as a page: `python -m docs.tools.states_page docs/states.md`. A test keeps the page equal to the table."""

from __future__ import annotations

import sys
from pathlib import Path

from daemon.state.machine import COMMANDS, REPORTS, TRANSITIONS, RobotState, Trigger

_MEANING = {
    RobotState.LIMP: "torque is off",
    RobotState.ARMING: "torque came on over a goal pinned to the measured pose; a slow move to the rest pose",
    RobotState.IDLE: "armed, nothing to play, or idle movements",
    RobotState.MOVING: "a command is played",
    RobotState.HOLDING: "a person stopped it: it brakes within its limits, or stands still with torque on",
    RobotState.PARKING: "a slow move to the park pose, then torque off",
    RobotState.FAULT: "latched: a servo, the bus or a process failed; what still has torque brakes and holds",
    RobotState.ESTOP: "latched: a person cut the torque; where the daemon is set to `estop = hold` it brakes and holds",
}


def page() -> str:
    """The page."""
    lines = [
        "# States of the robot",
        "",
        "Drawn from the table in `daemon/state/machine.py` by `python -m docs.tools.states_page docs/states.md`. A command is",
        "allowed where it has an entry and is refused elsewhere, with what is allowed and what to do. The state itself moves only",
        "when the bus process reports that it has: a report without an entry is impossible, and asks for an e-stop.",
        "",
        "| state | meaning |",
        "|---|---|",
        *(f"| `{state.value}` | {_MEANING[state]} |" for state in RobotState),
        "",
        "```mermaid",
        "stateDiagram-v2",
        "    [*] --> limp",
        *_arrows(),
        "```",
        "",
        "## Commands",
        "",
        *_table(COMMANDS, "refused"),
        "",
        "The entry is the state that the command leads to once the bus process has carried it out. `say` stands for `gesture` as",
        "well. After an e-stop, a fault or `torque off` `say` is refused in `limp` until a person has given `arm`.",
        "",
        "## Reports of the bus process",
        "",
        *_table(REPORTS, "impossible"),
        "",
    ]
    return "\n".join(lines)


def _arrows() -> list[str]:
    """One arrow for each pair of states, with what leads along it."""
    found: dict[tuple[RobotState, RobotState], list[str]] = {}
    for state, row in TRANSITIONS.items():
        for trigger, following in row.items():
            if following is not state:
                found.setdefault((state, following), []).append(trigger.value)
    return [f"    {a.value} --> {b.value}: {', '.join(names)}" for (a, b), names in found.items()]


def _table(triggers: tuple[Trigger, ...], absent: str) -> list[str]:
    head = "| in | " + " | ".join(t.value for t in triggers) + " |"
    rows = [
        f"| **{state.value}** | " + " | ".join(_entry(state, t, absent) for t in triggers) + " |"
        for state in RobotState
    ]
    return [head, "|---" * (len(triggers) + 1) + "|", *rows]


def _entry(state: RobotState, trigger: Trigger, absent: str) -> str:
    following = TRANSITIONS[state].get(trigger)
    return absent if following is None else "stays" if following is state else following.value


if __name__ == "__main__":
    Path(sys.argv[1] if len(sys.argv) > 1 else "docs/states.md").write_text(page(), "utf-8")
