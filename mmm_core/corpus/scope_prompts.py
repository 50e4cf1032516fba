"""Prompts that measure the scope score: requests that an upper body can carry out, and other texts that people might send.

There are two sets in `prompts/`: the scope's thresholds are chosen on the development set and on the probes (`heldout.py`);
figures are reported on the test set, on which no threshold and no weight depends. A test makes sure that neither set contains a
caption of the corpus or a text of `outside.py`.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.resources import files


@dataclass(frozen=True)
class ScopePrompts:
    """A set of prompts.

    Attributes:
        in_scope: texts that the robot can carry out.
        out_of_scope: texts that it cannot carry out, by kind.
        mixed: prompts of which one half can be carried out, with the family of that half; reported separately.
    """

    in_scope: tuple[str, ...]
    out_of_scope: dict[str, tuple[str, ...]]
    mixed: dict[str, str]

    def all_texts(self) -> tuple[str, ...]:
        """All texts in scope and out of scope, without the mixed ones."""
        return (*self.in_scope, *(text for texts in self.out_of_scope.values() for text in texts))


def read_scope_prompts(name: str) -> ScopePrompts:
    """The set in `mmm_core/corpus/prompts/<name>.toml`."""
    found = tomllib.loads(files("mmm_core.corpus").joinpath("prompts", f"{name}.toml").read_text(encoding="utf-8"))
    outside = {kind: tuple(texts) for kind, texts in found["out_of_scope"].items()}
    outside["very long"] = tuple(text * times for text, times in found["very_long"].items())
    return ScopePrompts(tuple(found["in_scope"]), outside, found.get("mixed", {}))


SCOPE_TEST = read_scope_prompts("scope_test")
SCOPE_DEVELOPMENT = read_scope_prompts("scope_development")
