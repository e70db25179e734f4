"""Laws of the rival judges: right on clean curves of the classes they know, as published."""

import numpy as np
import pytest

from experiments.validation.accuracy import JUDGES, PACKAGES, google_benchmark, installed_judges
from experiments.validation.synthetic import GROWTH

SIZES = np.geomspace(100, 1e5, 7).round()
KNOWN = {
    "hem": set(GROWTH),
    "bigo": set(GROWTH),
    "big-o": set(GROWTH) - {"O(√n)"},
    "Google Benchmark": set(GROWTH) - {"O(√n)"},
}


@pytest.mark.parametrize("name", JUDGES)
def test_a_judge_names_clean_curves_of_the_classes_it_knows(name: str) -> None:
    if name not in installed_judges():
        pytest.skip(f"the package {name} is not installed")
    rng = np.random.default_rng(1)
    for known in KNOWN[name]:
        samples = [3e-9 * c * rng.lognormal(0, 1e-4, 5) for c in GROWTH[known](SIZES)]
        latency = np.ones_like(SIZES) if name == "hem" else None
        assert JUDGES[name](SIZES, samples, latency) == known


def test_google_benchmarks_rule_has_no_intercept() -> None:
    n = np.array([1.0, 2, 3, 4, 5, 6])
    assert google_benchmark(n, [np.array([time]) for time in 5 * n]) == "O(n)"
    assert google_benchmark(n, [np.array([20 + time]) for time in n]) != "O(n)"


def test_google_benchmarks_rule_is_least_squares_over_all_points() -> None:
    n, t = np.array([2.0, 4.0, 8.0]), [np.array([3.0, 5.0]), np.array([9.0]), np.array([15.0])]
    points, times = np.array([2.0, 2, 4, 8]), np.array([3.0, 5, 9, 15])
    curves = {
        "O(1)": points**0,
        "O(log n)": np.log2(points),
        "O(n)": points,
        "O(n log n)": points * np.log2(points),
        "O(n²)": points**2,
    }
    rms = {}
    for name, curve in curves.items():
        (coefficient,), *_ = np.linalg.lstsq(curve[:, None], times, rcond=None)
        rms[name] = np.sqrt(np.mean((times - coefficient * curve) ** 2)) / times.mean()
    assert google_benchmark(n, t) == min(rms, key=lambda name: rms[name])


def test_units_change_no_answer() -> None:
    rng = np.random.default_rng(2)
    for growth in GROWTH:
        samples = [c * rng.lognormal(0, 0.01, 5) for c in GROWTH[growth](SIZES)]
        for name, judge in installed_judges().items():
            if name in ("hem", "Google Benchmark"):
                scaled = [1e-9 * case for case in samples]
                assert judge(SIZES, samples, None) == judge(SIZES, scaled, None)


def test_every_package_belongs_to_a_judge() -> None:
    assert set(PACKAGES) <= set(JUDGES)
    assert set(JUDGES) - set(PACKAGES) <= set(installed_judges())
