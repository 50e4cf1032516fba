"""Makes new training clips while a transformer trains: a round of them after every fixed number of steps.

22,000 fixed clips hold some ninety of a rare family, but the synthesiser makes hundreds a second. Encoding captions takes
longer than training on them, so a round's clips are made, encoded and kept in the run's folder when its first step comes, and
the newest rounds are trained on together. `families.json` in the folder of the rounds may weigh the families that are drawn.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmm_core import distributed
from mmm_core.corpus.beat import BEAT_S
from mmm_core.corpus.deterministic import synthesise_deterministic
from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.synthesis import SINGLE_SHARE, SynthClip, synthesise, usual_weight
from mmm_core.corpus.takeover import synthesise_takeover
from mmm_core.errors import TrainingDataError
from mmm_core.language.mirroring import canonical
from mmm_core.model.text import TextEncoder
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.model.vqvae import VqVae
from mmm_core.motion.features import mirror
from mmm_core.training.batches import CaptionStates, Clip, TokenCorpus, encode_clips
from mmm_core.training.run import written_whole

log = logging.getLogger(__name__)
WEIGHTS_FILE = "families.json"
"""File that gives weights of families."""
REPEATED = 1.9
"""Least weight of a family with strokes, as long as no fidelity was measured."""
CUT_SHARE = 1 / 7
"""Share of clips that end before their gesture does, among clips whose length is not their gesture's."""
MOST_REST_TOKENS = 16
"""Tokens of rest after a gesture at most: 3.2 s."""
DIRECTED = 1.7
"""Factor on the weight of a family with directions, since each direction is another motion. Drawn more rarely, such families
lost 13 points."""


@dataclass(frozen=True)
class FreshRecipe:
    """Settings of the clips that are made while the transformer trains.

    Attributes:
        clips: clips of a round; 0 makes no clips.
        first: clips of the first round.
        every: steps between rounds.
        rounds: number of the newest rounds that are trained on.
        captions: captions of each clip at most.
        free_share: share of clips without a beat, performed as by a person, with sway, breath and uneven strokes.
        canonical_share: share of clips with canonical text; the other clips have their sentences as they were drawn.
        single_share: share of clips that show one gesture; the others show two at once, or two or three in turn.
        takeover_share: share of clips that begin in the middle of another gesture, whose tokens are given and not learnt; one
            gesture without randomness follows.
        deterministic_share: share of the clips without a takeover that show one gesture without randomness
            (`mmm_core.corpus.deterministic`).
        other_length_share: share of these deterministic clips that have rest after their gesture, or end a little before it.
    """

    clips: int = 0
    first: int = 6000
    every: int = 500
    rounds: int = 16
    captions: int = 2
    free_share: float = 0.12
    canonical_share: float = 0.8
    single_share: float = SINGLE_SHARE
    takeover_share: float = 0.0
    deterministic_share: float = 0.0
    other_length_share: float = 0.0


def usual_weights() -> dict[str, float]:
    """Weight by which each family is drawn at first; it is at least that of `synthesis`, and more for strokes and directions."""
    return {
        name: max(usual_weight(name) * (DIRECTED if family.directions else 1.0), REPEATED if family.counts else 0.0)
        for name, family in FAMILIES.items()
    }


def weights_of(fidelity: Mapping[str, Mapping[str, object]], most: float = 6.0) -> dict[str, float]:
    """Weights of families from the figures of `mmmd eval fidelity`: the worse a family, the greater its weight.

    A share of few motions is uncertain, so each family is credited with one success in two more motions (Laplace's rule).
    """
    found: dict[str, float] = {}
    for name, usual in usual_weights().items():
        n, share = float(str(fidelity.get(name, {}).get("n") or 0)), fidelity.get(name, {}).get("share")
        passed = (float(str(share or 0.0)) * n + 1) / (n + 2)
        found[name] = round(usual * (0.4 + most * (1 - passed) ** 2), 3)
    return found


