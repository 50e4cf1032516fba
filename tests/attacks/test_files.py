"""Files that somebody else made: cut off, encrypted, packed oddly, lying about their size: one named error, little memory."""

from __future__ import annotations

import random
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from daemon.errors import ClipError, LogError
from daemon.gestures.clips import load_clips
from daemon.gestures.library import SHIPPED
from daemon.recording.mcap_reading import read_log
from daemon.recording.rotation import RotatingLog
from daemon.shared_memory.bus_link import cycle_dtype
from mmm_core.errors import MmmError, MotionFileError
from mmm_core.imports.recordings.files import read_motion
from mmm_core.motion.motion import load_npz
from retarget.robot.loading import load_robot
from tests.support.kinematic import raised_arm

pytestmark = pytest.mark.timeout(120)
FLIPS = 150


@pytest.fixture
def motion(tmp_path) -> bytes:
    raised_arm("wave", 1.0, 0.8, "left").save_npz(tmp_path / "good.npz")
    return (tmp_path / "good.npz").read_bytes()


def with_method(data: bytes, method: int) -> bytes:
    """The same archive, each member said to be packed in another way."""
    changed = bytearray(data)
    for mark, offset in ((b"PK\3\4", 8), (b"PK\1\2", 10)):
        at = changed.find(mark)
        while at >= 0:
            changed[at + offset : at + offset + 2] = method.to_bytes(2, "little")
            at = changed.find(mark, at + 4)
    return bytes(changed)


def encrypted(data: bytes) -> bytes:
    """The same archive, each member said to be encrypted."""
    changed = bytearray(data)
    for mark, offset in ((b"PK\3\4", 6), (b"PK\1\2", 8)):
        at = changed.find(mark)
        while at >= 0:
            changed[at + offset] |= 1
            at = changed.find(mark, at + 4)
    return bytes(changed)


@pytest.mark.parametrize("load", [load_npz, load_clips, read_motion])
def test_an_odd_zip_is_one_named_error(tmp_path, motion, load):
    """Encrypted ones raised RuntimeError, unknown packings NotImplementedError, cut ones BadZipFile: `internal` to who asked."""
    clips = SHIPPED.read_bytes()
    whole = clips if load is load_clips else motion
    rng = random.Random(7)
    odd = {f"packed by method {n}": with_method(whole, n) for n in (1, 6, 9, 12, 14, 97)} | {
        f"cut at {n}": whole[:n] for n in (0, 1, 30, len(whole) // 2, len(whole) - 1)
    }
    odd["encrypted"] = encrypted(whole)
    for n in range(FLIPS):
        flipped = bytearray(whole)
        for _ in range(rng.choice((1, 3, 30))):
            flipped[rng.randrange(len(flipped))] = rng.randrange(256)
        odd[f"bytes changed, {n}"] = bytes(flipped)
    refused = 0
    for name, data in odd.items():
        path = tmp_path / "odd.npz"
        path.write_bytes(data)
        try:
            load(path)
        except (MmmError, ClipError) as error:
            refused += 1
            assert str(path) in str(error), name
        else:
            assert "changed" in name, name
    assert refused > FLIPS // 3


def write_lying(path: Path, shape: tuple[int, ...], n_bytes: int) -> Path:
    header = repr({"descr": "<f4", "fortran_order": False, "shape": shape}).encode()
    header += b" " * (-(len(header) + 11) % 64) + b"\n"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        data = b"\x93NUMPY\1\0" + len(header).to_bytes(2, "little") + header + bytes(n_bytes)
        archive.writestr("joints.npy", data)
        archive.writestr("fps.npy", b"\x93NUMPY\1\0" + len(header).to_bytes(2, "little") + header)
    return path


@pytest.mark.parametrize(
    ("shape", "n_bytes", "says"),
    [
        ((10**9, 22, 3), 1000, "in 1"),
        ((10**30,), 1000, "in 1"),
        ((-1, 22, 3), 1000, "shape"),
        ((200_000, 22, 3), 200_000 * 264, "frames|bytes"),
        pytest.param((500_000, 22, 3), 500_000 * 264, "bytes", marks=pytest.mark.long),
    ],
)
def test_a_file_that_unpacks_to_too_much_is_refused_before_unpacking(tmp_path, shape, n_bytes, says):
    """2 MB of zeros, said to be a motion of 10,000 s, took 1.5 GB."""
    path = write_lying(tmp_path / "bomb.npz", shape, n_bytes)
    with pytest.raises(MotionFileError, match=says):
        load_npz(path)


def test_a_motion_of_10000_s_takes_no_gigabyte(tmp_path):
    path = tmp_path / "long.npz"
    np.savez_compressed(path, joints=np.zeros((200_000, 22, 3), np.float32), fps=20.0)
    code = f"""
import resource
from mmm_core.errors import MotionFileError
from mmm_core.motion.motion import load_npz
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
try:
    load_npz({str(path)!r})
except MotionFileError as error:
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True).stdout
    assert int(said) < 200_000, f"{said} KiB more"


def test_a_damaged_log_is_read_up_to_the_damage_or_refused_by_name(tmp_path):
    robot, rng = load_robot("reference"), random.Random(3)
    rows = np.zeros(300, cycle_dtype(robot.n_joints, robot.n_servos))
    with RotatingLog(tmp_path / "run.mcap", robot, 0, 0) as log:
        for row in rows:
            log.cycle(row)
        log.event("v1/event", b'{"type": "accepted", "plan_id": 3, "text": "wave"}')
    whole = (tmp_path / "run.mcap").read_bytes()
    for _ in range(FLIPS):
        damaged = bytearray(whole[: rng.choice((len(whole), rng.randrange(len(whole))))])
        for _ in range(rng.choice((1, 3, 30))):
            damaged[rng.randrange(len(damaged))] = rng.randrange(256) if damaged else 0
        (tmp_path / "damaged.mcap").write_bytes(bytes(damaged))
        try:
            read_log(tmp_path / "damaged.mcap")
        except LogError as error:
            assert "damaged.mcap" in str(error)


BVH = """HIERARCHY
ROOT Hips
{
OFFSET 0 0 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 10 0
}
}
MOTION
Frames: 2
Frame Time: 0.05
0 0 0 0 0 0
0 0 0 0 0 1
"""


def test_a_damaged_bvh_is_one_named_error(tmp_path):
    rng, path = random.Random(5), tmp_path / "odd.bvh"
    texts = [
        "ROOT a {" * 5000,
        "HIERARCHY\n" + "ROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n" * 3000,
        BVH.replace("Frames: 2", "Frames: 99999999"),
    ]
    texts += [BVH.replace("6 X", f"{10**n} X") for n in (3, 9, 40)] + [
        BVH.replace("0.05", text) for text in ("0", "-1", "nan", "1e-300", "")
    ]
    for _ in range(FLIPS):
        words = BVH.split(" ")
        for _ in range(rng.choice((1, 3))):
            words[rng.randrange(len(words))] = rng.choice(
                ("", "{", "}", "nan", "1e999", "-1", "JOINT", "9" * 5000, "\n", "\0")
            )
        texts.append(" ".join(words))
    for text in texts:
        path.write_text(text)
        with pytest.raises(MmmError) as caught:
            read_motion(path)
        assert "odd.bvh" in str(caught.value)
