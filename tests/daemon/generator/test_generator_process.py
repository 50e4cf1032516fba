"""The generator's process: it serves the shipped model, refuses a broken one, and ends with its parent."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mmm_core.generate.continuation import continue_motion
from mmm_core.inference.checkpoint import MODEL_FILE
from tests.support.generator_client import ask
from tests.support.shipped import shipped_engine

pytestmark = pytest.mark.realtime

needs_model = pytest.mark.skipif(not MODEL_FILE.exists(), reason="no checkpoint in this checkout")


@pytest.mark.long
def test_the_process_refuses_a_checkpoint_that_is_none(endpoint, tmp_path):
    """One message, no traceback."""
    broken = tmp_path / "model.safetensors"
    broken.write_bytes(b"no weights")
    result = subprocess.run(
        [sys.executable, "-m", "daemon.generator.process", "--bind", endpoint, "--model", str(broken)],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert result.returncode == 1
    assert str(broken) in result.stderr and "Traceback" not in result.stderr


def test_the_front_holds_no_torch():
    code = "import sys, daemon.supervisor.supervisor, daemon.client.client, daemon.cli; print('torch' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert result.stdout.strip() == "False"


@pytest.mark.long
@needs_model
def test_the_process_serves_the_shipped_model_and_ends_with_its_parent(endpoint):
    process = subprocess.Popen(
        [sys.executable, "-m", "daemon.generator.process", "--bind", endpoint, "--parent-pid", str(os.getpid())],
        stderr=subprocess.DEVNULL,
    )
    try:
        motion = ask(endpoint, lambda client: client.generate("wave with your right hand", 7, 2.0, 60.0)).motion
        assert len(motion.joints_m) == 40 and motion.status == "accepted"

        def on(client, **how):
            return client.generate("raise both arms", 4, 2.0, 60.0, **how)

        alone = ask(endpoint, on).motion
        after = ask(endpoint, lambda client: on(client, before=motion, prefix_s=0.8)).motion
        other = ask(endpoint, lambda client: on(client, before=motion, prefix_s=0.2)).motion
        expected = continue_motion(shipped_engine(), motion, 0.8, "raise both arms", seed=4, seconds=2.0).motion
        np.testing.assert_allclose(after.joints_m, expected.joints_m, atol=1e-3)
        for different in (alone, other):
            assert np.abs(after.joints_m - different.joints_m).max() > 0.01
    finally:
        process.kill()
        process.wait(10)
    assert not Path(endpoint.removeprefix("ipc://")).is_dir()
