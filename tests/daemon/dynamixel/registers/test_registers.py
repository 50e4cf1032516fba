"""Control tables against the shared facts, and the laws every table keeps."""

from __future__ import annotations

import itertools
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daemon.dynamixel.registers.models import MODEL_NUMBERS, MODELS, BusModel, IndirectWindow
from daemon.dynamixel.registers.registers import AX, X330, X_CURRENT, hardware_error_text
from tests.support.sizes import few_and_long

FACTS = Path(__file__).parents[5] / "shared" / "servos" / "servos.toml"
ALL = [pytest.param(model, id=model.name) for model in MODELS.values()]


@pytest.mark.skipif(not FACTS.exists(), reason="needs ../shared/servos")
def test_every_model_of_the_facts_is_known_with_the_same_addresses() -> None:
    facts = tomllib.loads(FACTS.read_text("utf-8"))
    for name, servo in facts["servo"].items():
        model, family = MODELS[MODEL_NUMBERS[name]], facts["family"][servo["family"]]
        assert (model.model_number, model.protocol) == (servo["model_number"], family["protocol"])
        assert model.ticks_per_turn == servo["resolution"]
        assert list(model.operating_modes) == servo["operating_modes"]
        assert model.voltage_v == (servo["voltage_min"], servo["voltage_max"])
        for item, (address, size) in family["items"].items():
            assert (model.table[item].address, model.table[item].size) == (address, size), (name, item)
        for item in set(family.get("signed", ())) & model.table.keys():
            assert model.table[item].signed, (name, item)


@pytest.mark.parametrize("model", ALL)
def test_items_do_not_overlap_and_initial_values_are_in_range(model: BusModel) -> None:
    items = sorted(model.table.values(), key=lambda item: item.address)
    for first, second in itertools.pairwise(items):
        assert first.end <= second.address, (first.name, second.name)
    for item in items:
        assert item.initial is None or item.takes(item.initial), item
        assert item.low is None or item.high is None or item.low < item.high, item
    windows = model.indirect_windows(60)
    assert all(w.data >= w.address + 2 * w.count for w in windows)


@pytest.mark.parametrize(
    "model", few_and_long(list(MODELS.values())[::6], MODELS.values()), ids=lambda model: model.name
)
@given(data=st.data())
def test_a_value_survives_the_bytes_of_its_item(model: BusModel, data: st.DataObject) -> None:
    item = data.draw(st.sampled_from(sorted(model.table.values(), key=lambda i: i.address)))
    bits = 8 * item.size - (1 if item.signed else 0)
    top = (1 << (item.sign_bit or bits)) - 1
    low = -top if item.signed or item.sign_bit else 0
    value = data.draw(st.integers(low, top))
    assert item.decode(item.encode(value)) == value
    with pytest.raises(OverflowError):
        item.encode(1 << 8 * item.size)


def test_speed_and_load_of_protocol_1_carry_their_sign_in_bit_10() -> None:
    """AX-12A manual, present speed: 1024 to 2047 is clockwise; 0 and 1024 are equal."""
    speed = AX["present_speed"]
    assert [speed.decode(v.to_bytes(2, "little")) for v in (300, 1024, 1324)] == [300, 0, -300]
    assert speed.encode(-300) == (1324).to_bytes(2, "little")


def test_the_indirect_window_of_the_330_size_moved_with_firmware_52() -> None:
    xl330, xm430 = MODELS[1200], MODELS[1020]
    assert xl330.indirect_windows(51)[0].data == 224
    assert xl330.indirect_windows(52) == (IndirectWindow(168, 208, 20),)
    assert [w.data for w in xm430.indirect_windows(45)] == [224, 634]
    assert MODELS[12].indirect_windows(24) == ()


def test_who_can_what_from_which_firmware() -> None:
    can = {
        m.name: (m.has_fast_sync(45), m.has_fast_sync(46), m.has_watchdog(37), m.has_watchdog(38))
        for m in MODELS.values()
    }
    assert can["XM430-W350"] == (True, True, False, True)
    assert can["XL330-M288"] == (False, True, True, True)
    assert can["2XL430-W250"] == (False, False, False, True)
    assert can["AX-12A"] == (False, False, False, False)


@pytest.mark.parametrize(
    ("name", "baud", "code"),
    [
        ("XM430-W350", 57600, 1), ("XM430-W350", 4500000, 7), ("XL330-M288", 4500000, None), ("XM430-W350", 250000, None),
        ("AX-12A", 1000000, 1), ("AX-12A", 57600, 34), ("AX-12A", 2000000, None), ("MX-28", 57600, 34),
        ("MX-28", 2250000, 250), ("MX-28", 3000000, 252), ("MX-28", 117647, 16), ("MX-28", 700000, None),
    ],
)  # fmt: skip
def test_baud_codes(name: str, baud: int, code: int | None) -> None:
    """Manual, "Baud Rate": codes of X servos; 2000000 / (code + 1) and three extra codes for protocol 1.0."""
    model = MODELS[MODEL_NUMBERS[name]]
    assert model.baud_code(baud) == code
    if code is not None:
        assert model.baud_of_code(code) == pytest.approx(baud, rel=0.03)


def test_what_differs_between_families() -> None:
    assert X330["pwm_slope"].address == 62 and "pwm_slope" not in X_CURRENT
    assert "present_current" not in MODELS[1060].table and MODELS[1060].effort_item == "present_load"
    assert MODELS[1200].table["present_current"].scale == 1.0
    assert MODELS[1020].table["present_current"].scale == 2.69
    assert MODELS[311].table["present_current"].scale == 3.36
    assert X_CURRENT["velocity_limit"].eeprom and not X_CURRENT["torque_enable"].eeprom
    assert AX["shutdown"].eeprom and not AX["torque_enable"].eeprom


def test_hardware_errors_in_words() -> None:
    assert hardware_error_text(0) == "none"
    assert hardware_error_text(0b100101) == "input voltage, overheating, overload"
