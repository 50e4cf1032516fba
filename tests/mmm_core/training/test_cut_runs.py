"""A training that is killed, divided among processes or out of disk: the same weights, and a state that is whole."""

from __future__ import annotations

import csv
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import torch

from daemon.cli import main
from mmm_core.errors import CheckpointError
from mmm_core.training.run import Run, Schedule
from mmm_core.training.run import train as run_stage
from tests.support.small_training import (
    small,
)

pytestmark = pytest.mark.usefixtures("quick_parts")


def environment() -> dict[str, str]:
    root = str(Path(__file__).parents[3])
    return {**os.environ, "PYTHONPATH": root, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"}


def losses(path: Path) -> np.ndarray:
    with path.open() as f:
        rows = list(csv.reader(f))
    return np.array([[float(v) for v in row[2:]] for row in rows if row[0] != "step"])


@pytest.mark.long
@pytest.mark.parametrize("times", [1, pytest.param(6, marks=pytest.mark.soak)])
def test_a_killed_run_goes_on_with_the_same_weights(tmp_path: Path, times: int) -> None:
    """SIGKILL at a random moment, in the soak run again and again; then against a run that nobody cut."""
    config = small(tmp_path / "small.toml", steps=60)
    train = ["train", "tokenizer", "--config", str(config), "--sample-every", "0", "--run"]
    command = [sys.executable, "-m", "daemon.cli", *train, str(tmp_path / "cut")]
    state, rng, killed = tmp_path / "cut" / "tokenizer.pt", np.random.default_rng(), 0
    for _ in range(times):
        before = state.stat().st_mtime_ns if state.is_file() else 0
        process = subprocess.Popen(command, env=environment(), stdout=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while process.poll() is None and not (state.is_file() and state.stat().st_mtime_ns != before):
            assert time.monotonic() < deadline, "it saves no state"
            time.sleep(0.005)
        time.sleep(rng.uniform(0, 0.1))
        process.kill()
        killed += process.wait() == -signal.SIGKILL
    assert killed
    assert main([*train, str(tmp_path / "cut")]) == 0
    assert main([*train, str(tmp_path / "whole")]) == 0
    cut, whole = (torch.load(tmp_path / r / "tokenizer.pt", weights_only=True) for r in ("cut", "whole"))
    assert cut["step"] == whole["step"] == 60
    for name, tensor in whole["module"].items():
        assert torch.equal(cut["module"][name], tensor), name
    assert all(torch.equal(a, b) for a, b in zip(cut["averages"], whole["averages"], strict=True))


@pytest.mark.soak  # three more processes that import PyTorch, for training on several machines
def test_two_processes_have_the_loss_of_one_with_the_whole_batch(tmp_path: Path) -> None:
    config = small(tmp_path / "small.toml", steps=41)
    options = ["train", "transformer", "--config", str(config), "--sample-every", "0", "--run-dir"]
    assert main([*options, str(tmp_path / "one")]) == 0
    launcher = [sys.executable, "-m", "torch.distributed.run", "--standalone", "--nproc-per-node", "2"]
    done = subprocess.run([*launcher, "-m", "daemon.cli", *options, str(tmp_path / "two")], env=environment(),
                          capture_output=True, text=True, timeout=100, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    for stage in ("tokenizer", "transformer"):
        one, two = losses(tmp_path / "one" / f"{stage}.csv"), losses(tmp_path / "two" / f"{stage}.csv")
        assert len(one) == len(two) == 3
        np.testing.assert_allclose(two[:, 0], one[:, 0], rtol=2e-3)
    np.testing.assert_allclose(two[0], one[0], rtol=1e-4, atol=1e-4)


class TestStateFiles:
    SCHEDULE = Schedule(steps=4, warmup_steps=1, save_every=2)

    @staticmethod
    def loss_of(model: torch.nn.Module, fill_disk_at: int | None = None) -> object:
        def loss_fn(step: int, generator: torch.Generator) -> dict[str, torch.Tensor]:
            if step == fill_disk_at:
                _, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
                resource.setrlimit(resource.RLIMIT_FSIZE, (2000, hard))
            return {"loss": model(torch.randn(4, 64, generator=generator)).square().mean()}

        return loss_fn

    def test_a_full_disk_leaves_the_older_state_whole(self, tmp_path: Path) -> None:
        """No file may grow beyond 2 kB, as on a full disk, from the third step on."""
        model = torch.nn.Linear(64, 64)
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        try:
            with pytest.raises(CheckpointError, match="earlier step is whole"):
                run_stage(model, self.loss_of(model, 2), self.SCHEDULE, Run(tmp_path), "m")  # type: ignore[arg-type]
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            signal.signal(signal.SIGXFSZ, ignored)
        assert torch.load(tmp_path / "m.pt", weights_only=True)["step"] == 2
        assert [p.name for p in tmp_path.iterdir() if p.suffix == ".pt"] == ["m.pt"]

    def test_a_state_that_is_none_is_named(self, tmp_path: Path) -> None:
        (tmp_path / "m.pt").write_bytes(b"nothing")
        model = torch.nn.Linear(64, 64)
        with pytest.raises(CheckpointError, match="delete it to begin anew"):
            run_stage(model, self.loss_of(model), self.SCHEDULE, Run(tmp_path), "m")  # type: ignore[arg-type]
