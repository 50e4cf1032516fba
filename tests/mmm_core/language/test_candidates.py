"""The choice among ways to read a sentence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from mmm_core.language.candidates import EVIDENCE, Candidate, Ways, chosen, commands_of, evidence, in_sentence, merged
from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.limbs import limbs_of
from mmm_core.language.manner import Manner
from mmm_core.language.plain_gestures import OUTSIDE, SEVERAL, Meant
from mmm_core.language.word_tables import pairs

MEANT = {
    "clap": Meant("clap", 0.99),
    "nod your head": Meant("nod", 0.98),
    "bow politely": Meant("bow", 0.97),
    "the whole shebang": Meant(OUTSIDE, 0.9),
    "run away": Meant(OUTSIDE, 0.9),
    "wiggle it": Meant("wobble_head", 0.5),
}


def _candidate(steps: list[list[str]], text: str = "said", **others: object) -> Candidate:
    commands = tuple(tuple(PlainCommand(one, limbs=limbs_of(one)) for one in step) for step in steps)
    return replace(Candidate(Reading(text, commands)), **others)  # type: ignore[arg-type]


def _evidence(*candidates: Candidate, whole: Meant = Meant(SEVERAL, 0.9)) -> list[Mapping[str, float]]:  # noqa: B008
    return [dict(zip(EVIDENCE, row, strict=True)) for row in evidence(Ways(candidates, MEANT, whole))]


def test_candidates_with_the_same_commands_are_one() -> None:
    quick = _candidate([["clap"]], log_share=-2.0, in_sentence=-1.0)
    quick = replace(quick, reading=replace(quick.reading, steps=((PlainCommand("clap", Manner(tempo=1.6)),),)))
    other = _candidate([["clap"]], by_rules=True, log_share=-0.5, in_sentence=-0.1)
    other = replace(other, reading=replace(other.reading, denied=("bow",)))
    (found,) = merged([quick, other])
    assert found.reading.steps == quick.reading.steps, "the first gives the manner"
    assert found.reading.denied == ("bow",), "what one of them denies is denied"
    assert (found.by_rules, found.log_share, found.in_sentence) == (True, -0.5, -0.1)


def test_a_proposal_that_others_read_too_is_not_the_parsers_alone() -> None:
    alone = _candidate([["clap"]], by_parser=True, log_parsed=-1.0)
    too = _candidate([["clap"]], log_parsed=-40.0)
    assert [(one.by_parser, one.log_parsed) for one in merged([alone, too])] == [(False, -1.0)]
    rows = _evidence(alone, too)
    assert [row["by parser"] for row in rows] == [1, 0]
    assert [row["parsed"] for row in rows] == [-1.0, -15.0], "no probability counts as less than that of the impossible"


def test_commands_at_once_are_the_same_in_any_order_and_others_are_not() -> None:
    at_once = [_candidate([["clap", "nod your head"]]), _candidate([["nod your head", "clap"]])]
    in_turn = [_candidate([["clap"], ["nod your head"]]), _candidate([["nod your head"], ["clap"]])]
    assert merged([*at_once, *in_turn]) == [at_once[0], *in_turn]
    assert commands_of(in_turn) == ["clap", "nod your head"]


@pytest.mark.parametrize(
    ("steps", "text", "found"),
    [
        ([["clap"]], "clap", {"unsure": 0, "repeated": 0, "at once": 0, "nothing": 0}),
        ([["clap"], ["the whole shebang"]], "clap", {"unsure": 1, "least": np.log(0.01), "in turn, said": 0}),
        ([["clap"], ["run away"]], "clap, run away", {"unsure": 0, "least": np.log(0.97)}),
        ([["wiggle it"]], "wiggle it", {"unsure": 1, "least": np.log(0.5), "sum": np.log(0.5)}),
        ([["clap"], ["clap"]], "clap, clap", {"repeated": 1}),
        ([["clap"], ["clap"]], "clap, then again", {"repeated": 0, "in turn, said": 1}),
        ([["clap", "nod your head"]], "clap and nod together", {"at once": 1, "at once, said": 1, "one limb twice": 0}),
        ([["nod your head", "nod your head"]], "nod and nod", {"at once": 1, "at once, said": 0, "one limb twice": 1}),
        ([], "never", {"nothing": 1, "sum": 0, "mean": 0, "least": 0}),
    ],
)  # fmt: skip
def test_evidence(steps: list[list[str]], text: str, found: dict[str, float]) -> None:
    (row,) = _evidence(_candidate(steps, text))
    assert {name: row[name] for name in found} == pytest.approx(found)


def test_the_division_without_a_likelier_one_is_the_likeliest() -> None:
    one, two, rules = _evidence(
        _candidate([["clap"]], log_share=0.0), _candidate([["nod your head"]], log_share=-0.5), _candidate([[]])
    )
    assert (one["likeliest tags"], two["likeliest tags"], rules["likeliest tags"]) == (1, 0, 0)


def test_each_kind_of_evidence_has_a_weight() -> None:
    assert tuple(name for name, _ in pairs("choice")) == EVIDENCE


def test_what_likely_divisions_lack_is_unlikely() -> None:
    clap = _candidate([["clap"]], log_share=0.0)
    both = _candidate([["clap"], ["bow politely"]], log_share=float(np.log(1 / 3)))
    one, two = _evidence(clap, both)
    assert one["unlikely"] == pytest.approx(0, abs=1e-3)
    assert two["unlikely"] == pytest.approx(0.75, abs=1e-3)


def test_a_sentence_that_is_one_gesture_speaks_against_several_commands() -> None:
    rows = _evidence(_candidate([["clap"]]), _candidate([["clap"], ["bow politely"]]), whole=Meant("clap", 0.8))
    assert [row["against one"] for row in rows] == [0.0, 0.8]


def test_the_least_likely_command_counts_in_its_sentence() -> None:
    assert in_sentence([Meant("clap", 0.5), Meant("nod", 0.9)]) == pytest.approx(np.log(0.5))
    assert in_sentence([Meant(OUTSIDE, 0.9)]) == pytest.approx(np.log(0.01))
    assert in_sentence([]) == 0.0


def test_a_reading_whose_commands_are_gestures_is_chosen() -> None:
    doubtful = _candidate([["clap"], ["the whole shebang"]], "clap, the whole shebang", by_rules=True)
    right = _candidate([["clap"]], "clap, the whole shebang", log_share=0.0)
    assert chosen(Ways([doubtful, right], MEANT, Meant("clap", 0.8))) == right.reading


def test_one_command_without_manner_takes_that_of_another_candidate() -> None:
    best = _candidate([["clap"]], log_share=0.0)
    quick = _candidate([["wiggle it"]])
    quick = replace(quick, reading=replace(quick.reading, steps=((PlainCommand("wiggle it", Manner(tempo=1.6)),),)))
    found = chosen(Ways([best, quick], MEANT, Meant("clap", 0.8)))
    assert [command.sentence for step in found.steps for command in step] == ["clap (1.6 times as fast)"]


@pytest.mark.parametrize(("log_parsed", "said"), [(-0.5, "wobble your head"), (-3.0, "wiggle it")])
def test_a_choice_that_the_parser_shares_is_said_in_plain_words(log_parsed: float, said: str) -> None:
    one = _candidate([["clap"], ["wiggle it"]], log_parsed=log_parsed)
    found = chosen(Ways([one], MEANT, Meant(SEVERAL, 0.9)))
    assert [step[0].text for step in found.steps] == ["clap", said]
