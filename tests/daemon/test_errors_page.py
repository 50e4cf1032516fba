"""docs/errors.md: each error that a user can meet is provoked here or by the test it names, and reads as the page says."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tests.support.errors_page import PAGE, page, refused, typed
from tests.support.errors_table import ANSWERED, FRAMES, INSIDE, TYPED, Frame, Typed

TESTS = Path(__file__).parents[1]
DAEMON = TESTS.parent / "daemon"
MAKERS = ("WireError", "failed", "GeneratorError", "UnfitRequestError", "_error")
"""Calls whose first argument is the code of an error."""


@pytest.mark.parametrize("row", TYPED, ids=lambda row: " ".join(row.arguments[:4]))
def test_a_wrong_command_line_has_its_exit_status_and_one_message(row: Typed):
    status, said = typed(row)
    assert status == row.status, said
    assert "internal error" not in said and "Traceback" not in said
    assert said.startswith(("mmmd: ", "Unrecognized", "Required", "Parsing"))


@pytest.mark.parametrize("row", FRAMES, ids=lambda row: f"{row.socket} {row.frame[:30]!r}")
def test_a_wrong_frame_has_its_code(row: Frame):
    error = refused(row)
    assert error.code == row.code
    assert error.found and error.allowed and error.do


def test_the_page_says_what_was_said():
    """When it does not: `python -m tests.support.errors_page`."""
    assert PAGE.read_text("utf-8") == page()


@pytest.mark.parametrize("row", ANSWERED, ids=lambda row: row.code)
def test_every_code_of_the_daemon_is_provoked_by_a_test(row):
    assert f'"{row.code}"' in (TESTS / row.test).read_text("utf-8")


def test_no_code_is_missing_on_the_page():
    told = {row.code for row in ANSWERED} | {row.code for row in FRAMES} | set(INSIDE)
    assert codes_in_the_daemon() <= told, codes_in_the_daemon() - told


def codes_in_the_daemon() -> set[str]:
    """Codes of errors that the daemon's sources name."""
    found: set[str] = set()
    for path in DAEMON.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            values = [k.value for k in node.keywords if k.arg == "code"]
            values += node.args[:1] if name in MAKERS else []
            found |= {str(v.value) for v in values if isinstance(v, ast.Constant) and v.value}
    return found
