"""Builds the package for ROS 2: `colcon build`."""

from setuptools import setup

setup(
    name="mmmd_bridge",
    version="0.1.0",
    packages=["mmmd_bridge"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/mmmd_bridge"]),
        ("share/mmmd_bridge", ["package.xml"]),
        ("share/mmmd_bridge/launch", ["launch/robot.launch.xml"]),
    ],
    install_requires=["setuptools"],
    entry_points={"console_scripts": ["bridge = mmmd_bridge.bridge:main"]},
)
