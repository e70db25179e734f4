"""Laws of the judge: right on curves of known class, hardly ever wrong, silent where data are."""

import json
from collections import Counter
from dataclasses import asdict
from itertools import product
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from experiments.validation.synthetic import CONDITIONS, GROWTH, make_curve, make_curves
from hem.complexity import Verdict, judge
from tests.extent import exhaustive, some

Array = NDArray[np.float64]


def outcomes(name: str, condition: str) -> tuple[Counter[str], Counter[str]]:
    """Outcomes of the true claim, and of two false ones each."""
    true, false = Counter[str](), Counter[str]()
    others = [other for other in GROWTH if other != name]
    for i, c in enumerate(make_curves(name, condition)):
        for claim in (name, others[i % 5], others[(i + 1 + i // 5) % 5]):
            verdict = judge(c.sizes, c.samples, claim, c.latency, resamples=8)
            (true if claim == name else false)[verdict.outcome] += 1
    return true, false


@exhaustive
@pytest.mark.parametrize("name", GROWTH)
def test_curves_of_known_class_are_judged_right_and_hardly_ever_wrong(name: str) -> None:
    wrong = judged = 0
    for condition in CONDITIONS:
        true, false = outcomes(name, condition)
        print(f"\n{name:11} {condition:15} true claim {dict(true)}, false claims {dict(false)}")
        wrong += true["violated"] + false["consistent"]
        judged += true.total() + false.total()
        if condition != "latency unknown":
            assert true["consistent"] >= 0.85 * true.total(), condition
    assert wrong <= 0.01 * judged


def test_a_cache_that_nobody_measured_makes_no_constant_cost_a_violation() -> None:
    """Wherever among the sizes its step lies, however high and wide it is."""
    violated = []
    for count, at, height, width in product(
        (5, 7, 12), np.linspace(0.05, 1, 20), (2.5, 4.3, 6.3, 9.3), (0.3, 0.7, 1.2)
    ):
        sizes = np.geomspace(16, 4096, count).round()
        step = (sizes[0] / sizes) ** (1 / width) * (sizes[-1] / sizes[0]) ** (at / width)
        cost = 1 + (height - 1) / (1 + step)
        verdict = judge(sizes, [[0.99 * it, it, 1.01 * it] for it in cost], resamples=1)
        violated.append(verdict.outcome == "violated")
    assert np.mean(violated) <= 0.01


@pytest.mark.filterwarnings("error")
def test_slopes_are_numbers_where_sizes_begin_at_one() -> None:
    """A logarithm is 0 there."""
    rng = np.random.default_rng(2)
    for claim in ("O(log n)", "O(n log n)", "O(log^2 n)"):
        for _ in range(30):
            samples = [n * rng.lognormal(0, 2, 2) for n in range(1, 6)]
            told = judge([*range(1, 6)], samples, claim, exact=True, resamples=9)
            assert np.isfinite([told.slope, told.slope_low, told.slope_high]).all()


def noise_alone(rng: np.random.Generator, kind: str) -> list[Array]:
    if kind == "wild samples":
        return [rng.lognormal(0, 1, 20) for _ in range(7)]
    if kind == "uniform samples":
        return [rng.random(20) for _ in range(7)]
    return [level * rng.lognormal(0, 0.05, 20) for level in rng.lognormal(0, 1, 7)]


@pytest.mark.parametrize("latency", [None, np.geomspace(1, 10, 7)], ids=["bare", "latency"])
@pytest.mark.parametrize("kind", ["wild samples", "uniform samples", "wild sizes"])
def test_pure_noise_is_undetermined(kind: str, latency: Array | None) -> None:
    rng = np.random.default_rng(1)
    sizes = np.geomspace(100, 1e6, 7)
    decided = 0
    for i in range(6 * some(25)):
        claim = list(GROWTH)[i % 6]
        verdict = judge(sizes, noise_alone(rng, kind), claim, latency, resamples=8)
        decided += verdict.outcome != "undetermined"
    assert decided <= 1


@pytest.mark.parametrize("name", GROWTH)
@pytest.mark.parametrize("fixed", [0, 7])
@pytest.mark.parametrize("sizes", [2.0 ** np.arange(2, 13), np.geomspace(200, 20000, 5).round()])
def test_exact_counts_confirm_their_class_alone(name: str, fixed: int, sizes: Array) -> None:
    counts = np.round(fixed + 10 * GROWTH[name](sizes))
    samples = [[count] for count in counts]
    for claim in GROWTH:
        outcome = judge(sizes, samples, claim, exact=True).outcome
        assert outcome == ("consistent" if claim == name else "violated"), claim


def test_exact_counts_have_an_exact_slope() -> None:
    sizes = 2.0 ** np.arange(4, 12)
    verdict = judge(sizes, [[5 * n] for n in sizes], "O(n_t)", exact=True)
    assert verdict.slope_low == pytest.approx(1) == verdict.slope_high
    assert verdict.coefficients["O(n)"] == {
        "fixed": 0, "factor": pytest.approx(5), "lower": 0, "slowdown": 1,
    }  # fmt: skip
    assert verdict.errors["O(n)"] == pytest.approx(0, abs=1e-9)


def test_what_grows_a_hundredfold_needs_no_long_range() -> None:
    sizes = np.arange(12, 23)
    assert sizes[-1] < 2 * sizes[0]
    verdict = judge(sizes, [[1e-7 * 2.0**n] for n in sizes], "2^n")
    assert verdict.outcome == "consistent"
    assert judge(sizes, [[1e-7 * n] for n in sizes], "n").outcome == "undetermined"


def flat(rng: np.random.Generator, sizes: Array, noise: float = 0.03) -> list[Array]:
    return [rng.lognormal(0, noise, 15) for _ in sizes]


def test_a_cost_may_have_waited_as_any_one_of_several_latencies_tells() -> None:
    rng = np.random.default_rng(4)
    sizes = np.geomspace(300, 3e6, 9)
    early, late = (1 + 30 / (1 + (turn / sizes) ** 2) for turn in (1e4, 3e5))
    samples = [3e-8 * cost * rng.normal(1, 0.01, 15) for cost in 1 + (late - 1) / 10]
    assert judge(sizes, samples, "O(1)", early).outcome != "consistent"
    either = judge(sizes, samples, "O(1)", np.vstack([early, late]))
    assert either.outcome == "consistent"
    again = judge(sizes, samples, "O(1)", np.vstack([late, early]))
    assert (again.outcome, again.best) == (either.outcome, either.best)
    linear = [1e-11 * n * rng.normal(1, 0.01, 15) + 1e-9 for n in sizes]
    assert judge(sizes, linear, "O(1)", np.vstack([early, late])).outcome == "violated"


def test_a_tenfold_slowdown_violates_constant_time_only_beyond_the_latency() -> None:
    rng = np.random.default_rng(2)
    sizes = np.geomspace(100, 1e6, 9)
    slowdown = 1 + 9 / (1 + (3e4 / sizes) ** 1.2)
    cache_bound = [r * s for r, s in zip(slowdown, flat(rng, sizes), strict=True)]
    blind = judge(sizes, cache_bound)
    assert blind.outcome == "undetermined"
    assert "caches that no latency tells of" in blind.reason
    given = judge(sizes, cache_bound, latency=1.2 * slowdown)
    assert given.outcome == "consistent"
    assert given.raw_slope > 0.25 > 0.05 > abs(given.slope)
    growing = [s * n**0.5 for s, n in zip(cache_bound, sizes, strict=True)]
    assert judge(sizes, growing, latency=1.2 * slowdown).outcome == "violated"


def test_a_slowdown_that_the_latency_may_not_tell_accuses_nobody() -> None:
    sizes = np.geomspace(100, 1_000_000, 8)
    saturated = np.array([1, 2, 3, 3, 3, 3, 3, 3])
    risen = [[20 * r] * 7 for r in (1, 1, 1, 1.2, 1.5, 2.2, 4, 8)]
    linear = [[20 + 0.01 * n] * 7 for n in sizes]
    level = [[20 * (1 + 0.01 * (i % 2))] * 7 for i in range(8)]
    assert judge(sizes, risen, "O(1)", saturated).outcome == "violated"
    assert judge(sizes, risen, "O(1)", saturated, unseen=True).outcome == "undetermined"
    assert judge(sizes, linear, "O(1)", saturated, unseen=True).outcome == "violated"
    assert judge(sizes, linear, "O(n)", saturated, unseen=True).outcome == "consistent"
    assert judge(sizes, level, "O(1)", saturated, unseen=True).outcome == "consistent"


@pytest.mark.parametrize(("last", "said"), [(1.6, "undetermined"), (2.6, "violated")])
def test_times_accuse_only_of_more_than_neighbors_do(last: float, said: str) -> None:
    sizes = 2.0 ** np.arange(2, 13)
    growth = 1 + (last - 1) * sizes / sizes[-1]
    times = [[g * (1 + 0.01 * (i % 3)) for i in range(9)] for g in growth]
    counts = [[round(1000 * g)] for g in growth]
    assert judge(sizes, times, "O(1)", np.ones(11)).outcome == said
    assert judge(sizes, counts, "O(1)", exact=True).outcome == "violated"


def test_small_valences_with_an_intercept_are_linear() -> None:
    rng = np.random.default_rng(3)
    valence = np.array([4, 6, 8, 12, 16, 24, 32, 48, 64.0])
    samples = [(12 + 3 * v) * rng.lognormal(0, 0.02, 20) for v in valence]
    assert judge(valence, samples, "O(n_ev)").outcome == "consistent"
    assert judge(valence, samples, "O(1)").outcome == "violated"


def test_a_fifth_of_samples_delayed_changes_no_verdict() -> None:
    rng = np.random.default_rng(4)
    sizes = np.geomspace(100, 1e5, 7)
    for name, growth in GROWTH.items():
        samples = [c * rng.lognormal(0, 0.03, 20) for c in growth(sizes)]
        for cost in samples:
            cost[rng.choice(20, 4, replace=False)] *= rng.uniform(2, 20, 4)
        assert judge(sizes, samples, name).outcome == "consistent"


def test_an_upper_bound_is_kept_by_slower_growth_and_by_no_faster() -> None:
    rng = np.random.default_rng(5)
    sizes = np.geomspace(100, 1e6, 8)
    samples = [c * s for c, s in zip(np.sqrt(sizes), flat(rng, sizes), strict=True)]
    names = list(GROWTH)
    for claim in names:
        outcome = judge(sizes, samples, claim, bound="upper", exact=True).outcome
        slower = names.index(claim) < names.index("O(√n)")
        assert outcome == ("violated" if slower else "consistent"), claim
    assert judge(sizes, samples, "O(n)", exact=True).outcome == "violated"


def test_too_little_data_is_undetermined_and_says_why() -> None:
    rng = np.random.default_rng(6)

    def reason(sizes: list[float], noise: float = 0.02) -> str:
        n = np.array(sizes, dtype=float)
        verdict = judge(n, flat(rng, n, noise))
        assert verdict.outcome == "undetermined"
        return verdict.reason

    assert "Too few sizes: 1" in reason([100])
    assert "Too few sizes: 3" in reason([100, 1000, 1000, 10000])
    assert "Too short a range" in reason([100, 150, 200, 250, 300])
    assert "Too noisy" in reason([100, 1000, 10000, 100000, 1000000], noise=0.8)


def test_one_size_drowned_in_noise_spoils_no_curve_but_several_do() -> None:
    rng = np.random.default_rng(8)
    sizes = np.geomspace(100, 1e5, 8)
    latency = np.geomspace(1, 4, 8)
    samples = [n * s for n, s in zip(sizes, flat(rng, sizes), strict=True)]
    for spoiled in range(8):
        noisy = [c * rng.lognormal(0, 1.5 * (i == spoiled), 15) for i, c in enumerate(samples)]
        for given in (None, latency):
            back = None if given is None else given[::-1]
            assert judge(sizes, noisy, "O(n)", given).outcome == "consistent"
            assert judge(sizes[::-1], noisy[::-1], "O(n)", back).outcome == "consistent"
    noisy = [c * rng.lognormal(0, 1.5 * (i < 3), 15) for i, c in enumerate(samples)]
    assert "Too noisy" in judge(sizes, noisy, "O(n)").reason


def wobbling(seed: int, costs: Array, wobble: float) -> list[Array]:
    """Samples that hardly scatter, of costs that stray from size to size."""
    rng = np.random.default_rng(seed)
    strayed = costs * rng.lognormal(0, wobble, len(costs))
    return [cost * rng.lognormal(0, 0.01, 12) for cost in strayed]


def test_a_class_stands_out_although_every_size_strays_a_little() -> None:
    sizes = np.geomspace(100, 25_600, 9)
    said = Counter[tuple[str, str]]()
    for seed in range(30):
        for claim in ("O(1)", "O(n)", "O(n²)"):
            said[claim, judge(sizes, wobbling(seed, sizes**2, 0.06), claim).outcome] += 1
    assert said["O(1)", "violated"] == said["O(n)", "violated"] == 30
    assert said["O(n²)", "consistent"] >= 27
    assert said["O(n²)", "violated"] == 0


def test_what_no_slowdown_excuses_is_violated_though_no_class_explains_it() -> None:
    sizes = np.geomspace(4096, 4096 * 256, 9)
    bumpy = sizes**1.62 * np.exp(0.15 * np.sin(np.arange(9)))  # a string built by prepending
    samples = wobbling(0, bumpy, 0.0)
    assert judge(sizes, samples, "O(1)").outcome == "violated"
    assert judge(sizes, samples, "O(1)", np.geomspace(1, 30, 9)).outcome == "violated"
    assert judge(sizes, samples, "O(1)", np.geomspace(1, 9000, 9)).outcome != "violated"


@pytest.mark.parametrize("latency", [None, np.ones(9)], ids=["bare", "latency"])
@pytest.mark.parametrize("claim", ["O(1)", "O(n)", "O(n²)"])
def test_one_risen_size_is_no_class(claim: str, latency: Array | None) -> None:
    sizes = 4.0 ** np.arange(1, 10)
    samples = wobbling(1, np.array([30.0] * 8 + [75.0]), 0.0)
    verdict = judge(sizes, samples, claim, latency)
    assert verdict.raw_slope < 0.2
    assert verdict.outcome == "undetermined"


@pytest.mark.parametrize(
    ("name", "sizes"),
    [
        ("O(n³)", np.geomspace(10, 200, 8)),
        ("O(n² log n)", np.geomspace(50, 3000, 9)),
        ("O(2^n)", np.arange(4.0, 22, 2)),
        ("O(n^1.5)", np.geomspace(50, 3000, 9)),
    ],
)
def test_further_classes_are_told_from_their_neighbors(name: str, sizes: Array) -> None:
    grown = {"O(n³)": sizes**3, "O(n² log n)": sizes**2 * np.log(sizes), "O(n^1.5)": sizes**1.5}
    grown["O(2^n)"] = 2.0 ** np.minimum(sizes, 99)
    samples = wobbling(2, grown[name], 0.0)
    assert judge(sizes, samples, name).outcome == "consistent"
    assert judge(sizes, samples, name).answer == judge(sizes, samples, "O(n)").answer == name
    for other in ("O(1)", "O(log n)"):
        assert judge(sizes, samples, other).outcome == "violated"


def test_two_classes_are_named_where_nothing_tells_them_apart() -> None:
    rng = np.random.default_rng(3)
    sizes = np.geomspace(1e6, 8e6, 5)
    samples = [n * rng.lognormal(0, 0.1, 5) for n in sizes]
    assert judge(sizes, samples, "O(1)", np.geomspace(1, 2, 5)).answer == "O(n) or O(n log n)"


def power_law(seed: int, exponent: float) -> Verdict:
    rng = np.random.default_rng(seed)
    sizes = np.geomspace(100, 1e6, 7)
    samples = [n**exponent * rng.lognormal(0, 0.08, 10) for n in sizes]
    return judge(sizes, samples, "O(n)", seed=seed)


@pytest.mark.parametrize("exponent", [0.0, 0.5, 1.0, 2.0])
def test_the_slope_interval_holds_the_exponent_as_often_as_it_says(exponent: float) -> None:
    verdicts = [power_law(seed, exponent) for seed in range(100)]
    held = sum(v.slope_low <= exponent <= v.slope_high for v in verdicts)
    assert held >= 88
    assert np.mean([v.slope_high - v.slope_low for v in verdicts]) < 0.05


@pytest.mark.parametrize("count", [6, 9])
def test_it_does_so_where_few_sizes_have_one_noisy_sample_each(count: int) -> None:
    rng = np.random.default_rng(4)
    sizes, held = np.geomspace(100, 1e5, count), 0
    for seed in range(200):
        told = judge(sizes, [[n * rng.lognormal(0, 0.05)] for n in sizes], "O(n)", seed=seed)
        held += told.slope_low <= 1 <= told.slope_high
    assert held >= 184


def test_a_reason_does_not_deny_a_class_that_is_named() -> None:
    sizes = [10, 20, 40, 80, 160]
    verdict = judge(sizes, [[float(n)] for n in sizes], "O(n)")
    assert (verdict.outcome, verdict.answer) == ("consistent", "O(n) or O(n log n)")
    assert verdict.reason == "O(n) explains the costs best, and O(n log n) is not ruled out."


def test_a_reason_denies_no_class_where_several_are_open() -> None:
    sizes = [1_000, 4_000, 16_000, 64_000]
    verdict = judge(sizes, [[0.99 * n, n, 1.01 * n] for n in sizes], "O(n)")
    assert (verdict.outcome, verdict.answer) == ("consistent", "")
    worse = "O(√n) and O(n log n) are not ruled out."
    assert verdict.reason == f"O(n) explains the costs best, and {worse}"


def test_an_exponential_bound_is_kept_by_linear_costs_at_any_size() -> None:
    sizes = [10, 100, 1000, 10_000, 100_000]  # 2^n of the smaller ones is no number beside that
    samples = [[n * 1e-6] for n in sizes]
    assert judge(sizes, samples, "O(2^n)", bound="upper").outcome == "consistent"
    assert judge(sizes, samples, "O(2^n)").outcome == "violated"


def test_a_step_between_sizes_is_no_growth() -> None:
    sizes = np.geomspace(4, 900, 20).round()
    each = 26e-9 + 84e-9 / (1 + (80 / sizes) ** 4)  # of a level of recursion, as measured
    samples = [[n * it * k for k in (0.99, 1, 1.01)] for n, it in zip(sizes, each, strict=True)]
    assert judge(sizes, samples, "O(n)", np.ones(20)).outcome == "undetermined"
    assert judge(sizes, samples, "O(log n)", np.ones(20)).outcome == "violated"


@pytest.mark.parametrize("bound", ["tight", "upper"])
def test_counts_less_a_term_do_not_violate_their_class(bound: Any) -> None:
    sizes = range(4, 21)
    comparisons = [[n - 1] for n in sizes]
    verdict = judge(sizes, comparisons, "O(n)", exact=True, bound=bound)
    assert (verdict.outcome, verdict.answer) == ("undetermined", "O(n) or O(n log n)")
    for claim in ("O(1)", "O(√n)"):
        assert judge(sizes, comparisons, claim, exact=True, bound=bound).outcome == "violated"


def test_an_interval_holds_its_own_slope() -> None:
    sizes = [100, 316, 1_000, 3_160, 10_000]
    falling = [[57.0], [54.0], [51.0], [48.0], [45.0]]  # O(1) comes closest
    found = judge(sizes, falling, exact=True)
    assert found.slope < -0.04
    assert found.slope_low <= found.slope <= found.slope_high


def test_verdicts_repeat_and_know_neither_unit_nor_order() -> None:
    rng = np.random.default_rng(7)
    c = make_curve(rng, "O(√n)", "latency known", 1.0, 0.05)
    assert c.latency is not None
    first = judge(c.sizes, c.samples, "O(√n)", c.latency)
    assert judge(c.sizes, c.samples, "O(√n)", c.latency) == first
    for unit in (1e-30, 1e30):  # squares of a unit as large end no sum
        n = [2**k for k in range(4, 21, 2)]
        counts = judge(n, [[unit * x**3] for x in n], "O(n³)", exact=True)
        assert (counts.outcome, counts.answer) == ("consistent", "O(n³)")
    back = slice(None, None, -1)
    scaled = [1e9 * s for s in c.samples[back]]
    again = judge(c.sizes[back], scaled, "O(sqrt(n))", 7 * c.latency[back])
    assert (again.outcome, again.best) == (first.outcome, first.best)
    assert again.slope == pytest.approx(first.slope)


def test_a_verdict_is_shown_in_a_line() -> None:
    sizes = [10, 100, 1000, 10_000]
    verdict = judge(sizes, [[n * k for k in (2.9, 3, 3.1)] for n in sizes], "O(n)")
    assert repr(verdict) == (
        f"<Verdict on O(n): consistent, slope 1.00 ({verdict.slope_low:.2f} … "
        f"{verdict.slope_high:.2f}). The costs tell O(n). "
        "O(n) explains the costs, and no other class does.>"
    )


def test_a_verdict_survives_json() -> None:
    verdict = judge([4, 8, 16, 32, 64], [[3, 3.1], [3], [3], [3.1], [3]])
    assert Verdict(**json.loads(json.dumps(asdict(verdict)))) == verdict


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"sizes": [[1, 2], [3, 4]]}, "sizes"),
        ({"sizes": [0, 1, 2, 3]}, "sizes"),
        ({"samples": [[1], [1]]}, "4 sizes, 2 arrays"),
        ({"samples": [[1], [1], [], [1]]}, "size 3"),
        ({"samples": [[1], [1], [1], [0]]}, "size 4"),
        ({"latency": [1, 2, 3]}, "latency"),
        ({"latency": [1, 2, 3, -4]}, "latency"),
        ({"latency": [1, 2, 3, 4], "exact": True}, "either latency or exact"),
        ({"expected": "O(n!)"}, "unknown growth class"),
        ({"expected": "O(n·m)"}, "say which"),
        ({"expected": "N/A"}, "unknown growth class"),
        ({"bound": "loose"}, "bound"),
        ({"resamples": 0}, "resamples must be at least 1"),
        ({"lower": [float("nan")]}, "lower must be numbers"),
        ({"lower": [float("inf")]}, "lower must be numbers"),
        ({"lower": [0, -1]}, "lower must be numbers above minus the smallest size"),
        *(({"confidence": it}, "confidence must be between") for it in (-0.5, 95, float("nan"))),
        *(({"latency_error": it}, "from 0 on") for it in (-0.1, float("inf"), float("nan"))),
        *(({"unseen": it}, "from 0 on") for it in (-1, float("inf"), float("nan"))),
        ({"latency": [1, 1, 1, 2.0**512]}, "no cost or latency may be over 1e[+]60 times"),
        ({"samples": [[1], [1], [1], [2.0**512]]}, "no cost or latency may be over 1e[+]60"),
    ],
)
def test_malformed_input_is_named(change: dict[str, Any], message: str) -> None:
    good: dict[str, Any] = {"sizes": [1, 2, 3, 4], "samples": [[1], [1], [1], [1]]}
    with pytest.raises(ValueError, match=message):
        judge(**(good | change))


