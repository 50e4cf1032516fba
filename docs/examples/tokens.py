"""A motion as the model's tokens, and back: `python docs/examples/tokens.py clap.npz tokens.npy`.

It reads what `mmmd generate` writes and unpacks the tokens in it, which are those of the model that made it: `--encode` encodes
the motion anew, for another model. Recordings in BVH, ASF/AMC or HumanML3D's arrays are encoded. What is written is an array of
int64: a row for each four frames (0.2 s), a column for each codebook. `--model` names a checkpoint of your own, or an imported one.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import torch

from mmm_core.imports.recordings.common_body import on_common_body
from mmm_core.imports.recordings.files import read_motion
from mmm_core.inference.checkpoint import load_model
from mmm_core.model.tokens import FRAMES_PER_TOKEN, tokens_for_frames, unpack_ids
from mmm_core.motion.features import features_from_joints, recover, recover_from_positions
from mmm_core.motion.humanml3d_features import humanml3d_features_from_joints


def main() -> None:
    """Write the tokens, and print how far the motion that they decode to is from the one that was read."""
    parser = argparse.ArgumentParser(description="a motion as tokens")
    parser.add_argument("motion", type=Path, help="an .npz of `mmmd generate`, or a recording")
    parser.add_argument("tokens", type=Path, help="the .npy to write")
    parser.add_argument("--model", type=Path, help="a checkpoint of `mmmd train`; the shipped one when it is not given")
    parser.add_argument("--encode", action="store_true", help="encode a generated motion, too: another model made it")
    given = parser.parse_args()
    model, motion = load_model(given.model), read_motion(given.motion)
    tokenizer, is_ours = (
        model.tokenizer,
        model.rest_pose == "mmmd",
    )  # else rotations are relative to HumanML3D's rest pose

    features = motion.features  # of a generated motion; a recording has joints alone
    if given.encode or not features.any():
        joints_m = on_common_body(given.motion, motion)
        features = features_from_joints(joints_m) if is_ours else humanml3d_features_from_joints(joints_m)
    features = torch.from_numpy(features[: len(features) // FRAMES_PER_TOKEN * FRAMES_PER_TOKEN].astype(np.float32))
    with torch.inference_mode():
        if not given.encode and len(motion.tokens) == tokens_for_frames(
            len(motion.joints_m)
        ):  # they are packed, one number for each four frames
            ids = torch.from_numpy(unpack_ids(motion.tokens, tokenizer.config.n_codes, tokenizer.n_codebooks))
        else:
            ids = tokenizer.encode(features[None])[0]
        decoded = tokenizer.decode(ids[None])[0]
    np.save(given.tokens, ids.numpy())

    joints_of = recover if is_ours else recover_from_positions
    before, after = (joints_of(f.numpy()[: len(features)]).joints_m for f in (features, decoded))
    apart = (before - before[:, :1]) - (after - after[:, :1])  # to the pelvis: where the person walks to drifts
    apart_mm = 1000 * np.linalg.norm(apart, axis=-1).mean()
    print(f"{len(ids)} rows of {', '.join(tokenizer.part_names)}; {tokenizer.config.n_codes} codes each")
    print(f"decoded again, joints are {apart_mm:.1f} mm off on average, measured from the pelvis")


if __name__ == "__main__":
    main()
