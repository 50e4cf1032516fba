"""A loaded checkpoint and its text encoder: reads texts, predicts lengths, turns ids into motions and motions into ids."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import islice

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from mmm_core.errors import GenerationError
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.inference.checkpoint import Model
from mmm_core.inference.people_weights import PeopleWeights
from mmm_core.language.commands import MOST_STEPS, PlainCommand, Reading, read_exactly
from mmm_core.language.scope import ScopeVerdict, clauses_of, unreadable, with_clauses
from mmm_core.model.clip import ClipText
from mmm_core.model.sampling import FirstStep, SamplingSettings, fill
from mmm_core.model.text import TextEncoder, TextStates, strip_emoji
from mmm_core.model.tokens import FRAMES_PER_TOKEN, pack_ids, tokens_for_frames, unpack_ids
from mmm_core.motion.features import Root, mirror, recover, recover_from_positions
from mmm_core.motion.motion import FPS, Motion

SHORTEST_TOKENS = 4
"""Tokens (0.8 s) of the shortest predicted length; shorter predictions are raised to it."""


class MotionModel:
    """A checkpoint ready for use; one thread at a time may use it.

    Attributes:
        model: the checkpoint's modules.
        encoder: the text encoder, the checkpoint's own or the shipped one.
        checkpoint_hash: names the checkpoint in every motion and answer.
        settings: how tokens are sampled.
        reader: reads texts; None for a model that is given every text as it is.
        people: weights for captions of people; None for a model that fills all rows with the same weights.
    """

    def __init__(
        self,
        model: Model,
        encoder: TextEncoder,
        checkpoint_hash: str,
        settings: SamplingSettings,
        reader: SentenceReader | None = None,
        people: PeopleWeights | None = None,
    ) -> None:
        self.model = model
        self.encoder = encoder
        self.checkpoint_hash = checkpoint_hash
        self.settings = settings
        self.reader = reader
        self.people = people

    def understand(self, text: str) -> tuple[TextStates, ScopeVerdict]:
        """States of a text in plain words (`mmm_core.language.reading`) and its scope verdict."""
        reading = self.reading_of(text)
        if not reading.steps:
            return self.read([text]), nothing_to_do(reading)
        return self.understand_all([reading.words], [reading.outside])[0]

    def verdict(self, text: str, sentence: Tensor, outside: float = 0.0) -> ScopeVerdict:
        """The scope verdict on a text with its unit sentence vector (D,) and the probability that it asks for no gesture."""
        scope = self.model.scope
        return _without_scope(text) if scope is None else scope.judge(text, sentence, outside)

    def reading_of(self, text: str) -> Reading:
        """The commands that are read in a text; an imported model is given every text as it is."""
        if self.reader is None or unreadable(text):
            exact = read_exactly(text)
            said = text if exact is None else exact.words
            return Reading(said, ((PlainCommand(said),),), plain=True)
        return self.reader.read(text)

    def understand_all(
        self, texts: list[str], outside: Sequence[float] | None = None
    ) -> list[tuple[TextStates, ScopeVerdict]]:
        """States and scope verdicts of several texts, encoded in one batch.

        Texts are not rewritten. A text of which only a part can be done (`ScopeVerdict.kept`) has the states of that part.

        Args:
            texts: in plain words.
            outside: for each text, the probability that it asks for no gesture; 0 when None.
        """
        states = self.read(texts)
        scope = self.model.scope
        if scope is None:
            return [(states.row(i), _without_scope(text)) for i, text in enumerate(texts)]
        none = outside or [0.0] * len(texts)
        verdicts = [self.verdict(*one) for one in zip(texts, states.sentence, none, strict=True)]
        clauses = [clauses_of(text) if scope.classifier is not None else [] for text in texts]
        read = [clause for several in clauses for clause in several]
        if read:
            parts = map(scope.judge, read, self.read(read).sentence)
            verdicts = [
                with_clauses(whole, several, list(islice(parts, len(several))))
                for whole, several in zip(verdicts, clauses, strict=True)
            ]
        return [
            (self.read([verdict.kept]) if verdict.kept else states.row(i), verdict)
            for i, verdict in enumerate(verdicts)
        ]

    def read(self, texts: list[str]) -> TextStates:
        """States of texts that are not rewritten, without a scope verdict. A text without words is read as a full stop.

        CLIP knows emoji; from the compact encoder's texts they are removed (`strip_emoji`).
        """
        if isinstance(self.encoder, ClipText):
            return self.encoder.encode(texts)
        return self.encoder.encode([strip_emoji(text) or "." for text in texts])

    def predicted_frames(self, states: TextStates) -> int:
        """Frames that the length predictor gives for the first text: a whole number of tokens.

        Raises:
            GenerationError: the model has no length predictor.
        """
        if self.model.length is None:
            raise GenerationError("no length was asked for", "seconds: this model was not trained to choose a length")
        return max(SHORTEST_TOKENS, self.model.length.n_tokens(states)[0]) * FRAMES_PER_TOKEN

    def fill(
        self,
        words: Sequence[str],
        states: TextStates,
        rows: Sequence[Tensor],
        seeds: Sequence[int],
        settings: SamplingSettings | None = None,
        first: FirstStep | None = None,
    ) -> list[Tensor]:
        """Fill the [MASK]s of `rows`, each with the weights for its words; the ids are those of the model's own tokenizer.

        A row that holds ids already is filled with the model's own weights.

        Args:
            words: B commands or captions.
            states: their states.
            rows: as in `mmm_core.model.sampling.fill`.
            seeds: one for each row.
            settings: how tokens are sampled; the model's own when None.
            first: as in `mmm_core.model.sampling.fill`.
        """
        made = self._filled(words, states, rows, seeds, settings, first)
        return [ids if people is None else self._own_ids(people, ids) for people, ids in made]

    def filled_features(
        self, words: Sequence[str], states: TextStates, rows: Sequence[Tensor], seeds: Sequence[int]
    ) -> list[NDArray[np.float32]]:
        """Features (T, F) of `rows` filled as by `fill`, each decoded by itself, since padding would change a motion's end."""
        made = self._filled(words, states, rows, seeds)
        return [(people or self.model).tokenizer.decode(ids[None])[0].numpy() for people, ids in made]

    def fill_with(
        self, people: PeopleWeights | None, states: TextStates, rows: Sequence[Tensor], seeds: Sequence[int],
        settings: SamplingSettings | None = None, first: FirstStep | None = None,
    ) -> list[Tensor]:  # fmt: skip
        """Fill the [MASK]s of `rows` with the weights for captions of people, in ids of their tokenizer; with None as usual."""
        how = settings or self.settings
        if people is None:
            return fill(self.model.transformer, states, rows, seeds, how, first=first)
        return fill(people.transformer, states, rows, seeds, replace(how, guidance=people.guidance), first=first)

    def _filled(
        self, words: Sequence[str], states: TextStates, rows: Sequence[Tensor], seeds: Sequence[int],
        settings: SamplingSettings | None = None, first: FirstStep | None = None,
    ) -> list[tuple[PeopleWeights | None, Tensor]]:  # fmt: skip
        """For each row the weights that filled it, and its ids, which are those of their tokenizer."""
        made, mask = dict[int, Tensor](), self.model.transformer.ids.mask
        weights = [
            self.weights_for(one, sentence) if bool((row == mask).all()) else None
            for one, sentence, row in zip(words, states.sentence, rows, strict=True)
        ]
        for people in set(weights):
            mine = [i for i, one in enumerate(weights) if one is people]
            theirs = states if len(mine) == len(words) else TextStates.stacked([states.row(i) for i in mine])
            filled = self.fill_with(people, theirs, [rows[i] for i in mine], [seeds[i] for i in mine], settings, first)
            made |= dict(zip(mine, filled, strict=True))
        return [(weights[i], made[i]) for i in range(len(words))]

    def _own_ids(self, people: PeopleWeights, ids: Tensor) -> Tensor:
        """(L, C) ids, in the model's own tokenizer, of the motion that the tokenizer for people decodes from `ids`."""
        return self.model.tokenizer.encode(people.tokenizer.decode(ids[None]))[0]

    def weights_for(self, words: str, sentence: Tensor) -> PeopleWeights | None:
        """The weights for words with their sentence vector (D,); None: the model's own, for all but captions of people."""
        return self.people if self.people is not None and self.people.are_for(words, sentence) else None

    def motion(
        self,
        ids: Tensor,
        text: str,
        seed: int,
        verdict: ScopeVerdict,
        n_frames: int | None = None,
        *,
        is_mirrored: bool = False,
        people: PeopleWeights | None = None,
    ) -> Motion:
        """The motion of a row of ids (L, C), cut to `n_frames`; the ids are those of `people`'s tokenizer where it is given.

        A mirrored motion, and one of `people`, carries the ids that encode its features in the model's own tokenizer.
        """
        with torch.inference_mode():
            whole = (people or self.model).tokenizer.decode(ids[None])[0]
            if is_mirrored:
                whole = torch.from_numpy(mirror(whole.numpy()))
            if is_mirrored or people is not None:
                ids = self.model.tokenizer.encode(whole[None])[0]
            features = whole[:n_frames].numpy()
        return self.motion_of_features(features, ids, text, seed, verdict)

    def motion_of(
        self,
        features: np.ndarray,
        text: str,
        seed: int,
        verdict: ScopeVerdict,
        n_frames: int | None = None,
        *,
        is_mirrored: bool = False,
    ) -> Motion:
        """The motion of features (T, 263) that were changed after decoding; it carries the ids that encode them."""
        features = (mirror(features) if is_mirrored else features)[:n_frames]
        over = -len(features) % FRAMES_PER_TOKEN
        padded = np.concatenate([features, np.repeat(features[-1:], over, 0)]).astype(np.float32)
        with torch.inference_mode():
            ids = self.model.tokenizer.encode(torch.from_numpy(padded)[None])[0]
        return self.motion_of_features(features, ids, text, seed, verdict)

    def motion_of_features(
        self, features: np.ndarray, ids: Tensor, text: str, seed: int, verdict: ScopeVerdict, start: Root | None = None
    ) -> Motion:
        """The motion of decoded features (T, 263) and their ids (L, C), whose first frame stands at `start`."""
        recovered = (recover if self.model.rest_pose == "mmmd" else recover_from_positions)(features, start)
        return Motion(
            joints_m=recovered.joints_m.astype(np.float32),
            fps=FPS,
            head_quat_wxyz=recovered.head_quat_wxyz.astype(np.float32),
            forearm_twist_rad=recovered.forearm_twist_rad.astype(np.float32),
            features=features,
            tokens=pack_ids(ids.numpy(), self.model.tokenizer.config.n_codes),
            text=text,
            seed=seed,
            status=verdict.status,
            scope_score=verdict.score,
        )

    def ids_of(self, motion: Motion) -> Tensor:
        """(L, C) ids of a motion: its own if they fit its frames, else the ids that encode its features.

        Raises:
            GenerationError: the motion has neither ids nor features, or another frame rate or other features than the model.
        """
        tokenizer = self.model.tokenizer
        if motion.fps != FPS or motion.features.shape[1] != len(tokenizer.mean):
            asked = f"a motion of {motion.fps:g} fps and {motion.features.shape[1]} features was given"
            raise GenerationError(asked, f"{FPS:g} fps and {len(tokenizer.mean)} features, as this model's")
        if len(motion.tokens) and len(motion.tokens) == tokens_for_frames(len(motion.features)):
            return torch.from_numpy(unpack_ids(motion.tokens, tokenizer.config.n_codes, tokenizer.n_codebooks))
        n_frames = len(motion.features) // FRAMES_PER_TOKEN * FRAMES_PER_TOKEN
        if not n_frames or not motion.features.any():
            raise GenerationError("a motion without features or tokens was given", "one written by `mmmd generate`")
        with torch.inference_mode():
            return tokenizer.encode(torch.from_numpy(motion.features[None, :n_frames]))[0]


def nothing_to_do(reading: Reading) -> ScopeVerdict:
    """The verdict on a text that asks for nothing, only says what not to do, or asks for too much."""
    if reading.too_many:
        why = f"{reading.too_many} commands, at most {MOST_STEPS} fit into a text; say the others in texts of their own"
        return ScopeVerdict("rejected", 0.0, "", f"nothing is done: {why}")
    denied = "', '".join(reading.denied)
    why = f"it only says not to do '{denied}'" if denied else "it asks for no movement; to move, say what to do: 'nod'"
    return ScopeVerdict("rejected", 0.0, "", f"nothing is to be done: {why}")


def check_seed(seed: int) -> None:
    """Raises GenerationError for a seed outside 0 to 2^31 - 1."""
    if not 0 <= seed < 2**31:
        raise GenerationError(f"seed {seed} was asked for", "0 to 2147483647")


def _without_scope(text: str) -> ScopeVerdict:
    """The verdict of an imported model, which accepts every text but an empty one."""
    return (
        ScopeVerdict("accepted", 1.0, "", "")
        if text.strip()
        else ScopeVerdict("rejected", 0.0, "", "the text is empty")
    )