def read_weights(path: Path) -> dict[str, float]:
    """Weights of the families from a file `{"family": weight}`; families that it does not name have their usual weight.

    Raises:
        TrainingDataError: the file names an unknown family, or a weight is not a number of 0 or more.
    """
    if not path.is_file():
        return usual_weights()
    table = json.loads(path.read_text("utf-8"))
    for name, weight in table.items():
        if name not in FAMILIES:
            raise TrainingDataError(path, name, "no such family", "families of the corpus (docs/corpus.md)")
        if not isinstance(weight, (int, float)) or weight < 0:
            raise TrainingDataError(path, name, repr(weight), "a weight, 0 or more")
    return usual_weights() | table


def make_round(how: FreshRecipe, seed: int, k: int, weights: Mapping[str, float]) -> list[Clip]:
    """The clips of round `k`; each depends on nothing but `seed`, `k`, its index and the families' `weights`."""
    return [_make(how, np.random.default_rng((seed, 77, k, i)), weights) for i in range(how.clips if k else how.first)]


def _make(how: FreshRecipe, rng: np.random.Generator, weights: Mapping[str, float]) -> Clip:
    if how.takeover_share and rng.random() < how.takeover_share:
        return _read_from_one_side(*synthesise_takeover(rng, weights), how.captions)
    if how.deterministic_share and rng.random() < how.deterministic_share:
        clip = _read_from_one_side(synthesise_deterministic(rng, weights), 0, how.captions)
        return at_another_length(clip, rng) if rng.random() < how.other_length_share else clip
    made = synthesise(rng, 0.0 if rng.random() < how.free_share else BEAT_S, weights, how.single_share)
    if rng.random() >= how.canonical_share:
        return Clip(made.features, made.captions[: how.captions], is_real=False)
    return _read_from_one_side(made, 0, how.captions)


def at_another_length(clip: Clip, rng: np.random.Generator) -> Clip:
    """The clip with rest after its gesture or, in one of seven draws, without its last one or two tokens.

    If each sentence had one length, the model would learn the gesture from the length as well as from the words: "hold up your
    hand" at 3.0 s, the length of every clip that stands still, stood still.
    """
    n = len(clip.features) // FRAMES_PER_TOKEN
    if rng.random() < CUT_SHARE:
        n_rest = -int(rng.integers(1, 3))
        return replace(clip, features=clip.features[: (n + n_rest) * FRAMES_PER_TOKEN], n_rest=n_rest)
    n_rest = min(1 + int(rng.integers(0, MOST_REST_TOKENS)), MAX_TOKENS - n)
    rest = np.repeat(clip.features[-1:], n_rest * FRAMES_PER_TOKEN, axis=0)
    return replace(clip, features=np.concatenate([clip.features, rest]), n_rest=n_rest)


def _read_from_one_side(made: SynthClip, n_seen: int, n_captions: int) -> Clip:
    """The clip or its mirror image, whichever has the canonical text."""
    read = [canonical(c) for c in made.captions]
    turned = read[0][1]  # other captions are kept only if their canonical text has the same side
    captions = [text for text, is_image in read if is_image == turned][:n_captions]
    return Clip(mirror(made.features) if turned else made.features, captions, False, n_seen)


@dataclass(frozen=True)
class Round:
    """The clips of a round, as ids and text states.

    Attributes:
        ids: (L, C) ids of each clip.
        caption_rows: for each clip the rows of its captions in `states`.
        captions: all captions.
        states: text states of the captions.
        n_seen, n_rest: `Clip.n_seen` and `Clip.n_rest` of each clip.
    """

    ids: list[Tensor]
    caption_rows: list[list[int]]
    captions: list[str]
    states: CaptionStates
    n_seen: list[int]
    n_rest: list[int]


