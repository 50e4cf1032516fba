"""Fault schedules: read strictly, drawn from a seed."""

from __future__ import annotations

from pathlib import Path

import pytest

from daemon.errors import ConfigError
from sim.faults import Fault, FaultSchedule


def test_a_schedule_is_read_and_strikes_in_its_time(tmp_path: Path) -> None:
    file = tmp_path / "faults.toml"
    file.write_text('seed = 3\n[[fault]]\nkind = "silent"\nstart_s = 1.0\nend_s = 2.0\nservo_id = 4\n')
    schedule = FaultSchedule.load(file)
    assert [schedule.active("silent", t, 4) for t in (0.5, 1.5, 2.5)] == [False, True, False]
    assert not schedule.active("silent", 1.5, 5)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[[fault]]\nkind = "explode"\n', "drop, corrupt, silent, trip, unplug"),
        ('[[fault]]\nkind = "drop"\nwhen = 3\n', "start_s"),
        ("not toml", "faults.toml"),
    ],
)
def test_a_wrong_schedule_is_refused_with_what_is_allowed(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "faults.toml"
    file.write_text(text)
    with pytest.raises(ConfigError) as caught:
        FaultSchedule.load(file)
    assert said in str(caught.value)


def test_the_same_seed_spoils_the_same_replies() -> None:
    def spoiled(seed: int) -> list[bytes]:
        schedule = FaultSchedule((Fault("corrupt", probability=0.5), Fault("drop", probability=0.3)), seed)
        return [schedule.spoil(b"abcdefgh", i * 0.1, 1) for i in range(50)]

    assert spoiled(1) == spoiled(1)
    assert spoiled(1) != spoiled(2)
    assert b"" in spoiled(1) and b"abcdefgh" in spoiled(1)
