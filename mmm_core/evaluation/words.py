"""Word vectors for the published evaluator: GloVe vectors and parts of speech, from a user's files.

The files are `our_vab_data.npy` (N, 300), `our_vab_words.pkl` (N words) and `our_vab_idx.pkl` (word: row). The pickles are read
without running any code in them. Tokens are "word/POS", as in the data sets' text files.
"""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmm_core.errors import CheckpointError, EvaluationError

MAX_WORDS = 20
"""Tokens of a caption that are read at most."""
MARKS = ("unk", "sos", "eos")
"""Marks that the vocabulary must contain: for unknown words and padding, for a caption's start and for its end."""
PARTS_OF_SPEECH = (
    "VERB", "NOUN", "DET", "ADP", "NUM", "AUX", "PRON", "ADJ", "ADV",
    "Loc_VIP", "Body_VIP", "Obj_VIP", "Act_VIP", "Desc_VIP", "OTHER",
)  # fmt: skip
_SPECIAL = {
    "Loc_VIP": "left right clockwise counterclockwise anticlockwise forward back backward up down straight curve",
    "Body_VIP": "arm chin foot feet face hand mouth leg waist eye knee shoulder thigh",
    "Obj_VIP": "stair dumbbell chair window floor car ball handrail baseball basketball",
    "Act_VIP": "walk run swing pick bring kick put squat throw hop dance jump turn stumble stop sit lift lower raise wash "
    "stand kneel stroll rub bend balance flap jog shuffle lean rotate spin spread climb",
    "Desc_VIP": "slowly carefully fast careful slow quickly happy angry sad happily angrily sadly",
}
_PLACE = {word: kind for kind, words in _SPECIAL.items() for word in words.split()}


class WordVectors:
    """Vectors of words; `read` makes the input of `extractors.TextReader`."""

    def __init__(self, vectors: dict[str, np.ndarray]) -> None:
        self.vectors = vectors
        self.width = len(next(iter(vectors.values())))

    def read(self, captions: list[tuple[str, ...]]) -> tuple[Tensor, Tensor, Tensor]:
        """Word vectors (B, 22, 300), parts of speech (B, 22, 15) and lengths (B,); start and end marks are added.

        A caption of more than twenty tokens is cut.

        Raises:
            EvaluationError: a caption has no tokens, as in a clips.jsonl folder.
        """
        if not all(captions):
            raise EvaluationError("captions without word/POS tokens", "a HumanML3D or KIT-ML folder for GloVe vectors")
        width = MAX_WORDS + 2
        words, kinds = (
            np.zeros((len(captions), width, self.width), np.float32),
            np.zeros((len(captions), width, len(PARTS_OF_SPEECH)), np.float32),
        )
        lengths = []
        for row, tokens in enumerate(captions):
            several = ("sos/OTHER", *tokens[:MAX_WORDS], "eos/OTHER")
            lengths.append(len(several))
            for column in range(width):
                word, _, kind = (several[column] if column < len(several) else "unk/OTHER").rpartition("/")
                known = word in self.vectors
                words[row, column] = self.vectors[word if known else "unk"]
                kind = _PLACE.get(word, kind if kind in PARTS_OF_SPEECH else "OTHER") if known else "OTHER"
                kinds[row, column, PARTS_OF_SPEECH.index(kind)] = 1
        return torch.from_numpy(words), torch.from_numpy(kinds), torch.tensor(lengths)


def read_vectors(folder: Path) -> WordVectors:
    """The word vectors in the three files of a folder.

    Raises:
        CheckpointError: a file is missing, broken, or holds anything but words and numbers.
    """
    paths = [folder / f"our_vab_{part}" for part in ("data.npy", "words.pkl", "idx.pkl")]
    for path in paths:
        if not path.is_file():
            raise CheckpointError(path, "", "no such file", "the published word vectors (glove/our_vab_*)")
    try:
        table = np.load(paths[0], allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise CheckpointError(paths[0], "", f"not a readable .npy ({error})", "(N, 300)") from None
    if table.ndim != 2 or not np.issubdtype(table.dtype, np.floating) or not np.isfinite(table).all():
        raise CheckpointError(paths[0], "", f"{table.dtype} of shape {table.shape}", "(N, 300) finite numbers")
    words, index = (_plain_pickle(path) for path in paths[1:])
    try:
        vectors = {str(word): table[int(index[word])] for word in words}
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise CheckpointError(paths[2], "", f"does not fit the other two ({error!r})", "a row for each word") from None
    for mark in MARKS:
        if mark not in vectors:
            raise CheckpointError(paths[1], mark, "missing", f"the words {', '.join(MARKS)} among the {len(vectors)}")
    return WordVectors(vectors)


class _NothingRuns(pickle.Unpickler):
    """Unpickler that refuses every class and function."""

    def find_class(self, module: str, name: str) -> Any:
        raise pickle.UnpicklingError(f"it asks for {module}.{name}")


def _plain_pickle(path: Path) -> Any:
    try:
        with path.open("rb") as f:
            return _NothingRuns(f).load()
    except Exception as error:  # a broken pickle can raise nearly any error, but no code of the file has run
        raise CheckpointError(path, "", f"not a plain pickle ({error})", "words or numbers; nothing was run") from None
