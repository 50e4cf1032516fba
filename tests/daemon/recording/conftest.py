"""The recorded cycles that the tests of the log share."""

import numpy as np
import pytest

from daemon.shared_memory.bus_link import BusState
from retarget.robot.robot import RobotModel
from tests.support.rig import rig, swing


@pytest.fixture(scope="module")
def run() -> tuple[RobotModel, list[np.void]]:
    """The records of arming, a motion and parking."""
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 1.0))
        r.until(BusState.PLAYING)
        r.until(BusState.HOLDING)
        return r.robot, r.records
