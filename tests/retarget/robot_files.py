"""Small robot files for tests: a description with the joints asked for, in a row, and a robot.toml beside it."""

from __future__ import annotations

from pathlib import Path


def joint(name: str, role: str, limits: str = "[-60, 60]", servo: str = "", more: str = "") -> str:
    """A [[joint]] of a robot file; without `servo` it has none of its own."""
    drive = f"servo = {servo}\n" if servo else ""
    return f'[[joint]]\nname = "{name}"\nrole = "{role}"\nposition_limit_deg = {limits}\n{drive}{more}\n'


def write_robot(folder: Path, body: str, protocol: float = 2.0, margin: float = 0.9) -> Path:
    """Write robot.toml and robot.xml; the file's joints are those named in `body`."""
    folder.mkdir(exist_ok=True)
    names = [line.split('"')[1] for line in body.splitlines() if line.startswith("name")]
    bodies = "".join(
        f'<body pos="0 0 .1"><joint name="{name}" axis="{"0 1 0" if i % 2 else "1 0 0"}"/><geom size=".02"/>'
        for i, name in enumerate(names)
    )
    (folder / "robot.xml").write_text(f"<mujoco><worldbody>{bodies}{'</body>' * len(names)}</worldbody></mujoco>")
    head = (
        'format = 1\nname = "small"\ndescription = "robot.xml"\nlicence = "ours"\n'
        f"[bus]\nprotocol = {protocol}\nbaud = 1000000\nrate_hz = 100\n"
        f"[motion]\nvelocity_margin = {margin}\nacceleration_limit_deg_s2 = 2000\n"
    )
    (folder / "robot.toml").write_text(head + body)
    return folder / "robot.toml"
