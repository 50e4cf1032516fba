"""The log: bits that return as written, its descriptions, losses, and damaged or foreign files."""

import asyncio
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import zmq
from mcap.reader import make_reader
from mcap.writer import Writer

from daemon.errors import LogError
from daemon.recording.feed import RecorderFeed
from daemon.recording.mcap_log import CYCLE_TOPIC, LogWriter
from daemon.recording.mcap_reading import read_log
from daemon.recording.schemas import DROPPED_TOPIC
from daemon.settings.sources import DEFAULTS
from daemon.shared_memory.bus_link import BusState
from tests.support.harness import RunningDaemon
from tests.support.logs import write
from tests.support.sizes import few_and_long

pytestmark = pytest.mark.realtime


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


@pytest.mark.parametrize("seed", few_and_long(range(0, 60, 6), range(60)))
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
