"""Key folders of a robot and its client."""

from __future__ import annotations

from daemon.network.keys import KeyFolder


def pair_of_folders(tmp_path) -> tuple[KeyFolder, KeyFolder]:
    """A daemon's keys and a client's, who know each other."""
    robot, laptop = KeyFolder(tmp_path / "robot"), KeyFolder(tmp_path / "laptop")
    robot.allow("laptop", laptop.new().public.decode())
    laptop.trust("daemon", robot.new().public.decode())
    return robot, laptop
