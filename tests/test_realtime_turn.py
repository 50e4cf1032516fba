"""No more files of tests in real time run at once than there are processors."""

from __future__ import annotations

import threading
import uuid

from tests.realtime_turn import LOOK_S, RealtimeTurn


def test_a_turn_is_waited_for_until_another_is_given_back():
    run = uuid.uuid4().hex
    first, second, third = (RealtimeTurn(run, 2) for _ in range(3))
    first.take()
    first.take()  # has it already
    second.take()
    waits = threading.Thread(target=third.take)
    waits.start()
    waits.join(4 * LOOK_S)
    assert waits.is_alive()
    first.give_back()
    waits.join(10)
    assert not waits.is_alive()
    for turn in (first, second, third):
        turn.give_back()


def test_another_run_has_turns_of_its_own():
    turns = [RealtimeTurn(uuid.uuid4().hex, 1) for _ in range(2)]
    for turn in turns:
        turn.take()
    for turn in turns:
        turn.give_back()
