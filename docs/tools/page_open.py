"""First motion while the web page is open against without it, in turns on one daemon: `python -m docs.tools.page_open`.

A daemon with the page runs all the time. In each turn some texts are said from rest with the page open in a headless Chromium,
which shows the robot as it moves, and the same texts with Chromium at an empty page. The order of the two changes from turn to
turn. `first_motion_ratio` is the median time with the page over the median without. Chromium draws in software and needs a core of
its own: on two cores the ratio counts it against the daemon, as a browser on the robot itself would. It takes a
machine that is otherwise idle.
"""

from __future__ import annotations

import json
import sys
from typing import Any

from daemon.bench.first_motion import N_WARM, from_rest
from daemon.bench.report import context
from daemon.bench.texts import draw_texts
from docs.tools.page_rig import SIZE_PX, PageRig, page_rig

TURNS, TEXTS = 4, 8
_METHOD = (
    f"mmmd run --view --bus sim://; {TURNS} turns of the same {TEXTS} texts with and without the page in a headless Chromium that"
    f" draws in software, {SIZE_PX[0]} x {SIZE_PX[1]}; times as in first-motion from rest; {N_WARM} texts before to warm up"
)


def main(turns: int, n_texts: int, seed: int = 0) -> dict[str, Any]:
    """`first_motion_ratio`, medians in milliseconds with and without the page, and the frames that the page drew meanwhile."""
    with page_rig() as rig:
        rig.client.arm()
        return _turns(rig, turns, n_texts, seed)


def _turns(rig: PageRig, turns: int, n_texts: int, seed: int) -> dict[str, Any]:
    browser, client = rig.browser, rig.client
    from_rest(client, draw_texts(N_WARM, seed), seed, "warm")
    with_ms: list[float] = []
    without_ms: list[float] = []
    frames = 0
    for turn in range(turns):
        texts = draw_texts(n_texts, seed + 1 + turn)
        for is_open in (True, False) if turn % 2 else (False, True):
            if is_open:
                rig.open_page()
            else:
                browser.open("about:blank")
            found = from_rest(client, texts, seed, f"{turn}-{'page' if is_open else 'none'}")
            (with_ms if is_open else without_ms).append(found["p50_ms"])
            frames += browser.js("mmmd.frames") if is_open else 0
    middle = [sorted(times)[len(times) // 2] for times in (with_ms, without_ms)]
    return {
        "first_motion_ratio": round(middle[0] / middle[1], 3), "with_page_ms": with_ms, "without_ms": without_ms,
        "frames_drawn": frames, "n": turns * n_texts, **context(seed, _METHOD),
    }  # fmt: skip


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:3]]
    sys.stdout.write(json.dumps(main(*(numbers or [TURNS, TEXTS])), indent=1) + "\n")
