"""Laws of the comparison of two runs: silent about noise, and not about what is slower."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from experiments.regression.findings import Change
from experiments.regression.significance import Comparison, compare_rounds
from tests.extent import some, waiting_for

Array = NDArray[np.float64]
Noise = Callable[[np.random.Generator, int, float], Array]


def white(rng: np.random.Generator, n: int, sd: float) -> Array:
    return rng.normal(0, sd, n)


def autocorrelated(rng: np.random.Generator, n: int, sd: float) -> Array:
    off, r = rng.normal(0, sd, n), 0.7
    for i in range(1, n):
        off[i] = r * off[i - 1] + np.sqrt(1 - r * r) * off[i]
    return off


NOISES: dict[str, Noise] = {
    "white": white,
    "drifting": lambda rng, n, sd: white(rng, n, sd) + np.linspace(0, rng.normal(0, 0.06), n),
    "autocorrelated": autocorrelated,
    "heavy-tailed": lambda rng, n, sd: sd * rng.standard_t(2, n),
    "bimodal": lambda rng, n, sd: white(rng, n, sd) + 0.3 * (rng.random(n) < rng.uniform(0.1, 0.5)),
    "delayed": lambda rng, n, sd: (
        white(rng, n, sd) + (rng.random(n) < 0.1) * np.log(rng.uniform(1.5, 5, n))
    ),
    "own level": lambda rng, n, sd: white(rng, n, sd) + rng.normal(0, 0.03),
}
SOME_NOISES = waiting_for(["white", "drifting"], NOISES)


def two_runs(
    rng: np.random.Generator, noise: Noise, slower: float, rounds: int, sd: float
) -> Comparison:
    before = 3e-6 * np.exp(noise(rng, rounds, sd))
    after = 3e-6 * slower * np.exp(noise(rng, rounds, sd))
    loops = 3e-9 * np.exp(white(rng, 2 * rounds, sd)).reshape(2, rounds)
    return compare_rounds(before, after, *loops)


def changes(noise: str, slower: float, count: int, seed: int, fewest: int = 9) -> list[str]:
    rng = np.random.default_rng(seed)
    rounds = rng.integers(fewest, fewest + 7, count)
    noises = rng.uniform(0.03, 0.05, count)
    return [
        two_runs(rng, NOISES[noise], slower, int(n), sd).change
        for n, sd in zip(rounds, noises, strict=True)
    ]


@pytest.mark.parametrize("noise", SOME_NOISES)
def test_the_same_code_raises_at_most_one_alarm_in_a_thousand(noise: str) -> None:
    found = changes(noise, 1.0, some(1000), 1)
    assert found.count("worse") + found.count("better") <= 1


@pytest.mark.parametrize("noise", ["white", "own level", "drifting", "autocorrelated"])
def test_a_slow_down_by_three_tenths_is_found(noise: str) -> None:
    found = changes(noise, 1.3, some(400), 2)
    wanted = 0.95 if noise == "white" else 0.85
    assert found.count("worse") >= wanted * len(found)
    assert "better" not in found


@pytest.mark.parametrize("noise", SOME_NOISES)
def test_a_slow_down_twofold_is_found_under_every_noise(noise: str) -> None:
    found = changes(noise, 2.0, some(200), 3, fewest=20)
    assert found.count("worse") >= 0.9 * len(found)


def test_worse_and_better_are_mirror_images() -> None:
    rng = np.random.default_rng(4)
    old, new = np.exp(white(rng, 12, 0.03)), 1.4 * np.exp(white(rng, 12, 0.03))
    there, back = compare_rounds(old, new, [1.0], [1.0]), compare_rounds(new, old, [1.0], [1.0])
    assert (there.change, back.change) == ("worse", "better")
    assert there.ratio * back.ratio == pytest.approx(1)
    assert there.low * back.high == pytest.approx(1)


@pytest.mark.parametrize(("faster", "slower"), [(1.0, 1.5), (0.5, 0.75)])
def test_a_machine_that_changed_speed_leaves_it_open(faster: float, slower: float) -> None:
    """The case may have followed the loop, or not."""
    rng = np.random.default_rng(5)
    old, new, loop = (np.exp(white(rng, 15, 0.02)) for _ in range(3))
    speed = slower if faster == 1 else faster
    assert compare_rounds(old, slower * new, loop, speed * loop).change == "undetermined"
    assert compare_rounds(old, 1.5 * new, loop, loop).change == "worse"


def test_a_loop_that_changes_beside_a_case_that_does_not_is_no_alarm() -> None:
    rng = np.random.default_rng(9)
    for change in (0.1, 0.5, 2, 10):
        old, new, loop = (np.exp(white(rng, 15, 0.03)) for _ in range(3))
        assert compare_rounds(old, new, loop, change * loop).change == "undetermined"


def test_a_change_below_the_factor_is_none_however_sure() -> None:
    rng = np.random.default_rng(6)
    old, new = np.exp(white(rng, 50, 0.005)), 1.1 * np.exp(white(rng, 50, 0.005))
    assert compare_rounds(old, new, [1.0], [1.0]).change == "same"
    assert compare_rounds(old, new, [1.0], [1.0], factor=1.05).change == "worse"


def test_a_noisy_loop_makes_the_interval_wider() -> None:
    rng = np.random.default_rng(7)
    old, new = np.exp(white(rng, 15, 0.02)), np.exp(white(rng, 15, 0.02))
    quiet, noisy = np.ones(15), np.exp(white(rng, 15, 0.1))
    still = compare_rounds(old, new, quiet, quiet)
    loud = compare_rounds(old, new, noisy, noisy[::-1])
    assert np.log(loud.high / loud.low) > 2 * np.log(still.high / still.low)


def test_rounds_that_resemble_each_other_count_as_fewer() -> None:
    drifting = np.exp(np.linspace(-0.1, 0.1, 200))
    turned = np.stack([drifting[:100], drifting[:99:-1]], axis=1).ravel()  # low and high in turn
    mixed = np.random.default_rng(8).permutation(drifting)
    found = (compare_rounds(it, it, [1.0], [1.0]) for it in (turned, mixed, drifting))
    apart, by_chance, alike = (np.log(it.high / it.low) for it in found)
    assert by_chance == pytest.approx(apart)
    assert alike / apart == pytest.approx(np.sqrt(1.9 / 0.1))  # an autocorrelation of 0.9 at most


@pytest.mark.parametrize(("delayed", "change"), [(0, "worse"), (1, "undetermined")])
def test_a_slow_down_that_ranks_do_not_show_is_left_open(delayed: int, change: str) -> None:
    """Of 48,620 orders of the rounds 2 are as clear with none delayed, and 194 with one."""
    old = np.linspace(1, 1.01, 9)
    new = 2 * old
    old[:delayed] *= 10
    assert compare_rounds(old, new, [1.0], [1.0]).change == change


def test_too_few_rounds_are_undetermined() -> None:
    for rounds in range(9):
        times = np.linspace(1, 1.01, rounds)
        assert compare_rounds(times, 5 * times, [1.0], [1.0]).change == "undetermined"


def test_rounds_that_all_took_as_long_compare() -> None:
    assert compare_rounds([1.0] * 15, [1.0] * 15, [1.0], [1.0]).change == "same"
    assert compare_rounds([1.0] * 15, [2.0] * 15, [1.0], [1.0]).change == "worse"


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan"), float("inf")])
def test_malformed_times_are_named(bad: float) -> None:
    for place, name in enumerate(("before", "after", "loop_before", "loop_after")):
        times = [[1.0, 1.1, 1.2] for _ in range(4)]
        times[place][1] = bad
        with pytest.raises(ValueError, match=name):
            compare_rounds(*times)


def test_a_missing_loop_and_a_factor_of_one_are_refused() -> None:
    with pytest.raises(ValueError, match="calibration loop"):
        compare_rounds([1.0], [1.0], [], [1.0])
    with pytest.raises(ValueError, match="factor"):
        compare_rounds([1.0], [1.0], [1.0], [1.0], factor=1.0)


def test_rounds_that_tie_within_a_run_are_told_apart_as_well() -> None:
    old = np.array([1.230, 1.231, 1.231, 1.232, 1.233, 1.234, 1.235, 1.236, 1.237]) * 1e-8
    assert compare_rounds(old, 5 * old, [1.0], [1.0]).change == Change.WORSE
