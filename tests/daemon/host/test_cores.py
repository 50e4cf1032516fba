"""A core for the bus process: one daemon has one, and what it starts is not held to what it keeps off itself."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from daemon.host.cores import CoreClaim, keep_to, on_all_cores

CORES = frozenset({0, 1, 2})


def test_each_daemon_has_a_core_of_its_own_and_one_is_left_to_all(tmp_path: Path) -> None:
    first, second, third = (CoreClaim(CORES, tmp_path) for _ in range(3))
    assert (first.core, second.core, third.core) == (2, 1, None)
    first.close()
    assert first.core is None
    assert CoreClaim(CORES, tmp_path).core == 2


@pytest.mark.parametrize("cores", [frozenset(), frozenset({5})])
def test_the_only_core_is_nobodys(cores: frozenset[int], tmp_path: Path) -> None:
    assert CoreClaim(cores, tmp_path).core is None


def test_a_core_is_free_again_when_its_daemon_was_killed(tmp_path: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path; from daemon.host.cores import CoreClaim\n"
        "claim = CoreClaim(frozenset({0, 1}), Path(sys.argv[1])); print(claim.core, flush=True); time.sleep(60)"
    )
    with subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "1\n"
        assert CoreClaim(frozenset({0, 1}), tmp_path).core is None
        other.kill()
    assert CoreClaim(frozenset({0, 1}), tmp_path).core == 1


def test_where_no_claim_can_be_kept_there_is_none(tmp_path: Path) -> None:
    assert CoreClaim(CORES, tmp_path / "missing").core is None
    (tmp_path / "mmmd-core-2").symlink_to(tmp_path / "elsewhere")
    assert CoreClaim(CORES, tmp_path).core == 1, "a link that somebody laid there is not followed"
    assert not (tmp_path / "elsewhere").exists()


needs_two_cores = pytest.mark.skipif(
    not hasattr(os, "sched_setaffinity") or len(os.sched_getaffinity(0)) < 2, reason="needs two cores and Linux"
)


@needs_two_cores
def test_two_starts_at_a_time_leave_the_front_off_the_core(tmp_path: Path) -> None:
    """The bus and the ctl process were started at a time: from then on the front ran on the bus process's core as well."""
    everywhere = os.sched_getaffinity(0)
    seen: list[set[int]] = []

    def front() -> None:
        CoreClaim(frozenset(everywhere), tmp_path).keep_off()
        seen.append(os.sched_getaffinity(0))
        first, second = on_all_cores(), on_all_cores()
        first.__enter__()
        second.__enter__()
        first.__exit__(None, None, None)
        seen.append(os.sched_getaffinity(0))
        second.__exit__(None, None, None)
        seen.append(os.sched_getaffinity(0))

    thread = threading.Thread(target=front)  # its affinity ends with it
    thread.start()
    thread.join()
    before, while_one_starts, after = seen
    assert after == before != everywhere
    assert while_one_starts == everywhere


@needs_two_cores
def test_the_front_and_its_threads_keep_off_the_core_but_not_children(tmp_path: Path) -> None:
    everywhere = os.sched_getaffinity(0)
    seen: list[set[int]] = []

    def front() -> None:
        claim = CoreClaim(frozenset(everywhere), tmp_path)
        assert claim.core is not None
        claim.keep_off()
        thread = threading.Thread(target=lambda: seen.append(os.sched_getaffinity(0)))
        thread.start()
        thread.join()
        with on_all_cores():
            code = "import os; print(sorted(os.sched_getaffinity(0)))"
            child = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
        assert child.stdout.strip() == str(sorted(everywhere))
        seen.append(os.sched_getaffinity(0))
        assert keep_to(claim.core)
        seen.append(os.sched_getaffinity(0))
        seen.append({claim.core})

    thread = threading.Thread(target=front)  # its affinity ends with it
    thread.start()
    thread.join()
    threads_cores, own, kept, core = seen
    assert threads_cores == own == everywhere - core
    assert kept == core
