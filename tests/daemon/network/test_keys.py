"""Keys in their folder: made once, named, checked, damaged, exchanged by hand."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import subprocess

import pytest
import zmq
import zmq.utils.z85
from hypothesis import given
from hypothesis import strategies as st

from daemon.cli import main
from daemon.errors import ConfigError
from daemon.network.keys import KeyFolder, as_hex, checked_key
from daemon.settings.config import Endpoints
from tests.support.harness import mmmd


def test_a_key_is_made_once_and_is_ones_own(tmp_path):
    folder = KeyFolder(tmp_path / "keys")
    pair = folder.new()
    assert folder.own() == pair and len(pair.public) == len(pair.secret) == 40
    assert (tmp_path / "keys" / "own.key").stat().st_mode & 0o777 == 0o600
    with pytest.raises(ConfigError, match="already"):
        folder.new()
    os.chmod(tmp_path / "keys" / "own.key", 0o644)
    with pytest.raises(ConfigError, match="chmod 600"):
        folder.own()


NO_KEYS = {"a quote": '"' * 40, "a comma": "a" * 39 + ",", "a backslash": "\\" * 40, "too large a number": "#" * 40}


@pytest.mark.parametrize("text", ["", "short", "x" * 41, "ü" * 40, *NO_KEYS.values()])
def test_what_is_no_key_is_named(tmp_path, text):
    with pytest.raises(ConfigError, match="Z85"):
        checked_key(text)
    with pytest.raises(ConfigError):
        KeyFolder(tmp_path).allow("a", text)


@pytest.mark.parametrize("name", ["../x", "", "a/b", "n" * 65])
def test_names_stay_in_the_folder(tmp_path, name):
    with pytest.raises(ConfigError, match="letters"):
        KeyFolder(tmp_path).allow(name, zmq.curve_keypair()[0].decode())


def test_damaged_keys_are_named_and_left_out(tmp_path):
    folder = KeyFolder(tmp_path)
    with pytest.raises(ConfigError, match="mmmd keys new"):
        folder.own()
    with pytest.raises(ConfigError, match="keys trust daemon"):
        folder.server_of("daemon")
    (tmp_path / "own.key").write_text("nonsense")
    os.chmod(tmp_path / "own.key", 0o600)
    with pytest.raises(ConfigError, match="no key pair"):
        folder.own()
    folder.allow("good", zmq.curve_keypair()[0].decode())
    for name, text in {"short": "short", **NO_KEYS}.items():
        (tmp_path / "allowed" / f"{name}.pub").write_text(text)
    assert list(folder.allowed()) == ["good"]


@given(st.text(st.characters(codec="ascii"), min_size=40, max_size=40))
def test_every_key_that_is_taken_can_be_decoded(text):
    """Text that was taken for a key ended the doorkeeper, and with it every new connection."""
    try:
        key = checked_key(text)
    except ConfigError:
        return
    assert zmq.utils.z85.encode(zmq.utils.z85.decode(key)) == key


def test_addresses_that_others_can_reach_need_keys(tmp_path):
    with pytest.raises(ConfigError, match="--keys"):
        Endpoints(cmd="tcp://0.0.0.0:5871")
    assert Endpoints(cmd="tcp://0.0.0.0:5871", keys=tmp_path).keys == tmp_path


def test_keys_by_command(tmp_path):
    folder = tmp_path / "k"
    made = mmmd("keys", "new", "--keys", str(folder))
    assert made.returncode == 0 and len(made.stdout.strip()) == 64
    other = as_hex(zmq.curve_keypair()[0])
    assert keys_here("allow", "laptop", other, folder)[2] == 0
    assert keys_here("trust", "generator", other, folder)[2] == 0
    listed = keys_here("list", folder)[0]
    assert made.stdout.strip() in listed and listed.count(other) == 2 and "laptop" in listed
    assert keys_here("new", folder)[2] == 2
    assert keys_here("allow", "laptop", folder)[2] == 2
    assert keys_here("trust", "cat", other, folder)[2] == 2


def test_keys_are_exchanged_by_pasting_what_is_printed(tmp_path):
    """Z85 keys hold `<>*?$(){}!#&`: of three that were pasted as the page showed, bash took none."""
    robot, laptop = tmp_path / "robot", tmp_path / "laptop"
    for _ in range(3):  # each pair of Z85 keys holds one of them in 99 of 100 cases
        for folder in (robot, laptop):
            shutil.rmtree(folder, ignore_errors=True)
        printed = {f: keys_here("new", f) for f in (robot, laptop)}
        for here, other, part in ((robot, laptop, "client"), (laptop, robot, "daemon")):
            line = next(row for row in printed[other][1].splitlines() if part in row).partition("mmmd keys ")[2]
            typed = subprocess.run(["bash", "-c", f"printf '%s\\n' {line}"], capture_output=True, text=True, check=True)
            assert keys_here(*typed.stdout.split("\n")[:-1], here)[2] == 0
        assert list(KeyFolder(robot).allowed().values()) == [KeyFolder(laptop).own().public]
        assert KeyFolder(laptop).server_of("daemon") == KeyFolder(robot).own().public


def keys_here(*arguments: object) -> tuple[str, str, int]:
    """`mmmd keys` with a folder (the last argument) in this process: what it printed, and its status."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(["keys", *map(str, arguments[:-1]), "--keys", str(arguments[-1])])
    return out.getvalue(), err.getvalue(), status


def test_a_key_may_be_given_in_hexadecimal_or_in_z85():
    public = zmq.curve_keypair()[0]
    assert checked_key(as_hex(public)) == checked_key(as_hex(public).upper()) == checked_key(public.decode()) == public
    for bad in ("", "0" * 63, "g" * 64, "0" * 41):
        with pytest.raises(ConfigError, match="64 hexadecimal digits"):
            checked_key(bad)
