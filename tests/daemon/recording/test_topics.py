"""Topics of a log for other readers: joints, speeds, transforms and log lines in Foxglove schemas."""

import json
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from daemon.recording.foxglove import GOAL_TOPIC, LOG_TOPIC, MEASURED_TOPIC, SCHEMAS, TRANSFORMS_TOPIC
from daemon.recording.mcap_log import CYCLE_TOPIC, LogWriter
from mmm_core.motion.skeleton import matrix_from_quat
from retarget.robot.kinematics import Kinematics
from retarget.robot.ticks import JointServoMap
from tests.support.logs import write

pytestmark = pytest.mark.realtime


def test_any_mcap_reader_finds_named_and_typed_channels(run, tmp_path):
    """Read with the indexed reader of the `mcap` package, as Foxglove does."""
    path = write(tmp_path / "run.mcap", run)
    with path.open("rb") as f:
        reader = make_reader(f, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None and summary.statistics is not None
        assert {c.topic for c in summary.channels.values()} == {CYCLE_TOPIC, "v1/event", *SCHEMAS}
        assert {c.message_encoding for c in summary.channels.values()} == {"json"}
        times = []
        for schema, _, message in reader.iter_messages(topics=[CYCLE_TOPIC]):
            assert schema is not None and schema.encoding == "jsonschema"
            described = json.loads(schema.data)
            content = json.loads(message.data)
            assert described["type"] == "object"
            assert content.keys() <= described["properties"].keys()
            for name, value in content.items():
                kind = {list: "array", str: "string"}.get(type(value), "number")
                assert described["properties"][name]["type"] == kind
            times.append(message.log_time)
        assert len(times) == len(run[1]) and times == sorted(times)


def test_joints_are_measured_in_radians_by_name_in_foxgloves_schema(run, tmp_path):
    """Ticks by index told nobody who opened a log which joint stood where."""
    robot, records = run
    ticks = JointServoMap(robot)
    for topic in (MEASURED_TOPIC, GOAL_TOPIC):
        messages = read_topic(write(tmp_path / f"{topic[1:]}.mcap", run), topic, "foxglove.JointStates")
        assert 0.4 * len(records) < len(messages) <= len(records)
        of_time = {t_ns: json.loads(m)["t_mono_ns"] for t_ns, m in cycles_of(tmp_path / f"{topic[1:]}.mcap")}
        record_of = {int(record["t_mono_ns"]): record for record in records}
        for t_ns, message in messages:
            record = record_of[of_time[t_ns]]
            wanted = record["goal_rad"] if topic == GOAL_TOPIC else ticks.tick_to_rad(record["present_tick"])
            assert [j["name"] for j in message["joints"]] == list(robot.joint_names)
            assert [j["position"] for j in message["joints"]] == pytest.approx(wanted.tolist())
            assert message["timestamp"] == {"sec": t_ns // 10**9, "nsec": t_ns % 10**9}


def test_measured_speeds_are_those_of_the_angles(run, tmp_path):
    """In radians a second, with the joint's sign: the angle's change over a tenth of a second."""
    messages = read_topic(write(tmp_path / "run.mcap", run), MEASURED_TOPIC, "foxglove.JointStates")
    t_s = np.array([t_ns for t_ns, _ in messages]) * 1e-9
    q, v = (np.array([[j[key] for j in m["joints"]] for _, m in messages]) for key in ("position", "velocity"))
    measured = (q[5:] - q[:-5]) / (t_s[5:] - t_s[:-5])[:, None]
    moving = np.abs(measured).max(0) > 0.5
    assert moving.any()
    for joint in np.flatnonzero(moving):
        meanwhile = np.convolve(v[:, joint], np.full(6, 1 / 6), "valid")
        fast = np.abs(measured[:, joint]) > 0.3
        ratio = np.median(meanwhile[fast] / measured[fast, joint])  # a median: cycles of a busy machine come late
        assert ratio == pytest.approx(1.0, abs=0.25), run[0].joint_names[joint]


def test_a_joint_that_did_not_answer_has_no_angle(run, tmp_path):
    robot, records = run
    record = records[-1].copy()
    record["valid"][0] = 0
    ((_, message),) = read_topic(write(tmp_path / "r.mcap", (robot, [record])), MEASURED_TOPIC, "foxglove.JointStates")
    assert [j for j in message["joints"] if "position" not in j] == [{"name": robot.joint_names[0]}]


def test_transforms_lead_to_where_the_kinematics_put_the_hands(run, tmp_path):
    robot, records = run
    kinematics = Kinematics(robot)
    path = write(tmp_path / "run.mcap", run)
    messages = read_topic(path, TRANSFORMS_TOPIC, "foxglove.FrameTransforms")
    assert len(messages) < 0.4 * len(records)
    t_ns, message = messages[len(messages) // 2]
    joints = dict(read_topic(path, MEASURED_TOPIC, "foxglove.JointStates"))[t_ns]["joints"]
    q_rad = np.array([joint["position"] for joint in joints])
    tree = {t["child_frame_id"]: t for t in message["transforms"]}
    assert {t["parent_frame_id"] for t in tree.values()} <= {"world", *tree}
    body = kinematics.model.body(int(kinematics.model.site("left_wrist").bodyid[0])).name
    place = kinematics.model.site("left_wrist").pos.copy()
    while body != "world":
        t = tree[body]
        place = matrix_from_quat(np.array([t["rotation"][k] for k in "wxyz"])) @ place + [
            t["translation"][k] for k in "xyz"
        ]
        body = t["parent_frame_id"]
    wrist = next(p for p in kinematics.key_points if p.name == "left_wrist")
    assert place == pytest.approx(kinematics.place(wrist, q_rad[None])[0], abs=1e-6)


def test_lines_of_the_log_are_foxglove_logs_too(run, tmp_path):
    path = tmp_path / "run.mcap"
    line = {"type": "log", "level": "warning", "process": "bus", "module": "daemon.control", "text": "servo 3 is late"}
    with path.open("wb") as f:
        writer = LogWriter(f, run[0])
        writer.event("v1/log", json.dumps(line | {"v": 1, "id": "", "seq": 1, "t_mono": 2.0}).encode())
        writer.finish()
    ((_, message),) = read_topic(path, LOG_TOPIC, "foxglove.Log")
    assert {k: message[k] for k in ("level", "message", "name", "file", "line")} == {
        "level": 3, "message": "servo 3 is late", "name": "bus", "file": "daemon.control", "line": 0,
    }  # fmt: skip


def cycles_of(path: Path) -> list[tuple[int, bytes]]:
    with path.open("rb") as f:
        return [(m.log_time, m.data) for _, _, m in make_reader(f).iter_messages(topics=[CYCLE_TOPIC])]


def read_topic(path: Path, topic: str, schema_name: str) -> list[tuple[int, dict]]:
    """(time, message) of a topic by the official reader; every message is what the schema says."""
    with path.open("rb") as f:
        found = []
        for schema, channel, message in make_reader(f, validate_crcs=True).iter_messages(topics=[topic]):
            assert schema.name == schema_name and channel.message_encoding == "json"
            content = json.loads(message.data)
            assert_fits(json.loads(schema.data), content)
            found.append((message.log_time, content))
    return found


def assert_fits(schema: dict, value: object) -> None:
    """Assert that a value fits a JSON schema of objects, arrays, numbers and strings."""
    kinds = {"object": dict, "array": list, "string": str, "integer": int, "number": (int, float)}
    assert isinstance(value, kinds[schema["type"]]), (schema, value)
    if schema["type"] == "object":
        assert set(schema.get("required", ())) <= value.keys() <= schema["properties"].keys()
        for key, part in value.items():
            assert_fits(schema["properties"][key], part)
    for item in value if schema["type"] == "array" else ():
        assert_fits(schema["items"], item)
