import asyncio
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np
import pytest
import zmq
from mcap.reader import make_reader
from mcap.writer import Writer

from daemon.errors import LogError
from daemon.recording.feed import RecorderFeed
from daemon.recording.foxglove import GOAL_TOPIC, LOG_TOPIC, MEASURED_TOPIC, SCHEMAS, TRANSFORMS_TOPIC
from daemon.recording.mcap_log import CYCLE_TOPIC, LogWriter
from daemon.recording.mcap_reading import read_log
from daemon.recording.schemas import DROPPED_TOPIC
from daemon.settings.sources import DEFAULTS
from daemon.shared_memory.bus_link import BusLink, BusState
from mmm_core.motion.skeleton import matrix_from_quat
from retarget.robot.kinematics import Kinematics
from retarget.robot.loading import load_robot
from retarget.robot.robot import RobotModel
from retarget.robot.ticks import JointServoMap
from tests.support.harness import RunningDaemon
from tests.support.rig import rig, swing

pytestmark = pytest.mark.realtime


@pytest.fixture(scope="module")
def run() -> tuple[RobotModel, list[np.void]]:
    """The records of arming, a motion and parking."""
    with rig() as r:
        r.arm()
        r.push(swing(r.robot, 1.0))
        r.until(BusState.PLAYING)
        r.until(BusState.HOLDING)
        return r.robot, r.records


def write(path: Path, run, *, flush_every: int = 50, finish: bool = True) -> Path:
    robot, records = run
    with path.open("wb") as f:
        writer = LogWriter(f, robot)
        for i, record in enumerate(records):
            writer.cycle(record)
            if i % flush_every == flush_every - 1:
                writer.event("v1/event", b'{"type": "progress"}')
                writer.flush()
        if finish:
            writer.finish()
    return path


def test_what_is_written_is_read_bit_for_bit(run, tmp_path):
    robot, records = run
    log = read_log(write(tmp_path / "run.mcap", run))
    assert not log.is_cut and log.problem == ""
    assert len(log.cycles) == len(records) and log.n_events == len(records) // 50
    for cycle, record in zip(log.cycles, records, strict=True):
        assert cycle.goal_rad.tobytes() == record["goal_rad"].tobytes()
        assert cycle.goal_tick == tuple(record["goal_tick"])
        assert (cycle.cycle, cycle.torque) == (record["cycle"], bool(record["torque"]))
        assert cycle.state == BusState(int(record["state"])).name.lower()
    assert log.metadata["robot"] == robot.name
    assert log.metadata["robot_toml"] == robot.path.read_text("utf-8")
    assert log.metadata["mmmd"] and log.metadata["numpy"]


@pytest.mark.parametrize("value", [0.1, -0.0, 5e-324, 1.7976931348623157e308, 1 / 3, np.nextafter(1.0, 2.0)])
def test_every_float_keeps_its_bits(run, tmp_path, value):
    robot, records = run
    record = records[-1].copy()
    record["goal_rad"] = value
    record["setpoint_rad"] = np.nan
    log = read_log(write(tmp_path / "run.mcap", (robot, [record])))
    assert log.cycles[0].goal_rad.tobytes() == record["goal_rad"].tobytes()


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
    """What JSON schema says of objects, arrays, numbers and strings."""
    kinds = {"object": dict, "array": list, "string": str, "integer": int, "number": (int, float)}
    assert isinstance(value, kinds[schema["type"]]), (schema, value)
    if schema["type"] == "object":
        assert set(schema.get("required", ())) <= value.keys() <= schema["properties"].keys()
        for key, part in value.items():
            assert_fits(schema["properties"][key], part)
    for item in value if schema["type"] == "array" else ():
        assert_fits(schema["items"], item)


def fields_of(schema: dict, message: dict) -> dict:
    """The schema of the kind of object that a message is."""
    kinds = [schema["$defs"][kind["$ref"].rsplit("/", 1)[1]] for kind in schema.get("anyOf", [])] or [schema]
    mine = [kind for kind in kinds if message.get("type") in kind["properties"].get("type", {}).get("enum", [None])]
    assert len(mine) == 1, message
    return mine[0]


