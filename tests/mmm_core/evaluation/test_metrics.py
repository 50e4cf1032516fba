"""Metrics against hand-computed cases and independent implementations (SciPy, scikit-learn)."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from mmm_core.errors import EvaluationError
from mmm_core.evaluation import metrics
from mmm_core.evaluation.metrics import Interval
from tests.support.sizes import examples


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


class TestRPrecision:
    def test_by_hand(self) -> None:
        """Texts on a line at 0, 1, .. 31; motion i lies at i but for three that changed places in a ring."""
        texts = np.arange(32.0)[:, None]
        motions = texts.copy()
        motions[[0, 1, 2]] = motions[[1, 2, 0]]
        # text 0: its motion at 1, nearer: the one at 0 -> second. text 1: own at 2; nearer: 1; as far: 0 -> second.
        # text 2: own at 0, distance 2; nearer: 2, 1, 3; as far: 4 -> fourth or fifth.
        # text 1 shares places two and three with the motion at 0: half a hit among the first two, a whole one of three.
        assert metrics.r_precision(texts, motions, rng()) == {1: 29 / 32, 2: 30.5 / 32, 3: 31 / 32}

    @given(st.integers(0, 50))
    def test_perfect_pairs_and_chance(self, seed: int) -> None:
        vectors = rng(seed).normal(size=(96, 8))
        assert metrics.r_precision(vectors, vectors, rng(seed))[1] == 1.0
        chance = metrics.r_precision(vectors, rng(seed + 1000).normal(size=(96, 8)), rng(seed))
        assert 0.0 <= chance[1] <= chance[2] <= chance[3] < 0.4

    def test_one_motion_for_every_text_is_chance(self) -> None:
        """A collapsed model was once given 100 %: no other motion is nearer than one's own when all are the same."""
        texts = rng(0).normal(size=(64, 8))
        assert metrics.r_precision(texts, np.ones((64, 8)), rng()) == {1: 1 / 32, 2: 2 / 32, 3: 3 / 32}

    @pytest.mark.long
    @given(st.integers(0, 50), st.sampled_from([0.1, 1.0, 4.0]))
    def test_it_is_scikit_learns_top_k_accuracy(self, seed: int, noise: float) -> None:
        # Here, as it takes half a second and every process of the suite reads this file.
        from sklearn.metrics import top_k_accuracy_score

        texts = rng(seed).normal(size=(32, 6))
        motions = texts + noise * rng(seed + 1).normal(size=(32, 6))
        ours, own = metrics.r_precision(texts, motions, rng(seed)), np.arange(32)
        for top in metrics.TOP:
            assert ours[top] == pytest.approx(top_k_accuracy_score(own, -cdist(texts, motions), k=top))

    def test_each_pool_is_judged_by_itself(self) -> None:
        """Everybody's double sits in the other pool, if the pools are so drawn; with one pool of 64 nobody is first alone."""
        vectors = np.repeat(rng(2).normal(size=(32, 4)), 2, axis=0)
        alone = metrics.r_precision(vectors, vectors, rng(), pool=64)
        assert alone == {1: 0.5, 2: 1.0, 3: 1.0}
        assert metrics.r_precision(vectors, vectors, rng())[1] > 0.5

    def test_a_motion_that_is_not_finite_is_refused(self) -> None:
        """NaN is nearer than nothing and would count as a hit."""
        broken = np.ones((64, 8))
        broken[7, 3] = np.nan
        for metric in (metrics.frechet_distance, metrics.mm_dist, lambda a, b: metrics.r_precision(a, b, rng())):
            with pytest.raises(EvaluationError, match=r"1 of .* vectors with NaN"):
                metric(np.zeros((64, 8)), broken)

    def test_too_few_pairs_are_refused(self) -> None:
        with pytest.raises(EvaluationError, match="31 pairs"):
            metrics.r_precision(np.zeros((31, 2)), np.zeros((31, 2)), rng())

    def test_distances_are_scipys(self) -> None:
        a, b = rng(1).normal(size=(5, 7)), rng(2).normal(size=(6, 7))
        np.testing.assert_allclose(metrics.distances(a, b), cdist(a, b), atol=1e-10)


