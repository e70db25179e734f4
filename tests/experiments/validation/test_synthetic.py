"""Laws of the corpus, and of the judge on it: how many curves it names right, how many wrong."""

import numpy as np
import pytest

from experiments.validation.accuracy import ASKED, UNDETERMINED, named, shares
from experiments.validation.judges import JUDGES
from experiments.validation.synthetic import CURVES, PARTS, curve, curves


@pytest.mark.parametrize("part", PARTS)
def test_the_judge_names_as_many_right_and_as_few_wrong_as_asked(part: str) -> None:
    drawn = [it for name in CURVES for it in curves(name, part, 48, seed=11)]
    found = shares(named({"hem": JUDGES["hem"]}, drawn)).loc[("hem", part)]
    right, wrong = ASKED[part]
    print(f"\n{part:11} {found.to_dict()}", end="")
    assert found["right"] >= right
    assert found["wrong"] <= wrong
    assert found.sum() == pytest.approx(1)
    if part == "unmeasured":
        assert found[UNDETERMINED] >= 0.9


@pytest.mark.parametrize("name", CURVES)
def test_a_curve_without_noise_and_rise_is_its_class(name: str) -> None:
    rng = np.random.default_rng(1)
    made = curve(rng, name, "none", 0.0, 0.0)
    growth = CURVES[name](made.sizes)
    assert [np.median(case) for case in made.samples] == pytest.approx((3e-9 * growth).tolist())
    assert made.latency is None


def test_the_same_seed_gives_the_same_curves_and_another_others() -> None:
    first, again, other = (
        np.concatenate([np.concatenate(it.samples) for it in curves("O(n)", "measured", 6, seed)])
        for seed in (1, 1, 2)
    )
    assert np.array_equal(first, again)
    assert not np.array_equal(first[:5], other[:5])


def test_a_rise_is_about_tenfold_and_its_latency_is_given_where_it_was_measured() -> None:
    for part in PARTS:
        for made in curves("O(1)", part, 60):
            cost = np.array([np.median(case) for case in made.samples])
            rise = cost.max() / cost[0]
            assert rise < (14 if part in ("measured", "unmeasured") else 1.3)
            assert (made.latency is None) == (part in ("none", "unmeasured"))


def test_a_count_that_does_not_divide_is_refused() -> None:
    with pytest.raises(ValueError, match="multiple of 6"):
        next(curves("O(n)", "none", 7))
