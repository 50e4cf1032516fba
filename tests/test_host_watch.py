"""What is void and what fails: a hold-up has to be measured, and to be one."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from tests.host_watch import LEAST_S, STILL_S, WAIT_IN_ALL_S, HostWatch
from tests.support.sizes import few_and_long

pytest_plugins = ["pytester"]
ROOT = Path(__file__).parents[1]


class Stolen:
    """A /proc/stat of two processors."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "stat"
        self.set(0, 0)

    def set(self, *ticks: int) -> None:
        lines = [f"cpu{core} 1 2 3 4 5 6 7 {n} 0 0" for core, n in enumerate(ticks)]
        self.path.write_text("\n".join([f"cpu  1 2 3 4 5 6 7 {sum(ticks)} 0 0", *lines, "intr 1 2"]))


@pytest.mark.parametrize(
    ("looks", "seconds"),
    [([(0.02, 0, 30)], 0.3), ([(0.35, 30, 0)], 0.3), ([(0.02, 9, 0)], 0.0), ([(0.1, 9, 0), (0.1, 18, 0)], 0.0),
     ([(1.0, 30, 30)], 0.0), ([(0.3, 25, 0), (0.1, 35, 0)], 0.25)],
    ids=["one processor", "both looked late", "short", "short ones", "many short ones between two looks", "the longest"],
)  # fmt: skip
def test_a_hold_up_is_a_tenth_of_a_second_in_one_piece(tmp_path, monkeypatch, looks, seconds):
    now_s = 100.0
    monkeypatch.setattr("tests.host_watch.time.monotonic", lambda: now_s)
    stolen = Stolen(tmp_path)
    watch = HostWatch(stolen.path)
    for after_s, *ticks in looks:
        now_s += after_s
        stolen.set(*ticks)
        watch.look()
    assert watch.longest_s(since_s=100.0) == pytest.approx(seconds)
    assert watch.longest_s(since_s=now_s + 0.001) == 0.0


def test_a_machine_without_a_host_is_never_held_up(tmp_path):
    watch = HostWatch(tmp_path / "missing")
    time.sleep(2 * LEAST_S)
    watch.look()
    assert watch.longest_s(0.0) == 0.0


def test_it_waits_for_a_still_moment_but_not_for_ever(tmp_path, monkeypatch):
    now_s = 100.0

    def sleep(seconds: float) -> None:
        nonlocal now_s
        now_s += seconds

    monkeypatch.setattr("tests.host_watch.time.monotonic", lambda: now_s)
    monkeypatch.setattr("tests.host_watch.time.sleep", sleep)
    stolen = Stolen(tmp_path)
    watch = HostWatch(stolen.path)
    now_s += 0.3
    stolen.set(30, 0)
    watch.look()
    watch.wait_until_still()
    assert now_s == pytest.approx(100.3 + STILL_S, abs=0.1)
    monkeypatch.setattr(watch, "longest_s", lambda since_s: 0.5)
    for _ in range(30):
        watch.wait_until_still()
    assert now_s == pytest.approx(100.3 + WAIT_IN_ALL_S, abs=0.1)


def test_what_a_failed_test_leaves_open_does_not_fail_another(pytester, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    pytester.makepyprojecttoml("[tool.pytest.ini_options]\nmarkers = ['realtime']\nfilterwarnings = ['error']")
    pytester.makeconftest("from tests.conftest import *")
    leak = (
        "import warnings, gc\nclass Open:\n    def __del__(self): warnings.warn('open', ResourceWarning, source=self)\n"
    )
    for name, fails in (("fails", True), ("passes", False)):
        pytester.makepyfile(
            **{f"test_{name}": f"{leak}KEPT = []\ndef test_one(): KEPT.append(Open()); assert {not fails}\n"
               "def test_two(): KEPT.clear(); gc.collect()"}
        )  # fmt: skip
    pytester.runpytest_subprocess("test_fails.py").assert_outcomes(passed=1, failed=1)
    pytester.runpytest_subprocess("test_passes.py").assert_outcomes(passed=1, failed=1)


@pytest.mark.parametrize("option", [[], ["--void-when-held-up"]], ids=["first run", "second run"])
@pytest.mark.parametrize("held_up", few_and_long([True], [True, False]))
def test_only_a_realtime_failure_while_the_machine_stands_still_is_void(pytester, monkeypatch, option, held_up):
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    pytester.makepyprojecttoml("[tool.pytest.ini_options]\nmarkers = ['realtime']")
    pytester.makeconftest("from tests.conftest import *")
    pytester.makepyfile(f"""
        import pytest
        from tests.host_watch import HostWatch

        HostWatch.longest_s = lambda self, since_s: {0.3 if held_up else 0.0}
        HostWatch.wait_until_still = lambda self: None

        @pytest.mark.realtime
        def test_late(): assert 1 == 2

        @pytest.mark.realtime
        def test_in_time(): pass

        def test_wrong(): assert 1 == 2
    """)
    result = pytester.runpytest_subprocess("-rs", *option)
    void = bool(option) and held_up
    result.assert_outcomes(passed=1, failed=1 if void else 2, skipped=1 if void else 0)
    if void:
        result.stdout.fnmatch_lines(
            ["*void: the machine stood still for 0.30 s meanwhile; AssertionError: assert 1 == 2*"]
        )
