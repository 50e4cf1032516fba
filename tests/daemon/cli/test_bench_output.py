"""What `mmmd bench` writes: each figure once, and figures of parts below the part's name."""

from __future__ import annotations

from daemon.cli.bench import _lines


def test_figures_of_parts_stand_below_the_name_of_the_part():
    figures = {
        "goals": 5,
        "versions": {"mmmd": "1", "numpy": "2"},
        "per_robot": {"op3": {"calm": {"goals": 5, "violations": 0}}},
    }
    assert list(_lines(figures)) == [
        "[bold]goals[/bold]: 5",
        "[bold]versions[/bold]: mmmd 1, numpy 2",
        "[bold]per_robot[/bold]:",
        "    [bold]op3[/bold]:",
        "        [bold]calm[/bold]: goals 5, violations 0",
    ]