class FreshClips:
    """The rounds of a run; a round is made when it is first needed and read from its file when the run is resumed."""

    def __init__(
        self,
        how: FreshRecipe,
        folder: Path,
        tokenizer: Tokenizer | VqVae,
        encoder: TextEncoder,
        seed: int,
        people: TokenCorpus | None = None,
    ) -> None:
        """Settings, folder and models; `people` has clips of people that are trained on beside every round."""
        self._how, self._folder, self._tokenizer, self._encoder = how, folder, tokenizer, encoder
        self._seed, self._people = seed, people
        self._rounds: dict[int, Round] = {}
        self._corpus: tuple[int, TokenCorpus] | None = None

    def corpus(self, step: int) -> TokenCorpus:
        """The training data at `step`: the newest rounds, and the clips of people."""
        newest = step // self._how.every
        if self._corpus is None or self._corpus[0] != newest:
            kept = range(max(0, newest - self._how.rounds + 1), newest + 1)
            with torch.autocast("cpu", enabled=False):  # captions are read in full precision, as the engine reads
                self._rounds = {k: self._rounds.get(k) or self._round(k) for k in kept}
                self._corpus = newest, self._together([self._rounds[k] for k in kept])
        return self._corpus[1]

    def _round(self, k: int) -> Round:
        path = self._folder / f"round_{k:04d}.pt"
        if not path.is_file() and distributed.rank() == 0:
            made = self._made(k)
            self._folder.mkdir(parents=True, exist_ok=True)
            with written_whole(path) as partial:
                torch.save({"ids": made.ids, "caption_rows": made.caption_rows, "captions": made.captions,
                            "words": made.states.words, "n_words": torch.from_numpy(made.states.n_words),
                            "sentences": made.states.sentences, "n_seen": made.n_seen, "n_rest": made.n_rest}, partial)  # fmt: skip
        distributed.wait()
        kept = torch.load(path, weights_only=True)
        states = CaptionStates(kept["words"], kept["n_words"].numpy(), kept["sentences"])
        none = [0] * len(kept["ids"])  # older round files have neither key
        n_seen, n_rest = kept.get("n_seen") or none, kept.get("n_rest") or none
        return Round(kept["ids"], kept["caption_rows"], kept["captions"], states, n_seen, n_rest)

    def _made(self, k: int) -> Round:
        clips = self._clips(k)
        captions = sorted({c for clip in clips for c in clip.captions})
        row = {caption: i for i, caption in enumerate(captions)}
        rows = [[row[c] for c in clip.captions] for clip in clips]
        log.info("round %d: %d clips, %d captions", k, len(clips), len(captions))
        states = CaptionStates.encode(captions, self._encoder)
        ids = encode_clips(clips, self._tokenizer)
        return Round(ids, rows, captions, states, [clip.n_seen for clip in clips], [clip.n_rest for clip in clips])

    def clips(self, step: int) -> list[Clip]:
        """The motions of the newest round at `step`, made again because a round keeps only their ids."""
        return self._clips(step // self._how.every)

    def _clips(self, k: int) -> list[Clip]:
        return make_round(self._how, self._seed, k, read_weights(self._folder / WEIGHTS_FILE))

    def _together(self, rounds: Sequence[Round]) -> TokenCorpus:
        """One corpus of the rounds and of people's clips."""
        parts = [(r.ids, r.caption_rows, r.states) for r in rounds]
        n_seen, n_rest = [n for r in rounds for n in r.n_seen], [n for r in rounds for n in r.n_rest]
        if self._people is not None:
            parts.append((self._people.ids, self._people.caption_rows, self._people.captions))
            n_seen += self._people.seen(range(len(self._people.ids))).tolist()
            n_rest += [0] * len(self._people.ids)
        ids, rows, first = [], [], 0
        for part_ids, part_rows, states in parts:
            ids += part_ids
            rows += [[first + r for r in clip] for clip in part_rows]
            first += len(states.n_words)
        states = CaptionStates(
            torch.cat([s.words for *_, s in parts]), np.concatenate([s.n_words for *_, s in parts]),
            torch.cat([s.sentences for *_, s in parts]),
        )  # fmt: skip
        n_people = 0 if self._people is None else len(self._people.ids)
        is_real = np.arange(len(ids)) >= len(ids) - n_people
        return TokenCorpus(ids, rows, states, is_real, np.array(n_seen, np.int64), np.array(n_rest, np.int64))