def assert_described(schema: dict, message: dict) -> None:
    """Every field of a message stands in its schema with its type, and what must be there is."""
    fields = fields_of(schema, message)
    assert set(fields.get("required", [])) <= message.keys() <= fields["properties"].keys()
    names = {str: "string", bool: "boolean", int: "integer", float: "number", list: "array", type(None): "null"}
    for key, value in message.items():
        described = fields["properties"][key]
        kinds = {kind.get("type", "object") for kind in described.get("anyOf", [described])}
        if "enum" in described:
            assert value in described["enum"]
        else:
            assert names.get(type(value), "object") in kinds | ({"integer"} if "number" in kinds else set())


def test_a_log_holds_settings_versions_losses_and_every_schema(tmp_path):
    daemon = RunningDaemon("--log", str(tmp_path / "run.mcap"), "--idle", "calm", robot="reference")
    try:
        with daemon.until_ready().client() as client:
            assert client.say("wave", seconds=0.8).done
            client.story(["wave", "left"], loop=True, wait=False)
            client.stop()
            client.look(10.0)
            with client.stream("test") as stream:
                stream.send({"r_shoulder_pitch": 0.1})
            status = client.status()
        assert daemon.mmmd("say", "wave", "--no-wait").returncode == 0
        assert daemon.terminate() == 0
    finally:
        daemon.close()
    metadata = read_log(tmp_path / "run.mcap").metadata
    settings = json.loads(metadata["settings"])
    assert set(settings) == set(DEFAULTS) - {"log_json"}
    assert settings["idle"] == "calm" and settings["cmd"] == daemon.endpoints.cmd and settings["robot"] == "reference"
    assert all(metadata[name] for name in ("mmmd", "python", "numpy", "pyzmq", "msgspec", "mujoco"))
    assert metadata["cycles_dropped"] == "0" and metadata["messages_dropped"] == "0"
    seen = set()
    with (tmp_path / "run.mcap").open("rb") as f:
        for schema, channel, message in make_reader(f, validate_crcs=True).iter_messages():
            if channel.topic != CYCLE_TOPIC:
                assert schema is not None
                content = json.loads(message.data)
                assert_described(json.loads(schema.data), content)
                seen.add((channel.topic, content.get("type")))
    assert {("v1/state", "state"), ("cmd", "say"), ("cmd", "story"), ("cmd", "lease"), ("stream", "target")} <= seen
    events = {kind for topic, kind in seen if topic == "v1/event"}
    assert {"accepted", "progress", "done", "cancelled", "ack"} <= events
    assert status.generator.startswith("ready (checkpoint ")  # which model it was stands in every state


def test_messages_lost_by_a_slow_recorder_are_counted_in_the_log(tmp_path, caplog):
    endpoint = f"ipc://{tmp_path}/events"
    feed = RecorderFeed(endpoint, queue=10)
    context = zmq.Context()
    recorder = context.socket(zmq.PULL)
    try:
        for _ in range(50):
            feed("v1/event", b"{}")
        assert feed.dropped > 0 and "too slow" in caplog.text
        recorder.bind(endpoint)
        assert recorder.poll(5000)
        heard: list[list[bytes]] = []
        while DROPPED_TOPIC.encode() not in [topic for topic, _ in heard]:
            feed("v1/state", b"{}")
            while recorder.poll(20):
                heard.append(recorder.recv_multipart())
        losses = [json.loads(payload)["messages"] for topic, payload in heard if topic == DROPPED_TOPIC.encode()]
        assert losses[-1] >= 40
    finally:
        asyncio.run(feed.close())
        recorder.close(0)
        context.term()


