"""The robot's states: every pair of state and trigger, the latches, and that nothing outside the table happens."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from daemon.shared_memory.bus_link import BusState
from daemon.state.machine import (
    COMMANDS,
    REPORTS,
    TRANSITIONS,
    CommandRefusedError,
    ImpossibleTransitionError,
    RobotState,
    StateMachine,
    Trigger,
)
from docs.tools.states_page import page

S, T = RobotState, Trigger


def machine_in(state: RobotState) -> StateMachine:
    machine = StateMachine()
    machine.state = state
    return machine


GRID_OF_COMMANDS = """
           say     arm      park     stop     torque_off  estop  reset
limp       arming  arming   limp     limp     limp        estop  limp
arming     moving  arming   parking  holding  limp        estop  arming
idle       moving  idle     parking  idle     limp        estop  idle
moving     moving  moving   parking  holding  limp        estop  moving
holding    moving  holding  parking  holding  limp        estop  holding
parking    -       -        parking  holding  limp        estop  -
fault      -       -        -        fault    -           estop  limp
estop      -       -        -        estop    -           estop  limp
"""
GRID_OF_REPORTS = """
           LIMP  ARMING  HOLDING  STOPPED  PLAYING  IDLING   STOPPING  PARKING  FAULT  ESTOP  LOST
limp       limp  arming  idle     idle     -        -        -         -        fault  estop  fault
arming     limp  arming  idle     holding  moving   -        holding   parking  fault  estop  fault
idle       limp  -       idle     idle     moving   idle     holding   parking  fault  estop  fault
moving     limp  -       idle     holding  moving   idle     holding   parking  fault  estop  fault
holding    limp  -       holding  holding  moving   holding  holding   parking  fault  estop  fault
parking    limp  arming  holding  holding  -        -        holding   parking  fault  estop  fault
fault      limp  -       -        -        -        -        -         -        fault  estop  fault
estop      limp  -       -        -        -        -        -         -        fault  estop  fault
"""
"""Written by hand from what DESIGN 6 asks for, a second time beside the daemon's table; - is refused, or impossible.

Torque comes by arming alone, fault and e-stop latch, what brakes is told as holding, stop and e-stop are never refused.
"""


def rows(grid: str, trigger: Callable[[str], Trigger]) -> list[tuple[RobotState, Trigger, RobotState | None]]:
    """(state, trigger, state after it or None) of each field."""
    head, *lines = grid.strip("\n").splitlines()
    fields = [(S(line.split()[0]), line.split()[1:]) for line in lines]
    assert [state for state, _ in fields] == list(S)
    return [
        (state, trigger(name), None if after == "-" else S(after))
        for state, row in fields
        for name, after in zip(head.split(), row, strict=True)
    ]


COMMAND_ROWS = rows(GRID_OF_COMMANDS, lambda name: Trigger[name.upper()])
REPORT_ROWS = rows(GRID_OF_REPORTS, lambda name: Trigger[f"BUS_{name}"])


def test_the_grids_are_whole():
    assert {trigger for _, trigger, _ in COMMAND_ROWS} == set(COMMANDS)
    assert {trigger for _, trigger, _ in REPORT_ROWS} == set(REPORTS)


@pytest.mark.parametrize(("state", "trigger", "after"), REPORT_ROWS)
def test_reports_move_as_the_grid_says_or_are_impossible(state, trigger, after):
    machine = machine_in(state)
    if after is None:
        with pytest.raises(ImpossibleTransitionError):
            machine.report(trigger)
        assert machine.state is state
    else:
        assert machine.report(trigger) == (after is not state)
        assert machine.state is after
        assert machine.must_arm == (after in (S.FAULT, S.ESTOP))


@pytest.mark.parametrize(("state", "trigger", "after"), COMMAND_ROWS)
def test_commands_never_move_the_state_themselves(state, trigger, after):
    machine = machine_in(state)
    if after is None:
        with pytest.raises(CommandRefusedError) as caught:
            machine.check(trigger)
        assert caught.value.do and trigger.value in str(caught.value)
    else:
        assert machine.check(trigger) is after
    assert machine.state is state


@pytest.mark.parametrize("state", S)
def test_stop_and_estop_are_allowed_everywhere(state):
    machine_in(state).check(T.STOP)
    machine_in(state).check(T.ESTOP)


def test_torque_comes_only_by_arming():
    """From limp, fault and e-stop no report leads to a state with torque but arming (or its end, when it was short)."""
    armed = {S.IDLE, S.MOVING, S.HOLDING, S.PARKING}
    for state in (S.FAULT, S.ESTOP):
        assert not armed & {TRANSITIONS[state][t] for t in REPORTS if t in TRANSITIONS[state]}
    assert {t for t in REPORTS if TRANSITIONS[S.LIMP].get(t) in armed} == {T.BUS_HOLDING, T.BUS_STOPPED}


def test_latches_open_only_by_reset():
    for state in (S.FAULT, S.ESTOP):
        leaving = {t for t in REPORTS if TRANSITIONS[state].get(t, state) not in (S.FAULT, S.ESTOP)}
        assert leaving == {T.BUS_LIMP}  # what the bus process reports after a reset
        assert machine_in(state).check(T.RESET) is S.LIMP
        for command in (T.SAY, T.ARM, T.PARK, T.TORQUE_OFF):
            with pytest.raises(CommandRefusedError, match="mmmd reset"):
                machine_in(state).check(command)


def test_every_bus_state_has_a_report():
    assert {T[f"BUS_{state.name}"] for state in BusState} | {T.BUS_LOST, T.BUS_STOPPED, T.BUS_IDLING} == set(REPORTS)


def test_every_state_is_reached():
    assert {following for row in TRANSITIONS.values() for following in row.values()} == set(S)


def test_after_an_estop_a_text_does_not_arm():
    machine = StateMachine()
    machine.check(T.SAY)
    machine.report(T.BUS_ESTOP)
    machine.report(T.BUS_LIMP)
    with pytest.raises(CommandRefusedError, match="mmmd arm"):
        machine.check(T.SAY)
    machine.armed_by_person()
    machine.check(T.SAY)


def test_after_torque_off_a_text_does_not_arm():
    machine = StateMachine()
    machine.limp_by_person()
    with pytest.raises(CommandRefusedError, match="mmmd arm"):
        machine.check(T.SAY)
    machine.armed_by_person()
    machine.check(T.SAY)


def test_without_auto_arm_the_first_text_waits_for_arm():
    machine = StateMachine(auto_arm=False)
    with pytest.raises(CommandRefusedError, match="mmmd arm"):
        machine.check(T.SAY)


def test_the_page_of_the_docs_is_that_of_the_table():
    """`python -m docs.tools.states_page docs/states.md` writes it."""
    assert (Path(__file__).parents[3] / "docs" / "states.md").read_text("utf-8") == page()


def test_the_page_draws_every_transition():
    text = page()
    for state, row in TRANSITIONS.items():
        for trigger, following in row.items():
            if following is not state:
                arrow = next(
                    x for x in text.splitlines() if x.strip().startswith(f"{state.value} --> {following.value}:")
                )
                assert trigger.value in arrow
