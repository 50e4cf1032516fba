"""A described robot with two arms, and the robot file proposed for it."""

from __future__ import annotations

from pathlib import Path

from retarget.setup.scaffold import propose

ARM = """
<body name="{s}_upper" pos="0 {y} 1">
 <joint name="{s}_pitch" axis="0 1 0" range="-90 90"/> <geom size=".02"/>
 <body name="{s}_roll">
  <joint name="{s}_roll" axis="1 0 0" range="-90 90"/> <geom type="capsule" fromto="0 0 0 0 0 -.15" size=".02"/>
  <body name="{s}_fore" pos="0 0 -.2">
   <joint name="{s}_elbow" axis="0 1 0" range="-120 0"/> <geom type="capsule" fromto="0 0 -.05 0 0 -.2" size=".02"/>
   {more}
  </body>
 </body>
</body>"""


def two_arms(more: str = "", tail: str = "") -> str:
    arms = ARM.format(s="left", y=0.2, more=more) + ARM.format(s="right", y=-0.2, more="")
    return (
        "<mujoco><compiler angle='degree' autolimits='true'/>"
        f"<worldbody><geom type='box' size='.1 .1 .2' pos='0 0 .9'/>{arms}</worldbody>{tail}</mujoco>"
    )


def proposed(tmp_path: Path, xml: str, suffix: str = "xml") -> Path:
    (tmp_path / f"mine.{suffix}").write_text(xml)
    propose(tmp_path / f"mine.{suffix}", tmp_path / "robot.toml", "XM430-W350")
    return tmp_path / "robot.toml"