def slowed_reference(sizes: Array) -> Array:
    """What memory makes of constant work: level, then a step that no latency has the shape of."""
    return 9e-9 * (1 + 3 / (1 + (3e4 / sizes) ** 4) + 15 / (1 + (2e6 / sizes) ** 2))


@pytest.mark.parametrize("seed", range(5))
def test_costs_are_judged_in_proportion_to_a_reference_of_constant_work(seed: int) -> None:
    rng = np.random.default_rng(seed)
    sizes = np.geomspace(200, 2e6, 9).round()
    reference = slowed_reference(sizes)
    seen = reference * rng.normal(1, 0.05, 9)
    for name, growth in GROWTH.items():
        cost = reference * growth(sizes) * rng.normal(1, 0.05, 9)
        samples = [c * rng.normal(1, 0.02, 15) for c in cost]
        verdict = judge(sizes, samples, name, reference=seen, latency_error=0.1)
        assert (verdict.outcome, verdict.best) == ("consistent", name)
        for other in ("O(1)", "O(√n)", "O(n)"):
            outcome = judge(sizes, samples, other, reference=seen, latency_error=0.1).outcome
            assert (outcome == "consistent") == (other == name)
            assert (outcome == "violated") == (other != name), (other, name)


def test_a_reference_that_stays_level_excuses_nothing() -> None:
    sizes = np.geomspace(200, 2e6, 9)
    samples = [[cost] * 5 for cost in slowed_reference(sizes)]
    assert judge(sizes, samples, reference=np.full(9, 9e-9)).outcome != "consistent"
    with pytest.raises(ValueError, match="either latency or reference"):
        judge(sizes, samples, "O(1)", np.ones(9), reference=np.ones(9))


