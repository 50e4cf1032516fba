"""The shipped model: repeatable, in its range, and clear about what it will not do; files that are no checkpoint."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import torch
from safetensors.torch import load_file, save_file

from mmm_core.errors import CheckpointError, GenerationError
from mmm_core.generate.engine import Engine
from mmm_core.inference.checkpoint import MODEL_FILE, load_model
from mmm_core.model.tokens import unpack_ids
from mmm_core.motion.posture_features import posture_features
from tests.support.sizes import few_and_long


def test_the_same_text_seed_and_length_give_the_same_motion(engine: Engine) -> None:
    a, b = (engine.generate("wave with your left hand", seed=4).motion for _ in range(2))
    assert np.array_equal(a.joints_m, b.joints_m)
    assert np.array_equal(a.tokens, b.tokens)


def test_another_seed_gives_another_motion_where_the_model_is_not_sure(engine: Engine) -> None:
    texts = ("dance", "celebrate", "show me something", "move a little", "fan yourself")
    pairs = [[engine.generate(text, seed=s).motion.tokens for s in (4, 5)] for text in texts]
    assert not all(np.array_equal(a, b) for a, b in pairs)


@pytest.mark.parametrize("seconds", few_and_long([0.8, 3.33], [0.8, 2.0, 3.33, 9.8]))
def test_the_callers_length_wins_to_the_frame(engine: Engine, seconds: float) -> None:
    motion = engine.generate("clap your hands", seconds=seconds).motion
    assert len(motion.joints_m) == round(seconds * 20)
    assert motion.features.shape == (len(motion.joints_m), 263)
    assert len(motion.tokens) == -(-len(motion.joints_m) // 4)
    n_codes = engine.model.tokenizer.config.n_codes
    ids = unpack_ids(motion.tokens, n_codes, 3)
    assert (ids >= 0).all() and (ids < n_codes).all()


@pytest.mark.parametrize(
    ("text", "arms"),
    few_and_long(
        [("raise your left arm", "left"), ("salute with your right hand", "right"), ("nod twice", "")],
        [
            ("wave with your right hand", "right"),
            ("wave with your left hand", "left"),
            ("raise your right arm", "right"),
            ("raise both arms", "both"),
            ("look to the left", ""),
        ],
    ),
)
def test_the_right_arms_move(engine: Engine, text: str, arms: str) -> None:
    found = [
        posture_features(m.joints_m, m.head_quat_wxyz).arms
        for m in (engine.generate(text, seed=s).motion for s in range(3))
    ]
    assert found.count(arms) >= 2, found


def test_bones_keep_their_length(engine: Engine) -> None:
    joints = engine.generate("throw your arms up", seconds=3).motion.joints_m
    for a, b, length in ((16, 18, 0.262), (18, 20, 0.252), (17, 19, 0.262), (19, 21, 0.252)):
        assert np.allclose(np.linalg.norm(joints[:, a] - joints[:, b], axis=-1), length, atol=1e-3)


@pytest.mark.parametrize(
    "text", ["", "   ", "asdf qwer zxcv", "kick the ball with your left foot", "lève le bras gauche"]
)
def test_what_it_cannot_do_is_rejected_with_a_reason(engine: Engine, text: str) -> None:
    generation = engine.generate(text)
    assert generation.status == "rejected"
    assert generation.reason
    assert len(generation.motion.joints_m) == 0


@pytest.mark.parametrize(
    "text", ["wave " * 2000, "振って", "🤖👋", "\x00\x01", "wave; DROP TABLE servos;--", "ß" * 500]
)
def test_any_text_gets_an_answer(engine: Engine, text: str) -> None:
    assert engine.generate(text).status in ("accepted", "degraded", "rejected")


@pytest.mark.parametrize("bad", [{"seed": -1}, {"seed": 2**31}, {"seconds": 0.0}, {"seconds": 60.0}])
def test_seeds_and_lengths_out_of_range_are_refused(engine: Engine, bad: dict[str, float]) -> None:
    with pytest.raises(GenerationError, match="allowed"):
        engine.generate("wave", **bad)  # type: ignore[arg-type]


def test_the_understood_side_is_the_side_of_the_words(engine: Engine) -> None:
    assert "right" in engine.generate("wave with your right hand").understood
    assert "left" in engine.generate("wave with your left hand").understood


@pytest.mark.long
def test_to_load_and_ask_it_brings_in_no_compiler() -> None:
    """A generator that is started again is waited for; PyTorch's compiler alone takes longer to import than the model to load."""
    asks = "import sys; from mmm_core.generate.engine import Engine; Engine.load().generate('nod'); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", asks], capture_output=True, text=True, check=True)
    modules = set(done.stdout.split())
    assert "torch" in modules
    assert not modules & {"torch._dynamo", "torch._inductor", "sympy"}


def test_every_weight_is_the_files() -> None:
    model, kept = load_model(), load_file(MODEL_FILE)
    for prefix, module in model.modules.items():
        for name, weight in module.state_dict().items():
            assert torch.equal(weight, kept[f"{prefix}.{name}"].to(weight.dtype)), name


def test_a_missing_checkpoint_is_named(tmp_path: Path) -> None:
    with pytest.raises(CheckpointError, match="no such file"):
        load_model(tmp_path / "none.safetensors")


def test_garbage_is_no_checkpoint(tmp_path: Path) -> None:
    (tmp_path / "x.safetensors").write_bytes(b"garbage" * 100)
    with pytest.raises(CheckpointError, match="not a readable safetensors file"):
        load_model(tmp_path / "x.safetensors")


def changed(tmp_path: Path, **metadata: str) -> Path:
    from safetensors import safe_open

    with safe_open(str(MODEL_FILE), framework="pt") as f:
        old = f.metadata()
    save_file(load_file(str(MODEL_FILE)), str(tmp_path / "m.safetensors"), metadata=old | metadata)
    return tmp_path / "m.safetensors"


@pytest.mark.parametrize(("key", "value"), [("kind", "other"), ("format", "99")])
def test_another_kind_or_format_is_refused_by_name(tmp_path: Path, key: str, value: str) -> None:
    with pytest.raises(CheckpointError, match=f"'{key}'.*'{value}'"):
        load_model(changed(tmp_path, **{key: value}))


def test_a_tensor_of_another_shape_is_named_with_both_shapes(tmp_path: Path) -> None:
    from safetensors import safe_open

    with safe_open(str(MODEL_FILE), framework="pt") as f:
        metadata = f.metadata()
    tensors = load_file(str(MODEL_FILE)) | {"transformer.head.weight": torch.zeros(3, 3)}
    save_file(tensors, str(tmp_path / "m.safetensors"), metadata=metadata)
    with pytest.raises(CheckpointError, match=r"transformer\.head\.weight.*\(3, 3\).*\(6144, 256\)"):
        load_model(tmp_path / "m.safetensors")


def test_the_checkpoint_says_where_it_comes_from() -> None:
    provenance = load_model().provenance
    assert "data" in provenance
    told = [model for model in provenance.get("average_of", [provenance]) if model.keys() != {"sha256"}]
    assert told
    for trained in told:
        assert {"recipe", "seed", "clips", "data", "revision"} <= trained.keys()
    json.dumps(provenance)
