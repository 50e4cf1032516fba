"""Finds the motions that an edit, a replay or a pose starts from: a clip, the motion of a command or plan, or a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from daemon.errors import ClipError, UnknownGestureError
from daemon.gestures.clips import Clip
from daemon.gestures.library import GestureLibrary
from daemon.playback.sources.kept_motions import KeptMotion, KeptMotions
from daemon.poses.cycles import marks_of
from daemon.poses.key_poses import KeyPose
from daemon.poses.pose_sequence import standing
from daemon.state.replies import NotPlayableError
from daemon.wire.events import Failed, Rejected
from daemon.wire.requests import Edit, KeyPoseOf, Replay
from mmm_core.errors import MotionFileError
from mmm_core.motion.motion import Motion, load_npz

LARGEST_FILE_BYTES = 64 * 2**20


class Originals:
    """Finds motions by the names that a request may use.

    Args:
        library: named clips.
        kept: motions of commands.
        folder: folder of the files of motions.
    """

    def __init__(self, library: GestureLibrary, kept: KeptMotions, folder: Path) -> None:
        self._library, self._kept, self._folder = library, kept, folder

    def clip(self, name: str) -> Clip:
        """A named clip.

        Raises:
            NotPlayableError: the clip is unknown, or cannot be read.
        """
        try:
            return self._library.get(name)
        except UnknownGestureError as error:
            near = ", ".join(error.near) or "see `mmmd gesture list`"
            event = Rejected(
                code="unknown_gesture", asked=f"gesture {name!r}", found="no gesture of that name", allowed=near,
                do="`mmmd gesture list` shows all",
            )  # fmt: skip
            raise NotPlayableError(event) from error
        except ClipError as error:
            event = Failed(code="bad_gesture", asked=f"gesture {name!r}", found=str(error), allowed="", do="")
            raise NotPlayableError(event) from error

    def motion(self, request: Edit | Replay) -> Motion:
        """The motion to edit or to play again; may read a file.

        Raises:
            NotPlayableError: the motion is unknown, or the file holds none.
        """
        if isinstance(request, Edit) and request.gesture is not None:
            return self.clip(request.gesture).posture.motion(text=request.gesture)
        if request.file is not None:
            return self._file(request.file)
        if request.plan is not None:
            return self._found(self._kept.of_plan(request.plan), f"plan {request.plan}").motion
        assert request.command is not None, "the request says what is edited"
        return self._found(self._kept.of_command(request.command), f"command {request.command!r}").motion

    def pose(self, asked: KeyPoseOf) -> KeyPose:
        """The pose that a request names.

        Raises:
            NotPlayableError: the clip or command is unknown, or the time is outside its motion.
        """
        if asked.standing:
            return KeyPose(asked.at_s, standing())
        if asked.gesture is not None:
            clip = self.clip(asked.gesture)
            posture, hold = clip.posture, clip.marks.hold
        else:
            assert asked.command is not None, "the request says which pose"
            posture = self._found(self._kept.of_command(asked.command), f"command {asked.command!r}").posture
            hold = marks_of(posture).hold if asked.time_s is None else 0
        frame = hold if asked.time_s is None else round(asked.time_s * posture.fps)
        if frame >= len(posture):
            event = Rejected(
                code="bad_keyframes", asked=f"the pose at {asked.time_s:g} s of {asked.gesture or asked.command!r}",
                found=f"a motion of {len(posture) / posture.fps:.2f} s", allowed="a time within it", do="correct `time_s`",
            )  # fmt: skip
            raise NotPlayableError(event)
        return KeyPose(asked.at_s, posture.at(np.array([frame])))

    def _found(self, kept: KeptMotion | None, name: str) -> KeptMotion:
        if kept is None:
            event = Rejected(
                code="unknown_motion", asked=f"the motion of {name}", found="it is not known, or no longer",
                allowed=f"one of the newest 32 that are no story; the newest: {self._kept.some()}", do="play it once more",
            )  # fmt: skip
            raise NotPlayableError(event)
        return kept

    def _file(self, name: str) -> Motion:
        folder = self._folder.resolve()
        path = (folder / name).resolve()
        found = ""
        if not path.is_relative_to(folder):
            found = "a path that leads out of that folder"
        elif not path.is_file():
            found = "no such file"
        elif path.stat().st_size > LARGEST_FILE_BYTES:
            found = f"{path.stat().st_size} bytes"
        else:
            try:
                return load_npz(path)
            except (MotionFileError, OSError, MemoryError) as error:
                found = str(error)
        event = Rejected(
            code="bad_file", asked=f"the motion in {name!r}", found=found,
            allowed=f"an .npz of `mmmd generate` in the daemon's folder of motions ({folder}), at most 64 MiB",
            do="put it there, or start the daemon with --motions FOLDER",
        )  # fmt: skip
        raise NotPlayableError(event)