def test_a_bound_is_kept_by_what_grows_late_and_little_and_not_by_what_outgrows_it() -> None:
    sizes = 2.0 ** np.arange(2, 13)
    scan_and_walk = 37e-6 + 4e-9 * sizes  # the walk shows at the largest sizes alone
    for cost, outcome in ((scan_and_walk, "consistent"), (1e-9 * sizes**2, "violated")):
        samples = [c * np.linspace(0.99, 1.01, 9) for c in cost]
        verdict = judge(sizes, samples, "O(n)", np.ones(11), latency_error=0.15, bound="upper")
        assert verdict.outcome == outcome, verdict.reason


@pytest.mark.parametrize("place", range(9))
@pytest.mark.parametrize("factor", [0.01, 0.4, 2.5, 100])
def test_no_single_size_decides(place: int, factor: float) -> None:
    rng = np.random.default_rng(place)
    sizes = np.geomspace(200, 2e6, 9)
    for growth, claims in (("O(1)", ("O(log n)", "O(√n)", "O(n)")), ("O(n)", ("O(1)", "O(n²)"))):
        cost = 3e-8 * GROWTH[growth](sizes)
        cost[place] *= factor
        samples = [c * rng.normal(1, 0.01, 15) for c in cost]
        for told in ({"latency": np.ones(9)}, {"reference": np.ones(9)}):
            true = judge(sizes, samples, growth, **told)
            assert true.outcome != "violated", true.reason
            for claim in claims:
                assert judge(sizes, samples, claim, **told).outcome != "consistent"


@pytest.mark.parametrize(("place", "cost"), [(8, 120.0), (0, 10.0)])
def test_a_verdict_that_hinges_on_one_size_names_it(place: int, cost: float) -> None:
    sizes = np.geomspace(4, 1024, 9)
    samples = [[40.0 if i != place else cost] * 9 for i in range(9)]
    verdict = judge(sizes, samples, "O(1)", np.ones(9), latency_error=0.15)
    assert verdict.outcome == "undetermined"
    assert f"without {sizes[place]:,g}," in verdict.reason
    rest = [i for i in range(9) if i != place]
    calm = judge(sizes[rest], [samples[i] for i in rest], "O(1)", np.ones(8), latency_error=0.15)
    assert calm.outcome == "consistent"