class TestFrechetDistance:
    def test_by_hand_in_one_dimension(self) -> None:
        """Gaussians N(0, 1) and N(3, 4): (0 - 3)^2 + (1 - 2)^2 = 10."""
        a = np.array([-1.0, 1.0, -1.0, 1.0]) * np.sqrt(3 / 4)
        b = 3 + 2 * a
        assert metrics.frechet_distance(a[:, None], b[:, None]) == pytest.approx(10.0)

    @settings(max_examples=examples(20))
    @given(st.integers(0, 99), st.integers(2, 12))
    def test_the_root_is_scipys(self, seed: int, width: int) -> None:
        a, b = (
            rng(seed).normal(size=(60, width)),
            rng(seed + 1).normal(size=(50, width)) @ rng(seed).normal(size=(width, width)) + 1,
        )
        cov_a, cov_b = np.cov(a, rowvar=False), np.cov(b, rowvar=False)
        root = scipy.linalg.sqrtm(cov_a @ cov_b)
        expected = np.square(a.mean(0) - b.mean(0)).sum() + np.trace(cov_a + cov_b - 2 * np.real(root))
        assert metrics.frechet_distance(a, b) == pytest.approx(expected, rel=1e-5)

    def test_a_set_has_no_distance_from_itself_even_with_few_vectors(self) -> None:
        few = rng(3).normal(size=(5, 20))  # a singular covariance
        assert metrics.frechet_distance(few, few) == pytest.approx(0.0, abs=1e-6)

    def test_one_vector_has_no_spread(self) -> None:
        with pytest.raises(EvaluationError, match="at least two"):
            metrics.frechet_distance(np.zeros((1, 3)), np.zeros((5, 3)))

    def test_it_is_symmetric(self) -> None:
        a, b = rng(4).normal(size=(40, 6)), 2 * rng(5).normal(size=(30, 6))
        assert metrics.frechet_distance(a, b) == pytest.approx(metrics.frechet_distance(b, a))


class TestSpread:
    def test_mm_dist_by_hand(self) -> None:
        assert metrics.mm_dist(np.array([[0.0, 0], [1, 1]]), np.array([[3.0, 4], [1, 1]])) == 2.5

    def test_mm_dist_is_scikit_learns(self) -> None:
        from sklearn.metrics.pairwise import paired_euclidean_distances

        a, b = rng(1).normal(size=(9, 5)), rng(2).normal(size=(9, 5))
        assert metrics.mm_dist(a, b) == pytest.approx(paired_euclidean_distances(a, b).mean())

    def test_diversity_of_two_places(self) -> None:
        """Half of the vectors at 0, half at 10: a random pair differs in half of the cases."""
        vectors = np.repeat([[0.0], [10.0]], 500, axis=0)
        assert metrics.diversity(vectors, rng()) == pytest.approx(5.0, abs=0.8)
        assert metrics.diversity(np.ones((400, 3)), rng()) == 0.0

    def test_diversity_is_the_mean_distance_of_all_pairs(self) -> None:
        """Three hundred pairs a draw; over many draws they come to SciPy's mean over all."""
        vectors = rng(3).normal(size=(500, 6))
        drawn = np.mean([metrics.diversity(vectors, rng(seed)) for seed in range(200)])
        assert drawn == pytest.approx(cdist(vectors, vectors).mean(), rel=0.01)

    def test_multimodality_looks_within_a_text_only(self) -> None:
        far_apart = np.stack([np.full((30, 4), 100.0 * text) for text in range(5)])
        assert metrics.multimodality(far_apart, rng()) == 0.0
        spread = rng(1).normal(size=(5, 30, 4))
        assert metrics.multimodality(spread, rng()) == pytest.approx(metrics.multimodality(spread + 7.0, rng()))


def test_interval_by_hand() -> None:
    interval = Interval.of([1.0, 2.0, 3.0, 4.0])
    assert interval.mean == 2.5
    assert interval.half_width == pytest.approx(1.96 * np.sqrt(1.25) / 2)
    assert str(interval) == "2.500±1.096"
