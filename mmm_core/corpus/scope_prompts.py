"""Prompts that measure the scope score: what people might ask of an upper body, and what they might ask besides.

Two sets, in `prompts/`: the scope's thresholds are chosen on the development set and on the probes (`heldout.py`); figures are
reported on the test set, from which no threshold and no weight comes. No caption of the corpus and no text of `outside.py` is
among either (a test sees to it).
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.resources import files


@dataclass(frozen=True)
class ScopePrompts:
    """A set of prompts.

    Attributes:
        in_scope: what the robot can do.
        out_of_scope: what it cannot do, by kind.
        mixed: prompts of which half can be done, with the family to be kept; reported beside the others, not among them.
    """

    in_scope: tuple[str, ...]
    out_of_scope: dict[str, tuple[str, ...]]
    mixed: dict[str, str]

    def all_texts(self) -> tuple[str, ...]:
        """The texts that are in scope and those that are not, by kind."""
        return (*self.in_scope, *(text for texts in self.out_of_scope.values() for text in texts))


def read_scope_prompts(name: str) -> ScopePrompts:
    """The set in `mmm_core/corpus/prompts/<name>.toml`."""
    found = tomllib.loads(files("mmm_core.corpus").joinpath("prompts", f"{name}.toml").read_text(encoding="utf-8"))
    outside = {kind: tuple(texts) for kind, texts in found["out_of_scope"].items()}
    outside["very long"] = tuple(text * times for text, times in found["very_long"].items())
    return ScopePrompts(tuple(found["in_scope"]), outside, found.get("mixed", {}))


SCOPE_TEST = read_scope_prompts("scope_test")
SCOPE_DEVELOPMENT = read_scope_prompts("scope_development")
