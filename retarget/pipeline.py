"""From a human motion to a joint path of a robot; the order of the steps stands in this file alone.

human -> waist -> neck -> arms -> rest of unobservable joints -> limits -> self-contact -> spline.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from retarget.errors import MotionError
from retarget.human.arm_chain import ArmChain
from retarget.human.hand_contacts import Hands, HumanContacts, read_contacts
from retarget.human.human import HumanMotion, HumanPose, read_human
from retarget.human.poser import ArmsFollow, Poser, Poses
from retarget.path.avoidance import Avoidance
from retarget.path.blocks import BlockPlanner
from retarget.path.collision import SelfContact
from retarget.path.limits import JointLimits
from retarget.path.paths import JointPath, JointState
from retarget.path.report import BONES, Comparison
from retarget.robot.kinematics import Kinematics
from retarget.robot.robot import RobotModel

Array = NDArray[np.float64]
_MOST_FPS = 1000
BLOCK_FRAMES, _AHEAD_FRAMES = 24, 8
"""Frames of a block, in which a long motion is retargeted, and frames after each block that its solution looks ahead (0.4 s)."""
_STRETCHES = (1.25, 1.5, 2.0, 2.5, 3.0, 4.0)
"""Factors by which a motion is slowed down, tried in this order until the requested direction error is kept."""
_WORTH = 0.97
"""Largest share of the direction error that a slower path may leave; with more, slowing down counts as useless and ends."""


@dataclass(frozen=True)
class _Wanted:
    """Demands of a motion on a robot.

    Attributes:
        poses: the robot's poses, and the directions of the person's bones.
        aims: the poses of `poses`; where a hand is drawn to a contact, with the robot's bone directions instead of the person's.
        contacts: contacts of the person's hands.
    """

    poses: Poses
    aims: Poses
    contacts: HumanContacts

    def stretched(self, times: float) -> _Wanted:
        """The demands, `times` times slower."""
        return replace(self, poses=self.poses.stretched(times), aims=self.aims.stretched(times))


class Retargeter:
    """Turns human motions into joint paths of one robot.

    Attributes:
        robot, kinematics, limits: the robot.
        arms: left and right arm.
        contact: distances between the robot's shapes.
    """

    def __init__(
        self,
        robot: RobotModel,
        arms_follow: ArmsFollow = "chest",
        *,
        keep_contacts: bool = False,
        contact: SelfContact | None = None,
    ) -> None:
        """Set up for a robot.

        Args:
            robot: the robot.
            arms_follow: frame in which the arms keep their directions: the chest's, or the world's as the pelvis faces it.
            keep_contacts: whether hands that touch each other or the body touch on the robot too, whatever its proportions.
            contact: distances between the robot's shapes; None builds them from its description.
        """
        self.robot = robot
        self.kinematics = Kinematics(robot)
        self.limits = JointLimits.of(robot)
        self._poser = Poser(self.kinematics, self.limits, arms_follow)
        self.arms: tuple[ArmChain, ...] = self._poser.chains
        self.contact = contact or SelfContact(robot)
        self._hands = Hands(self.kinematics, self.contact, self.limits) if keep_contacts else None
        self._avoidance = Avoidance(robot, self.contact, self.limits, self._poser.yielding)
        in_arms = [int(j) for arm in self.arms for j in arm.joints]
        self._planner = BlockPlanner(self.contact, self.limits, self._avoidance, self._poser.objective, in_arms)

    def retarget(
        self,
        motion: HumanMotion,
        start: JointState | None = None,
        *,
        settle: bool = True,
        most_error_deg: float | None = None,
    ) -> JointPath:
        """The robot's path for a motion.

        Args:
            motion: T frames at `motion.fps`.
            start: last commanded state of the joints, from which the path continues. None: at rest in the first frame's pose.
            settle: whether the path ends at rest, with a few more frames where braking needs them.
            most_error_deg: largest mean direction error; a motion with a larger one is slowed down until the error is kept or
                slowing down does not help. The report's `time_stretch` has the factor. None never slows down.

        Raises:
            MotionError: the motion is empty or has bones that no human has.
        """
        wanted = self._wanted(motion, start)
        path = self._path(wanted, motion.fps, start, settle, 1.0)
        for stretch in _STRETCHES:
            if most_error_deg is None or path.report.direction_mean_deg <= most_error_deg:
                break
            slower = self._path(wanted.stretched(stretch), motion.fps, start, settle, stretch)
            if slower.report.direction_mean_deg > _WORTH * path.report.direction_mean_deg:
                break
            path = slower
        return path

    def pieces(
        self,
        motion: HumanMotion,
        start: JointState | None = None,
        *,
        settle: bool = True,
        first_at_once: bool = False,
        block_frames: int = BLOCK_FRAMES,
    ) -> Iterator[tuple[JointPath, int]]:
        """The path in blocks, each yielded as soon as it is solved, with the number of motion frames in the block.

        Each block begins where the previous one ends. Braking at the end of a block is free of contact, so that playback may
        end there. With `BLOCK_FRAMES` the blocks together are the path of `retarget`.

        Args:
            motion: as in `retarget`.
            start: as in `retarget`.
            settle: as in `retarget`.
            first_at_once: whether the first block is needed soon. Near a contact it then keeps every limit and touches
                nothing, but follows the motion less closely than it could.
            block_frames: frames of all blocks but the last, 1 or more.

        Raises:
            MotionError: as in `retarget`.
        """
        wanted, first = self._wanted(motion, start), 0
        poses, begin = wanted.poses, self._begin(wanted.poses.q_rad, start)
        for block, n, changes in self._blocks(
            wanted.aims, begin, 1.0 / motion.fps, settle, first_at_once, block_frames
        ):
            part = poses.part(slice(first, first + n))
            yield self._joint_path(block, part, HumanContacts({}), motion.fps, changes, 1.0), n
            first += n

    def _wanted(self, motion: HumanMotion, start: JointState | None) -> _Wanted:
        if not 1 <= motion.fps <= _MOST_FPS:
            raise MotionError("fps", str(motion.fps), f"1 to {_MOST_FPS} frames per second")
        poses = self.poses(read_human(motion), start)
        contacts = read_contacts(motion) if self._hands else HumanContacts({})
        if self._hands is None or not contacts.any:
            return _Wanted(poses, poses, contacts)
        drawn = replace(poses, q_rad=self._hands.keep(poses.q_rad, contacts))
        moved = (drawn.q_rad != poses.q_rad).any(1)[:, None]
        own = self._poser.directions(drawn.q_rad)
        upper, fore = (np.where(moved, d, of) for d, of in zip(own, (poses.upper, poses.fore), strict=True))
        return _Wanted(drawn, replace(drawn, upper=upper, fore=fore), contacts)

    def _path(self, wanted: _Wanted, fps: float, start: JointState | None, settle: bool, stretch: float) -> JointPath:
        """The path through the poses that keeps every limit and is free of contact."""
        blocks = list(self._blocks(wanted.aims, self._begin(wanted.poses.q_rad, start), 1.0 / fps, settle))
        path = np.concatenate([block if i == 0 else block[2:] for i, (block, _, _) in enumerate(blocks)])
        return self._joint_path(
            path, wanted.poses, wanted.contacts, fps, sum(changes for _, _, changes in blocks), stretch
        )

    def _joint_path(
        self, path: Array, poses: Poses, contacts: HumanContacts, fps: float, interventions: int, stretch: float
    ) -> JointPath:
        ends = self.limits.position_min_rad, self.limits.position_max_rad
        comparison = self._compare(poses, contacts, path, fps, interventions, stretch)
        return JointPath(path, self.robot.joint_names, fps, comparison, ends)

    def _blocks(
        self, poses: Poses, begin: JointState, period: float, settle: bool, first_at_once: bool = False,
        block_frames: int = BLOCK_FRAMES,
    ) -> Iterator[tuple[Array, int, int]]:  # fmt: skip
        """Yields for each block its control points, its number of frames, and how often avoidance changed it.

        The first two control points of a block are the last two of the previous block.
        """
        posed, T, first = poses.q_rad, len(poses.q_rad), 0
        while first < T:
            # The solution of a block looks ahead at the frames after it; a remainder no longer than that joins the block.
            is_last = first + block_frames + _AHEAD_FRAMES >= T
            last = T if is_last else first + block_frames + _AHEAD_FRAMES
            keep = last - first if is_last else block_frames
            view = posed[max(first - 1, 0) : last]
            at_once = first_at_once and first == 0
            shown = None if at_once else partial(self._poser.shown, poses.part(slice(first, last)))
            block, changes = self._planner.plan(view, shown, begin, period, keep, settle and is_last, first > 0)
            block = block if is_last else block[: keep + 2]
            yield block, keep, changes
            begin = JointState((block[-2] + block[-1]) / 2, (block[-1] - block[-2]) / period)
            first += keep

    def poses(self, human: HumanPose, start: JointState | None = None) -> Poses:
        """The pose of each frame within the position limits; velocity, acceleration and contacts are not yet limited."""
        return self._poser.solve(human, None if start is None else start.position_rad)

    def solve(self, human: HumanPose, start: JointState | None = None) -> Array:
        """(T, J) joint angles of `poses`, in radians."""
        return self.poses(human, start).q_rad

    def direction_errors_deg(self, poses: Poses, q_rad: Array) -> Array:
        """(4, T) angles in degrees between human and robot bones in poses (T, J), in the order of `report.BONES`."""
        found = np.concatenate(self._poser.directions(q_rad))
        wanted = np.concatenate([poses.upper, poses.fore])[:, : len(q_rad)]
        # The arc tangent is exact for small angles too; an arc cosine is not.
        apart, sum_ = np.linalg.norm(found - wanted, axis=-1), np.linalg.norm(found + wanted, axis=-1)
        errors = np.rad2deg(2 * np.arctan2(apart, sum_))
        assert len(errors) == len(BONES)
        return errors

    def missed(self, poses: Poses, q_rad: Array) -> Array:
        """(4, T, 3) weighted difference of human and robot bones in poses (T, J); the poses minimise the sum of its squares.

        With equal weights the rows stand in the order of `report.BONES`; unequal weights mix upper arm and forearm.
        """
        upper, fore = self._poser.directions(q_rad)
        T = len(q_rad)
        apart = np.stack([poses.upper[:, :T] - upper, poses.fore[:, :T] - fore], 2)  # (2, T, 2, 3)
        root = np.linalg.cholesky(poses.weights[:, :T])
        return (np.swapaxes(root, -1, -2) @ apart).transpose(2, 0, 1, 3).reshape(4, T, 3)

    def shown(self, poses: Poses, q_rad: Array) -> tuple[Array, Array]:
        """Half the weighted squared error of all bones linearised at poses (T, J): Hessian (T, J, J) and descent (T, J)."""
        return self._poser.shown(poses, q_rad)

    def _begin(self, wanted: Array, start: JointState | None) -> JointState:
        """`start`; where that is None, rest in the first frame's pose, pushed out of contacts."""
        if start is not None:
            return start
        first, _ = self._avoidance.push_out(wanted[:1], self.robot.rest_rad)
        return JointState(first[0], np.zeros(self.robot.n_joints))

    def _compare(
        self, poses: Poses, contacts: HumanContacts, path: Array, rate_hz: float, interventions: int, stretch: float
    ) -> Comparison:
        """Comparison of a path with the poses and contacts that the motion demands, frame by frame."""
        T = len(poses.q_rad)
        q = ((path[1:-1] + path[2:]) / 2)[:T]
        hands = self._hands if stretch == 1.0 else None
        return Comparison(
            self.robot.joint_names, lambda: self.direction_errors_deg(poses, q), poses.q_rad - q, poses.outside, path,
            rate_hz, self.limits, interventions, lambda: hands.kept(q, contacts) if hands else {}, stretch,
        )  # fmt: skip
