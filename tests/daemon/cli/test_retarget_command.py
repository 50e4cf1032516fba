"""`mmmd retarget` on one file and on folders: what is written, what is made again, what is not fatal, and on a cluster."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daemon.cli import main
from tests.retarget.gestures import gesture


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Four motions, one of them in a subfolder, and one that is none."""
    motions = tmp_path / "motions"
    (motions / "more").mkdir(parents=True)
    for i, name in enumerate(("wave", "clap", "nod", "more/bow")):
        motion = gesture(name.rsplit("/", 1)[-1], seed=i)
        np.save(motions / f"{name}.npy", motion.joints_m)
    np.save(motions / "broken.npy", np.full((5, 22, 3), np.nan))
    return motions


def counts(capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    return json.loads(capsys.readouterr().out)


def run(folder: Path, out: Path, *more: str) -> int:
    return main(["retarget", str(folder), "--robot", "op3", "--out", str(out), "--jobs", "1", "--json", *more])


def test_a_folder_is_written_once_and_gone_on_with(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert run(folder, out) == 0
    first = counts(capsys)
    assert {k: first[k] for k in ("files", "were_there", "written")} == {"files": 5, "were_there": 0, "written": 4}
    assert [Path(f["path"]).name for f in first["failed"]] == ["broken.npy"]
    assert "not finite" in first["failed"][0]["error"]
    assert json.loads((out / "failed.jsonl").read_text())["path"].endswith("broken.npy")
    with np.load(out / "more" / "bow.npz") as data:
        assert data["ticks"].shape == (len(data["q_rad"]), 8)
    before = {p: p.stat().st_mtime_ns for p in out.rglob("*.npz")}
    (out / "clap.npz").unlink()  # a run that was cut short
    (out / "wave.npz.77.part").write_bytes(b"half")
    assert run(folder, out) == 0
    again = counts(capsys)
    assert (again["were_there"], again["written"]) == (3, 1)
    assert {p: p.stat().st_mtime_ns for p in before if p.name != "clap.npz"} == {
        p: t for p, t in before.items() if p.name != "clap.npz"
    }


@pytest.mark.parametrize(
    ("option", "value"), [("--fps", "0"), ("--fps", "-3"), ("--fps", "nan"), ("--most-error-deg", "nan")]
)
def test_a_number_that_makes_no_sense_is_refused(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], option: str, value: str
) -> None:
    assert main(["retarget", str(folder / "wave.npy"), "--out", str(tmp_path / "o.npz"), f"{option}={value}"]) == 2
    assert f"{option} {value}: expected more than 0" in capsys.readouterr().err
    assert not (tmp_path / "o.npz").exists()


def test_a_folder_that_is_not_there_is_named(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["retarget", str(folder / "wave.npy"), "--out", str(tmp_path / "none" / "o.npz")]) == 2
    assert f"there is no folder {tmp_path / 'none'}; make it" in capsys.readouterr().err


def test_a_folders_paths_do_not_go_to_a_file(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "there").touch()
    for name in ("ticks.npz", "there"):
        assert main(["retarget", str(folder), "--out", str(tmp_path / name)]) == 2
        assert "is a folder, whose paths go to a folder" in capsys.readouterr().err
    assert not (tmp_path / "ticks.npz").exists()


def test_another_robot_needs_another_folder(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert run(folder, out) == 0
    status = main(["retarget", str(folder), "--robot", "reference", "--out", str(out), "--jobs", "1"])
    assert status == 2
    assert "choose another folder" in capsys.readouterr().err


@pytest.mark.long
def test_several_processes_write_the_same_bits(folder: Path, tmp_path: Path) -> None:
    assert run(folder, tmp_path / "one") == 0
    assert main(["retarget", str(folder), "--robot", "op3", "--out", str(tmp_path / "two"), "--jobs", "2"]) == 0
    for path in (tmp_path / "one").rglob("*.npz"):
        with np.load(path) as a, np.load(tmp_path / "two" / path.relative_to(tmp_path / "one")) as b:
            assert all(np.array_equal(a[k], b[k]) for k in a.files)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")
def test_a_dask_cluster_writes_the_same(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    distributed = pytest.importorskip("distributed", reason="the extra `dask` is not installed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        assert run(folder, tmp_path / "out", "--dask", cluster.scheduler_address) == 0
    found = counts(capsys)
    assert (found["written"], len(found["failed"])) == (4, 1)


def test_nothing_to_retarget_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(tmp_path, tmp_path / "out") == 2
    assert "no motion files" in capsys.readouterr().err
    np.save(tmp_path / "bad.npy", np.zeros(3))
    assert run(tmp_path, tmp_path / "out") == 1, "nothing at all could be used"


def test_going_slower_keeps_an_error_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motion = gesture("arm_circle")
    fast = motion.joints_m[::3]
    np.save(tmp_path / "fast.npy", fast)
    reports = []
    for more in ([], ["--most-error-deg", "2"]):
        out = str(tmp_path / "out.npz")
        assert main(["retarget", str(tmp_path / "fast.npy"), "--out", out, "--json", *more]) == 0
        reports.append(counts(capsys))
    plain, slower = reports
    assert plain["time_stretch"] == 1 and plain["direction_mean_deg"] > 2
    assert slower["time_stretch"] > 1 and slower["direction_mean_deg"] < plain["direction_mean_deg"] / 2
