"""Names of tests are short enough to be read in a list of failures."""

from __future__ import annotations

import ast
from pathlib import Path

TESTS = Path(__file__).parent
MOST_CHARACTERS = 69
"""Characters of a test's name: with its folder and file, about one line of a terminal."""


def names_of(source: str) -> list[str]:
    """Names of the test functions and methods of a file."""
    functions = (ast.FunctionDef, ast.AsyncFunctionDef)
    nodes = ast.walk(ast.parse(source))
    return [node.name for node in nodes if isinstance(node, functions) and node.name.startswith("test_")]


def test_names_of_tests_are_short():
    names = {name: path for path in TESTS.rglob("test_*.py") for name in names_of(path.read_text("utf-8"))}
    assert len(names) > 1000, "the tests were found"
    long = {name: path.name for name, path in names.items() if len(name) > MOST_CHARACTERS}
    assert not long, (
        f"shorten these to {MOST_CHARACTERS} characters: the condition and the result; the docstring holds the rest"
    )


def test_methods_and_asynchronous_tests_are_found():
    assert names_of("class TestX:\n    async def test_a(self): ...\n    def b(self): ...\n") == ["test_a"]
