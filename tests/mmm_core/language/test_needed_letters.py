"""A table of rules tries only the patterns whose letters a text has, and misses none."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable

import pytest

from mmm_core.corpus.heldout import read_sentences
from mmm_core.language.manner import _rules
from mmm_core.language.needed_letters import compiled, letters_of
from mmm_core.language.requests import _everyday, _frames, _openings, _sentences
from mmm_core.language.spelling import mended
from mmm_core.language.word_tables import RuleTable, replaced, substitutions
from tests.support.sizes import few_and_long

TABLES: dict[str, Callable[[], RuleTable]] = {
    "everyday": _everyday, "openings": _openings, "rewrites": lambda: substitutions("rewrites"),
    "homophones": lambda: substitutions("homophones"), "front": lambda: _frames()[0], "back": lambda: _frames()[1],
    "sentences": _sentences, "tempo": lambda: _rules("tempo"), "size": lambda: _rules("size"),
}  # fmt: skip
"""Made in the test: every process of the suite reads this file."""


@pytest.mark.parametrize("name", few_and_long(["everyday", "size"], TABLES))
def test_no_pattern_is_missed(name: str) -> None:
    table, found = TABLES[name](), 0
    for sentence in read_sentences("words_seen"):
        said = mended(sentence.text)
        matching = {i for i, rule in enumerate(table.rules) if rule.pattern.search(said)}
        assert matching <= set(table.possible(said))
        found += len(matching)
    assert found


@pytest.mark.parametrize(
    ("pattern", "needed"),
    [
        ("(?:clap|wave) your hands?", {"cla", "wav"}), (" your hands?", {"r h"}),
        ("clap|wav(?:e|ing)", {"cla", "wav"}), (r"\bnod\b", {"nod"}),
        (r"(?:please )?nod(?=ding)", {"nod"}), ("clap|up", set()), ("(?:clap)?", set()), ("[abc]+", set()),
        ("(?!clap)wave", {"wav"}),
        ("clap{2}", {"cla"}), ("(?:clap)*wave", {"wav"}), ("(?i:clap)|wave", set()),
    ],
)  # fmt: skip
def test_the_letters_that_a_pattern_needs(pattern: str, needed: set[str]) -> None:
    assert compiled(pattern)[1] == needed


def test_a_pattern_is_what_re_compiles() -> None:
    """`compiled` compiles the parsed pattern; `re.compile` would parse the text a second time."""
    text = r"^(?P<who>you|we) (wave|nod)\b(?: twice)?$"
    ours, theirs = compiled(text)[0], re.compile(text)
    assert (ours.flags, ours.groups, ours.groupindex) == (theirs.flags, theirs.groups, theirs.groupindex)
    for said in ("you wave twice", "we nod", "we wave often", "they nod"):
        found, wanted = ours.search(said), theirs.search(said)
        assert (found and found.groups()) == (wanted and wanted.groups())
    assert ours.sub(r"\2 \1", "you wave twice") == theirs.sub(r"\2 \1", "you wave twice")


def test_a_pattern_of_any_case_is_always_tried() -> None:
    for pattern, flags in (("clap", re.IGNORECASE), ("(?i)clap", 0)):
        found, needed = compiled(pattern, flags)
        assert found.search("CLAP") and not needed
    assert letters_of("nods") == {"nod", "ods"}


def test_rules_follow_each_other_in_the_order_of_the_table() -> None:
    """The words of one rule may be the pattern of a later one, and are not that of an earlier one."""
    table = RuleTable([("nod", "clap"), ("wave", "nod"), ("nod", "salute")])
    assert replaced("wave", table) == "salute"
    assert replaced("nod and wave", table) == "clap and salute"


def test_all_tables_are_loaded_before_the_first_sentence() -> None:
    """A table of rare words was read from disk within the first sentence that had an unlikely word, for 8 ms."""
    code = (
        "from mmm_core.language import limbs, slips, slips_in_context as near, spelling, word_tables as tables, warming\n"
        "warming.warmed()\n"
        "loaded = (slips._very_rare, slips._common, slips._stays, near._by_shortened, near._following, limbs._limb_words,\n"
        "          spelling._chat_words, spelling._corrections)\n"
        "before = tables.lines.cache_info().misses\n"
        "assert all(table.cache_info().currsize for table in loaded)\n"
        "from mmm_core.language.reading import read\n"
        "read('gour hovercraft swims teeny weeny circles, shrugg twice as fast')\n"
        "assert tables.lines.cache_info().misses == before\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
