"""A ROS 2 bridge: an action server that says texts, with goal, feedback and cancel, and the robot's joint states.

Not tested against ROS here (the tests only compile this file): it needs rclpy, sensor_msgs and an action type of yours,

    # mmmd_interfaces/action/Say.action
    string text
    float32 tempo 1.0
    ---
    bool done
    string how
    ---
    string stage

Run it beside `mmmd run`: `python ros2_bridge.py`. Stop and e-stop are services, so that they never wait for an action.
"""

import threading

import rclpy
from mmmd_interfaces.action import Say
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from daemon.client import Client
from daemon.wire.events import Done, Progress, Refusal
from daemon.wire.requests import Say as SayRequest


class Bridge(Node):
    """Forwards between ROS and one daemon. A client is for one thread: each callback has its own."""

    def __init__(self) -> None:
        super().__init__("mmmd")
        group = ReentrantCallbackGroup()
        self._joints = self.create_publisher(JointState, "joint_states", 10)
        self._server = ActionServer(
            self, Say, "say", self._say, callback_group=group,
            goal_callback=lambda _: GoalResponse.ACCEPT, cancel_callback=lambda _: CancelResponse.ACCEPT,
        )  # fmt: skip
        for name in ("stop", "estop"):
            self.create_service(Trigger, name, lambda _, reply, n=name: self._verb(n, reply), callback_group=group)
        threading.Thread(target=self._publish_joints, daemon=True).start()

    def _say(self, goal):
        result, command_id = Say.Result(), bytes(goal.goal_id.uuid).hex()
        watcher = threading.Thread(target=self._cancel_when_asked, args=(goal, command_id), daemon=True)
        watcher.start()
        with Client() as robot:
            request = SayRequest(id=command_id, text=goal.request.text, tempo=goal.request.tempo or 1.0)
            for event in robot.events_of(request):
                if isinstance(event, Progress):
                    goal.publish_feedback(Say.Feedback(stage=event.stage))
                if event.terminal:
                    result.done = isinstance(event, Done)
                    result.how = event.message if isinstance(event, Refusal) else type(event).__name__.lower()
        if result.done:
            goal.succeed()
        elif goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()
        return result

    def _cancel_when_asked(self, goal, command_id: str) -> None:
        rate = self.create_rate(20)
        while rclpy.ok() and goal.is_active:
            if goal.is_cancel_requested:
                with Client() as robot:
                    robot.cancel(command_id)
                return
            rate.sleep()

    def _verb(self, name: str, reply):
        with Client() as robot:
            ack = getattr(robot, name)(wait=False)
        reply.success, reply.message = True, f"{name} in {ack.state}"
        return reply

    def _publish_joints(self) -> None:
        with Client() as robot:
            for _, state in robot.watch("v1/state"):
                message = JointState(name=state.joint_names, position=state.present_rad)
                message.header.stamp = self.get_clock().now().to_msg()
                self._joints.publish(message)


def main() -> None:
    """Serve until interrupted."""
    rclpy.init()
    rclpy.spin(Bridge(), executor=MultiThreadedExecutor())


if __name__ == "__main__":
    main()