def test_a_plain_text_is_recorded_as_json(run, tmp_path):
    robot, records = run
    with (tmp_path / "run.mcap").open("wb") as f:
        writer = LogWriter(f, robot)
        writer.cycle(records[0])
        for payload in (b"wave with your right hand", b"\xff\xfe", b'{"type": "say"}'):
            writer.event("cmd", payload)
        writer.finish()
    with (tmp_path / "run.mcap").open("rb") as f:
        texts = [json.loads(m.data) for _, _, m in make_reader(f).iter_messages(topics=["cmd"])]
    assert texts[0] == {"text": "wave with your right hand"} and texts[2] == {"type": "say"}


def test_a_log_cut_off_anywhere_reads_to_its_last_whole_chunk(run, tmp_path):
    """Every length: a named error while nothing is readable, then more and more cycles, never fewer, never wrong ones."""
    whole = write(tmp_path / "run.mcap", run, flush_every=10).read_bytes()
    numbers = [int(r["cycle"]) for r in run[1]]
    cut = tmp_path / "cut.mcap"
    before, errors = 0, 0
    for length in sorted({*range(0, len(whole), 997), *range(20), *range(len(whole) - 12, len(whole))}):
        cut.write_bytes(whole[:length])
        try:
            log = read_log(cut)
        except LogError as error:
            assert before == 0
            assert str(cut) in str(error)
            errors += 1
            continue
        assert log.is_cut and "cut off" in log.problem and f"{len(log.cycles)} cycles" in log.problem
        assert [c.cycle for c in log.cycles] == numbers[: len(log.cycles)]
        assert len(log.cycles) >= before
        before = len(log.cycles)
    assert errors > 0 and before == len(numbers)


@pytest.mark.parametrize("seed", range(60))
def test_a_flipped_bit_never_changes_a_goal(run, tmp_path, seed):
    path = write(tmp_path / "run.mcap", run)
    data = bytearray(path.read_bytes())
    random = np.random.default_rng(seed)
    data[random.integers(len(data))] ^= 1 << random.integers(8)
    path.write_bytes(data)
    try:
        log = read_log(path)
    except LogError:
        return
    for cycle, record in zip(log.cycles, run[1], strict=False):
        assert cycle.goal_rad.tobytes() == record["goal_rad"].tobytes()
    assert log.is_cut or len(log.cycles) == len(run[1])


def foreign(path: Path, **metadata: str) -> None:
    with path.open("wb") as f:
        writer = Writer(f)
        writer.start(library="somebody else")
        if metadata:
            writer.add_metadata("mmmd", metadata)
        writer.finish()


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda p: None, ["no such file", "mmmd run --log"]),
        (lambda p: p.mkdir(), ["cannot be read"]),
        (lambda p: p.write_bytes(b""), ["not an MCAP file", "empty"]),
        (lambda p: p.write_bytes(b"PK\3\4 some archive"), ["not an MCAP file", "PK"]),
        (lambda p: p.write_bytes(b"\x89MCAP1\r\n"), ["MCAP version 1", "update"]),
        (foreign, ["not a log of mmmd", "somebody else"]),
        (lambda p: foreign(p, format="2", mmmd="9.1.0"), ["format 2", "9.1.0", "reads format 1", "update"]),
        (lambda p: foreign(p, format="1", mmmd="0.1.0"), ["no bus cycles"]),
    ],
)
def test_what_is_no_log_is_refused_by_name(tmp_path, make: Callable[[Path], object], says):
    path = tmp_path / "x.mcap"
    make(path)
    with pytest.raises(LogError) as caught:
        read_log(path)
    for part in [str(path), *says]:
        assert part in str(caught.value)


class Recording:
    """The recorder's process on shared memory that the test fills."""

    def __init__(self, folder: Path, robot: RobotModel) -> None:
        self.out = folder / "run.mcap"
        self.link = BusLink.create(robot.n_joints)
        self.bus = BusLink.attach(self.link.path, robot.n_joints)
        self.endpoint = f"ipc://{folder}/events"
        self._context = zmq.Context()
        self.events = self._context.socket(zmq.PUSH)
        self.events.connect(self.endpoint)
        arguments = ["--robot", "reference", "--link", str(self.link.path), "--out", str(self.out)]
        command = [sys.executable, "-m", "daemon.recording.recorder", *arguments, "--events", self.endpoint]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE)

    def publish(self, records: list[np.void]) -> None:
        for record in records:
            slot = self.bus.cycles.next_record()
            for name in record.dtype.names or ():
                slot[name] = record[name]
            self.bus.cycles.publish()

    def wait_for(self, what: Callable[[], bool]) -> None:
        end_s = time.monotonic() + 30
        while not what():
            assert time.monotonic() < end_s and self.process.poll() is None
            time.sleep(0.02)

    def cycles(self) -> int:
        try:
            return len(read_log(self.out).cycles)
        except LogError:
            return 0

    def close(self) -> None:
        self.process.kill()
        self.process.communicate()
        self.events.close(0)
        self._context.term()
        self.link.close()


