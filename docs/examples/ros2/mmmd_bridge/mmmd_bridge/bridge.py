"""A bridge from ROS 2 to one daemon: texts as an action, stop and e-stop as services, measured joint angles as a topic.

    ros2 action send_goal --feedback /say mmmd_interfaces/action/Say "{text: wave with your right hand}"
    ros2 service call /stop std_srvs/srv/Trigger

Stop and e-stop are services, so that they never wait for an action. Only people arm after an e-stop or a fault: `mmmd arm`.
"""

import threading

import rclpy
from mmmd_interfaces.action import Say
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from daemon.client import Client, NoAnswerError
from daemon.settings.config import Endpoints
from daemon.wire.events import Ack, Done, Progress, Refusal
from daemon.wire.requests import Say as SayRequest

CANCEL_POLL_S = 0.05


class Bridge(Node):
    """Forwards between ROS and one daemon. A client is for one thread: each callback has its own."""

    def __init__(self) -> None:
        super().__init__("mmmd")
        default = Endpoints.of_environment()
        names = ("cmd", "ctl", "pub")
        self._at = Endpoints(*(self.declare_parameter(name, getattr(default, name)).value for name in names))
        group = ReentrantCallbackGroup()
        self._joints = self.create_publisher(JointState, "joint_states", 10)
        self._server = ActionServer(
            self, Say, "say", self._say, callback_group=group,
            goal_callback=lambda _: GoalResponse.ACCEPT, cancel_callback=lambda _: CancelResponse.ACCEPT,
        )  # fmt: skip
        for name in ("stop", "estop"):
            self.create_service(Trigger, name, lambda _, reply, n=name: self._halt(n, reply), callback_group=group)
        threading.Thread(target=self._publish_joints, name="joint states", daemon=True).start()

    def _say(self, goal):
        """Carry out a goal: its stages are the feedback, and a goal that is cancelled is cancelled at the daemon."""
        result, ended = Say.Result(), threading.Event()
        request = SayRequest(id=bytes(goal.goal_id.uuid).hex(), text=goal.request.text, tempo=goal.request.tempo)
        threading.Thread(target=self._cancel_when_asked, args=(goal, request.id, ended), daemon=True).start()
        try:
            with Client(self._at) as robot:
                for event in robot.events_of(request):
                    if isinstance(event, Progress):
                        goal.publish_feedback(Say.Feedback(stage=event.stage))
                    if event.terminal:
                        result.done = isinstance(event, Done | Ack)  # an `ack` answers a text that means to stop
                        result.how = event.message if isinstance(event, Refusal) else type(event).__name__.lower()
                    if isinstance(event, Done) and event.seen:
                        result.how = event.seen
        except NoAnswerError as error:
            result.how = str(error)
        finally:
            ended.set()
        if result.done:
            goal.succeed()
        elif goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()
        return result

    def _cancel_when_asked(self, goal, command_id: str, ended: threading.Event) -> None:
        while not ended.wait(CANCEL_POLL_S):
            if goal.is_cancel_requested:
                with Client(self._at) as robot:
                    robot.cancel(command_id)
                return

    def _halt(self, verb: str, reply):
        """Stop or e-stop; `success` says whether a bus cycle has carried it out already."""
        try:
            with Client(self._at) as robot:
                ack = getattr(robot, verb)(wait=False)
            reply.success, reply.message = bool(ack.carried_out), f"the robot was {ack.state}"
        except NoAnswerError as error:
            reply.success, reply.message = False, str(error)
        return reply

    def _publish_joints(self) -> None:
        """Publish each state of the daemon, also of one that comes back, until ROS ends."""
        with Client(self._at) as robot:
            while rclpy.ok():
                try:
                    for _, state in robot.watch("v1/state"):
                        if not rclpy.ok():
                            return
                        message = JointState(name=state.joint_names, position=state.present_rad)
                        message.header.stamp = self.get_clock().now().to_msg()
                        self._joints.publish(message)
                except NoAnswerError as error:
                    self.get_logger().warning(str(error))


def main() -> None:
    """Serve until interrupted."""
    rclpy.init()
    try:
        rclpy.spin(Bridge(), executor=MultiThreadedExecutor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
