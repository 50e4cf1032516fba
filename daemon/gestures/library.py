"""Named gestures: those that ship, and the user's own in a folder, which take precedence over shipped ones of the same name."""

from __future__ import annotations

import difflib
import logging
import os
import re
from pathlib import Path

from daemon.errors import ClipError, GestureExistsError, GestureNameError, UnknownGestureError
from daemon.gestures.clips import Clip, load_clips, save_clips
from daemon.poses.cycles import marks_of
from daemon.poses.pose_sequence import PoseSequence, at_tempo
from daemon.wire.status import GestureInfo
from mmm_core.motion.motion import FPS

log = logging.getLogger(__name__)

SHIPPED = Path(__file__).with_name("shipped.npz")
_NAME = re.compile(r"[a-z0-9][a-z0-9_]{0,63}")
MOST_OWN = 10_000
LONGEST_CLIP_S = 60.0


def own_folder() -> Path:
    """Folder of the user's gestures: $MMMD_GESTURES, else mmmd/gestures in the user's data folder."""
    if chosen := os.environ.get("MMMD_GESTURES"):
        return Path(chosen)
    data = os.environ.get("XDG_DATA_HOME") or str(Path.home() / ".local" / "share")
    return Path(data) / "mmmd" / "gestures"


class GestureLibrary:
    """Clips by name. A user's file is read again when it has changed; for one thread."""

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder or own_folder()
        self._shipped = load_clips(SHIPPED)
        self._own: dict[str, tuple[int, Clip]] = {}

    def get(self, name: str) -> Clip:
        """The clip with that name.

        Raises:
            UnknownGestureError: no clip has the name; the error lists the nearest names.
            ClipError: the user's file of that name is damaged.
        """
        own = self._read_own(name) if _NAME.fullmatch(name) else None
        clip = own or self._shipped.get(name)
        if clip is None:
            names = [*self._shipped, *self._own_names()]
            raise UnknownGestureError(name, difflib.get_close_matches(name, names, 4, 0.5), len(names))
        return clip

    def check_name(self, name: str, *, replace: bool = False) -> None:
        """Refuse a name that `keep` would refuse.

        Raises:
            GestureExistsError: there is one of that name, and `replace` is not given.
            GestureNameError: the name is not allowed.
        """
        if not _NAME.fullmatch(name):
            raise GestureNameError(name)
        if not replace and (name in self._shipped or self._path(name).exists()):
            raise GestureExistsError(name, own=self._path(name).exists())

    def keep(
        self, name: str, text: str, posture: PoseSequence, source: str, *, side: str = "", replace: bool = False
    ) -> Clip:
        """Write a clip to the user's folder.

        Args:
            name: name of the clip.
            text: text of the motion.
            posture: its poses.
            source: origin of the motion.
            side: arms with which the clip was taught.
            replace: overwrite a clip with the same name.

        Raises:
            GestureExistsError: there is one of that name, and `replace` is not given.
            ClipError: the name or the length is not allowed, or the file cannot be written.
        """
        self.check_name(name, replace=replace)
        if not 2 <= len(posture) <= LONGEST_CLIP_S * posture.fps:
            seconds = len(posture) / posture.fps
            raise ClipError(f"gesture '{name}': {seconds:.2f} s of motion; allowed: 2 frames to {LONGEST_CLIP_S:g} s")
        if posture.fps != FPS:
            posture = at_tempo(posture, posture.fps / FPS)
        clip = Clip(name, text, posture, marks_of(posture), source=source, side=side)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            save_clips(self._path(name), {name: clip})
        except OSError as error:
            raise ClipError(
                f"gesture '{name}': {self._path(name)} cannot be written ({error}); choose another folder by MMMD_GESTURES"
            ) from error
        return clip

    def infos(self) -> list[GestureInfo]:
        """All clips, sorted by name; damaged files of the user are left out and logged."""
        own: dict[str, Clip] = {}
        for name in self._own_names():
            try:
                if (clip := self._read_own(name)) is not None:
                    own[name] = clip
            except ClipError as error:
                log.warning("%s", error)
        every = {**self._shipped, **own}
        return [_info(every[name], name in own) for name in sorted(every)]

    def _path(self, name: str) -> Path:
        return self.folder / f"{name}.npz"

    def _own_names(self) -> list[str]:
        try:
            found = sorted(p.stem for p in self.folder.glob("*.npz") if _NAME.fullmatch(p.stem))
        except OSError:
            return []
        return found[:MOST_OWN]

    def _read_own(self, name: str) -> Clip | None:
        path = self._path(name)
        try:
            changed_ns = path.stat().st_mtime_ns
        except OSError:
            self._own.pop(name, None)
            return None
        known = self._own.get(name)
        if known is None or known[0] != changed_ns:
            clips = load_clips(path)
            if name not in clips:
                raise ClipError(
                    f"{path}: holds {', '.join(clips) or 'nothing'}, not '{name}'; `mmmd gesture add` names it"
                )
            known = self._own[name] = (changed_ns, clips[name])
        return known[1]


def _info(clip: Clip, own: bool) -> GestureInfo:
    p = clip.posture
    return GestureInfo(
        name=clip.name, text=clip.text, seconds=round(len(p) / p.fps, 2), loop=clip.marks.loop is not None,
        hold_s=round(clip.marks.hold / p.fps, 2), mirror=clip.mirror, own=own, side=clip.side,
    )  # fmt: skip
