"""The examples in docstrings of the reader are what it does."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import mmm_core.language

MODULES = [m.name for m in pkgutil.iter_modules(mmm_core.language.__path__, "mmm_core.language.")]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings_hold(name: str) -> None:
    found = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert not found.failed, found