@pytest.fixture
def recording(tmp_path):
    made = Recording(tmp_path, load_robot("reference"))
    yield made
    made.close()


def test_sigterm_finishes_the_log(recording, run):
    recording.publish(run[1])
    recording.events.send_multipart([b"v1/event", msgspec.json.encode({"type": "done", "plan_id": 7})])
    recording.wait_for(lambda: recording.cycles() > 0)
    recording.publish(run[1][:30])
    os.kill(recording.process.pid, signal.SIGINT)  # Ctrl-C reaches the whole group, and the parking after it belongs in
    recording.process.terminate()
    assert recording.process.wait(30) == 0
    log = read_log(recording.out)
    assert not log.is_cut
    assert len(log.cycles) == len(run[1]) + 30
    assert log.n_events == 1


def test_killed_it_leaves_a_log_that_reads_to_its_last_chunk(recording, run):
    recording.publish(run[1])
    recording.wait_for(lambda: recording.cycles() == len(run[1]))
    recording.process.kill()
    recording.process.wait(30)
    log = read_log(recording.out)
    assert log.is_cut and "cut off" in log.problem
    assert [c.goal_tick for c in log.cycles] == [tuple(r["goal_tick"]) for r in run[1]]


def test_a_stopped_recorder_slows_nobody_and_its_losses_are_counted(recording, run):
    """Frozen while the ring goes round: publishing goes on, and the log says by its numbers what is missing."""
    recording.publish(run[1][:5])
    recording.wait_for(lambda: recording.cycles() > 0)
    os.kill(recording.process.pid, signal.SIGSTOP)
    record = run[1][-1].copy()
    for cycle in range(5, 6000):
        record["cycle"] = cycle
        recording.publish([record])
    os.kill(recording.process.pid, signal.SIGCONT)
    recording.process.terminate()
    assert recording.process.wait(60) == 0
    assert b"cycles dropped" in recording.process.stderr.read()
    log = read_log(recording.out)
    numbers = [c.cycle for c in log.cycles]
    assert numbers[-1] == 5999 and len(numbers) < 5000
    assert int(log.metadata["cycles_dropped"]) == 6000 - len(numbers)


def test_a_file_that_cannot_be_written_ends_recording_alone(tmp_path):
    link = BusLink.create(load_robot("reference").n_joints)
    try:
        arguments = ["--robot", "reference", "--link", str(link.path), "--out", str(tmp_path / "no" / "run.mcap")]
        command = [
            sys.executable,
            "-m",
            "daemon.recording.recorder",
            *arguments,
            "--events",
            f"ipc://{tmp_path}/events",
        ]
        ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    finally:
        link.close()
    assert ended.returncode == 1
    assert "goes on without a log" in ended.stderr and "Traceback" not in ended.stderr


def test_a_full_disk_ends_recording_alone():
    if not Path("/dev/full").exists():
        pytest.skip("needs /dev/full")
    link = BusLink.create(load_robot("reference").n_joints)
    try:
        arguments = ["--robot", "reference", "--link", str(link.path), "--out", "/dev/full"]
        command = [sys.executable, "-m", "daemon.recording.recorder", *arguments, "--events", "ipc://@mmmd-test-full"]
        ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    finally:
        link.close()
    assert ended.returncode == 1
    assert "goes on without a log" in ended.stderr and "Traceback" not in ended.stderr
