"""Laws of the synthetic curves, and of the judge on them: how many are named right and wrong."""

import numpy as np
import pytest

from experiments.validation.accuracy import (
    ASKED,
    JUDGES,
    UNDETERMINED,
    answer_shares,
    count_answers,
)
from experiments.validation.synthetic import (
    CONDITIONS,
    GROWTH,
    SLOWED,
    TOLD,
    make_curve,
    make_curves,
)
from tests.extent import waiting_for


@pytest.mark.parametrize("condition", waiting_for(SLOWED, CONDITIONS))
def test_the_judge_names_as_many_right_and_as_few_wrong_as_asked(condition: str) -> None:
    drawn = [curve for name in GROWTH for curve in make_curves(name, condition, 48, seed=11)]
    shares = answer_shares(count_answers({"hem": JUDGES["hem"]}, drawn)).loc[("hem", condition)]
    right, wrong = ASKED[condition]
    assert shares["right"] >= right
    assert shares["wrong"] <= wrong
    assert shares.sum() == pytest.approx(1)
    if condition == "latency unknown":
        assert shares[UNDETERMINED] >= 0.9


@pytest.mark.parametrize("name", GROWTH)
def test_a_curve_without_noise_and_slowdown_is_its_class(name: str) -> None:
    rng = np.random.default_rng(1)
    made = make_curve(rng, name, "steady", 0.0, 0.0)
    growth = GROWTH[name](made.sizes)
    assert [np.median(case) for case in made.samples] == pytest.approx((3e-9 * growth).tolist())
    assert made.latency is None


def test_the_same_seed_gives_the_same_curves_and_another_others() -> None:
    first, again, other = (
        np.concatenate(
            [np.concatenate(it.samples) for it in make_curves("O(n)", "prefetched", 6, seed)]
        )
        for seed in (1, 1, 2)
    )
    assert np.array_equal(first, again)
    assert not np.array_equal(first[:5], other[:5])


def test_a_slowdown_is_about_tenfold_and_the_latency_is_given_where_it_is_known() -> None:
    for condition in CONDITIONS:
        for made in make_curves("O(1)", condition, 60):
            cost = np.array([np.median(case) for case in made.samples])
            assert cost.max() / cost[0] < (14 if condition in SLOWED else 1.3)
            assert (made.latency is not None) == (condition in TOLD)


def test_a_count_that_does_not_divide_is_refused() -> None:
    with pytest.raises(ValueError, match="multiple of 6"):
        next(make_curves("O(n)", "steady", 7))
