"""Token arithmetic."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from mmm_core.errors import GenerationError
from mmm_core.model.tokens import frames_for_seconds, pack_ids, tokens_for_frames, unpack_ids


@given(st.sampled_from([512, 2048, 8192]), st.data())
def test_packed_ids_unpack_to_themselves(n_codes: int, data: st.DataObject) -> None:
    """Three of 2,048 codes do not fit into 32 bits."""
    shape = st.tuples(st.integers(1, 49), st.integers(1, 3))
    ids = data.draw(arrays(np.int64, shape, elements=st.integers(0, n_codes - 1)))
    assert np.array_equal(unpack_ids(pack_ids(ids, n_codes), n_codes, ids.shape[1]), ids)


@given(st.integers(1, 196))
def test_tokens_cover_the_frames_without_a_spare_one(n_frames: int) -> None:
    n = tokens_for_frames(n_frames)
    assert 4 * (n - 1) < n_frames <= 4 * n


@pytest.mark.parametrize("seconds", [0, -1, 9.9, float("nan"), float("inf")])
def test_a_length_outside_the_model_is_refused_with_the_range(seconds: float) -> None:
    with pytest.raises(GenerationError, match=r"at most 9\.8 s"):
        frames_for_seconds(seconds, 20.0)
