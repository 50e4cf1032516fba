"""A language model is told of a motion in sentences without figures of joints."""

from __future__ import annotations

import pytest

from daemon.client.event_text import repeatable
from daemon.wire.events import Accepted, Ack, Done, Progress

WAVE = {
    "plan_id": 1, "text": "wave", "understood": "waves with the right hand", "scope_score": 0.9, "duration_s": 2.0,
    "generate_ms": 50.0,
}  # fmt: skip
FIGURES = {
    "plan_id": 1, "first_motion_ms": 40.0, "duration_s": 2.04, "frames": 204, "peak_speed_share": 0.5,
    "peak_speed_joint": "right_elbow",
    "peak_speed_rad_s": 2.0, "peak_speed_limit_rad_s": 4.0, "clipped_frames": 1, "gate_clipped_frames": 0, "underruns": 0,
    "direction_error_deg": 3.0,
}  # fmt: skip


def accepted(**changed: object) -> Accepted:
    return Accepted(**{**WAVE, "status": "accepted", "reason": "", **changed})


def done(**changed: object) -> Done:
    return Done(**{**FIGURES, **changed})


@pytest.mark.parametrize(
    ("events", "told"),
    [
        ([accepted()], "it begins: waves with the right hand, for 2.0 s"),
        ([accepted(understood="", duration_s=0.0)], "it begins: wave"),
        (
            [accepted(), Progress(plan_id=1, stage="moving"), done(seen="waves with the right hand 3 times")],
            "done after 2.0 s; seen on the robot: waves with the right hand 3 times",
        ),
        (
            [accepted(lacks="it has no wrists"), done(seen="claps twice", missing="not seen: claps twice")],
            "this robot cannot show all of it: it has no wrists\n"
            "done after 2.0 s; its motion claps twice; on the robot: not seen: claps twice",
        ),
        (
            [accepted(reason="without the jump", denied=("nod", "bow")), done()],
            "only in part: without the jump\nleft out as asked: nod, bow\ndone after 2.0 s",
        ),
        (
            [
                accepted(),
                Progress(plan_id=1, stage="scene", scene=1, text="wave", status="accepted", understood="waves"),
                Progress(plan_id=1, stage="scene", scene=2, text="walk", status="rejected", reason="it has no legs"),
                done(),
            ],
            "scene 1, 'wave': waves\nscene 2, 'walk': left out, it has no legs\ndone after 2.0 s",
        ),
        ([Ack(verb="stop", state="moving")], "stopped"),
    ],
)
def test_a_result_is_sentences_to_repeat(events: list, told: str) -> None:
    assert repeatable(events) == told
