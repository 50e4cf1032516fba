"""The library of gestures: those that ship are what their names say, one's own are kept, damage is named."""

from __future__ import annotations

import numpy as np
import pytest

from daemon.errors import ClipError, GestureExistsError, UnknownGestureError
from daemon.gestures.clips import Clip, load_clips, save_clips
from daemon.gestures.library import SHIPPED, GestureLibrary
from daemon.poses.cycles import marks_of
from daemon.poses.pose_sequence import distance_deg, posture_of, standing
from docs.tools.make_gestures import WANTED, mirror_name
from mmm_core.evaluation.probes import judge
from mmm_core.motion.posture_features import posture_features
from retarget.pipeline import Retargeter
from retarget.robot.loading import load_robot
from tests.support.kinematic import raised_arm
from tests.support.sizes import few_and_long

CLIPS = load_clips(SHIPPED)
P = posture_of(raised_arm("raise", 1.5, 1.3, "right"))


def test_at_least_sixty_ship():
    assert len(CLIPS) >= 60


@pytest.mark.parametrize("wanted", [w for w in WANTED if w.name in CLIPS], ids=lambda w: w.name)
def test_a_shipped_gesture_shows_what_it_is_called(wanted):
    motion = CLIPS[wanted.name].posture.motion()
    verdict = judge(wanted.probe, posture_features(motion.joints_m, motion.head_quat_wxyz))
    assert all(verdict.values()), verdict


def test_shipped_gestures_start_and_end_near_standing_and_name_mirrors():
    names = set(CLIPS)
    for name, clip in CLIPS.items():
        assert distance_deg(standing(), clip.posture.at(np.array([0, len(clip.posture) - 1]))).max() <= 30
        assert clip.mirror == mirror_name(name, names) and clip.source
        assert clip.marks == marks_of(clip.posture) or "mirror image" in clip.source


@pytest.mark.parametrize("robot_name", few_and_long(["reference"], ["reference", "op3"]))
def test_every_fourth_shipped_gesture_fits_the_robots(robot_name):
    """Within limits and clear of itself, by the retargeter's own report; the audit bench plays all of them."""
    retargeter = Retargeter(load_robot(robot_name))
    for clip in list(CLIPS.values())[::4]:
        path = retargeter.retarget(clip.posture.motion())
        assert path.report.peak_speed_share <= 1 + 1e-6 and path.report.peak_acceleration_share <= 1 + 1e-6
        assert not retargeter.contact.along(path.control_rad).any()


def test_what_is_kept_is_found_again_to_a_hundredth_of_a_degree(tmp_path):
    library = GestureLibrary(tmp_path)
    library.keep("my_raise", "raise it", P, "test")
    clip = GestureLibrary(tmp_path).get("my_raise")
    assert clip.text == "raise it" and clip.marks == marks_of(P)
    assert distance_deg(clip.posture, P).max() < 0.02
    info = next(i for i in library.infos() if i.name == "my_raise")
    assert info.own and info.seconds == 1.5
    with pytest.raises(GestureExistsError, match=r"one of your own.*--replace"):
        library.keep("my_raise", "another", P[:10], "test")
    assert library.get("my_raise").text == "raise it"
    library.keep("my_raise", "another", P[:10], "test", replace=True)
    assert library.get("my_raise").text == "another"


def test_ones_own_wins_over_a_shipped_one(tmp_path):
    library = GestureLibrary(tmp_path)
    with pytest.raises(GestureExistsError, match="one that ships"):
        library.keep("nod", "my own nod", P, "test")
    library.keep("nod", "my own nod", P, "test", replace=True)
    assert library.get("nod").text == "my own nod"
    assert [i.own for i in library.infos() if i.name == "nod"] == [True]
    (tmp_path / "nod.npz").unlink()
    assert library.get("nod").text == CLIPS["nod"].text


def test_an_unknown_name_tells_the_near_ones(tmp_path):
    with pytest.raises(UnknownGestureError, match="wave_right") as caught:
        GestureLibrary(tmp_path).get("wave_rigth")
    assert "wave_right" in caught.value.near


@pytest.mark.parametrize("name", ["", "../up", "A", "a b", "x" * 65, "a/b"])
def test_names_that_could_lead_elsewhere_are_refused(tmp_path, name):
    library = GestureLibrary(tmp_path / "own")
    with pytest.raises(ClipError, match="a-z"):
        library.keep(name, "", P, "test")
    with pytest.raises(UnknownGestureError):
        library.get(name)
    assert not (tmp_path / "own").exists() or not list((tmp_path / "own").iterdir())


@pytest.mark.parametrize("n", [1, 5000])
def test_lengths_outside_what_is_allowed_are_refused(tmp_path, n):
    with pytest.raises(ClipError, match="s of motion"):
        GestureLibrary(tmp_path).keep("x", "", P.at(np.zeros(n, np.intp)), "test")


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("no folder")
    with pytest.raises(ClipError, match="MMMD_GESTURES"):
        GestureLibrary(blocked / "own").keep("x", "", P, "test")


def test_damaged_files_are_named_and_do_not_hide_the_others(tmp_path):
    library = GestureLibrary(tmp_path)
    library.keep("good", "", P, "test")
    whole = (tmp_path / "good.npz").read_bytes()
    for name, data in {"cut": whole[: len(whole) // 2], "empty": b"", "noise": b"\x00" * 100}.items():
        (tmp_path / f"{name}.npz").write_bytes(data)
        with pytest.raises(ClipError, match=name):
            library.get(name)
    (tmp_path / "other.npz").write_bytes(whole)
    with pytest.raises(ClipError, match="holds good, not 'other'"):
        library.get("other")
    assert {"good"} == {i.name for i in library.infos() if i.own}


def test_marks_outside_the_frames_are_damage(tmp_path):
    from daemon.poses.cycles import Marks

    save_clips(tmp_path / "x.npz", {"x": Clip("x", "", P, Marks((5, 999), 3))})
    with pytest.raises(ClipError, match="do not fit"):
        load_clips(tmp_path / "x.npz")
