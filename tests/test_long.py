"""What `make test` leaves to `make test-long`: the cases marked `long`, never all of a promise of docs/safety.md."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from tests.support.sizes import few_and_long

ROOT = Path(__file__).parents[1]
SAFETY = sorted(set(re.findall(r"`(?:tests/\S*/)?(test_\w+\.py)`", (ROOT / "docs/safety.md").read_text("utf-8"))))
"""Names of the test files that docs/safety.md gives for its promises."""


def marks(decorators: list[ast.expr]) -> set[str]:
    """Names of the marks that stand above a function."""
    return {name for decorator in decorators for name in re.findall(r"^pytest\.mark\.(\w+)", ast.unparse(decorator))}


def default_tests(path: Path) -> list[str]:
    """Names of the test functions of a file that are not as a whole left to `make test-long` or `make soak`."""
    functions = [node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.FunctionDef)]
    return [
        function.name
        for function in functions
        if function.name.startswith("test_") and not marks(function.decorator_list) & {"long", "soak"}
    ]


@pytest.mark.parametrize("name", SAFETY)
def test_every_promise_of_safety_keeps_a_test_in_the_default_suite(name: str) -> None:
    (path,) = (ROOT / "tests").rglob(name)
    assert default_tests(path)
    assert "pytestmark = pytest.mark.long" not in path.read_text("utf-8")


def test_a_function_left_to_the_long_run_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "test_some.py"
    path.write_text("@pytest.mark.long\ndef test_a(): ...\n@pytest.mark.soak\ndef test_b(): ...\ndef test_c(): ...\n")
    assert default_tests(path) == ["test_c"]


def test_ci_runs_the_check_and_both_suites() -> None:
    lines = (ROOT / ".ci/run").read_text("utf-8").splitlines()
    assert [line for line in lines if line.startswith("make ")] == ["make check", "make test", "make test-long"]


def test_the_default_suite_leaves_out_what_the_long_one_runs(pytestconfig: pytest.Config) -> None:
    assert "not long and not soak" in " ".join(pytestconfig.getini("addopts"))
    assert "WHICH := -m 'long and not soak and not hardware'" in (ROOT / "Makefile").read_text("utf-8")


def test_cases_of_the_long_run_come_after_the_few_and_have_its_mark() -> None:
    first, second, third = few_and_long(["a"], ["b", "a", ("c", 2)])
    assert first == "a"
    assert [(case.values, [mark.name for mark in case.marks]) for case in (second, third)] == [
        (("b",), ["long"]), (("c", 2), ["long"])
    ]  # fmt: skip
