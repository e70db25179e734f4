"""Steps are found where they were put, and none in noise."""

import numpy as np
import pytest

from experiments.regression.change_points import ALARM, SHORTEST, Step, find_steps

SERIES = 500
NOISES = {
    "normal": lambda rng, n: rng.normal(0, 0.03, n),
    "laplace": lambda rng, n: rng.laplace(0, 0.03, n),
    "student": lambda rng, n: 0.03 * rng.standard_t(3, n),
}


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("runs", [8, 30])
def test_noise_alone_has_no_steps_but_in_one_series_of_a_hundred(noise, runs):
    rng = np.random.default_rng(5)
    alarms = sum(bool(find_steps(np.exp(NOISES[noise](rng, runs)))) for _ in range(SERIES))
    assert alarms <= 0.01 * SERIES


def test_few_values_of_normal_noise_have_no_more_false_steps_than_alarm_says():
    rng = np.random.default_rng(9)
    series = [rng.normal(0, 0.2, runs) for runs in (8, 9, 10, 12) for _ in range(2 * SERIES)]
    assert sum(bool(find_steps(np.exp(it))) for it in series) <= ALARM * len(series)


@pytest.mark.parametrize("before", [8, 12, 20, 30, 48])
def test_a_doubling_is_told_from_its_third_value_on_and_at_no_other_commit(before):
    rng = np.random.default_rng(8)
    for after in range(1, 5):
        for _ in range(30):
            values = np.repeat([1.0, 2.0], [before, after]) * rng.normal(1, 0.03, before + after)
            found = [[it.index for it in find_steps(way)] for way in (values, values[::-1])]
            told = after >= SHORTEST
            assert found == [[before] * told, [after] * told]


def test_a_tenth_more_or_less_in_noise_of_three_percent_is_found_to_within_a_commit():
    rng = np.random.default_rng(7)
    found = alone = 0
    for _ in range(SERIES):
        start = int(rng.integers(10, 31))
        values = 4e-8 * rng.normal(1, 0.03, 40)
        values[start:] *= rng.choice([1.1, 1 / 1.1])
        told = find_steps(values)
        alone += len(told) == 1
        found += any(abs(step.index - start) <= 1 for step in told)
    assert found >= 0.95 * SERIES
    assert alone >= 0.95 * SERIES


def test_a_step_says_from_where_to_where():
    values = np.repeat([2.0, 3.0], 8) * np.tile([0.99, 1.01], 8)
    (step,) = find_steps(values)
    assert step.index == 8
    assert step.before == pytest.approx(2, rel=0.02)
    assert step.after == pytest.approx(3, rel=0.02)
    assert step.after / step.before == pytest.approx(1.5, rel=0.016)


def test_what_goes_up_and_comes_down_again_is_two_steps():
    rng = np.random.default_rng(3)
    values = np.repeat([1.0, 1.3, 1.0], 8) * rng.normal(1, 0.02, 24)
    assert [step.index for step in find_steps(values)] == [8, 16]


def test_the_unit_does_not_matter_and_time_backwards_mirrors_the_steps():
    rng = np.random.default_rng(4)
    values = np.repeat([1.0, 1.4, 1.1], 9) * rng.normal(1, 0.02, 27)
    found = [step.index for step in find_steps(values)]
    assert len(found) == 2
    assert [step.index for step in find_steps(1e-9 * values)] == found
    assert sorted(27 - step.index for step in find_steps(values[::-1])) == found


def test_one_slow_run_is_no_level():
    rng = np.random.default_rng(5)
    for at in range(12):
        values = rng.normal(1, 0.02, 12)
        values[at] *= 3
        assert find_steps(values) == []


def test_a_step_that_is_certain_but_small_is_not_told():
    rng = np.random.default_rng(6)
    values = np.repeat([1.0, 1.03], 20) * rng.normal(1, 1e-3, 40)
    assert find_steps(values) == []
    assert len(find_steps(np.repeat([1.0, 1.08], 20) * rng.normal(1, 1e-3, 40))) == 1


def test_every_other_exact_value_is_a_step():
    found = find_steps([19, 19, 20, 20, 20, 7], exact=True)
    assert [(it.index, it.before, it.after) for it in found] == [(2, 19, 20), (5, 20, 7)]
    assert find_steps([0, 0, 3], exact=True) == [Step(2, 0, 3)]
    assert find_steps([19.0], exact=True) == find_steps([], exact=True) == []


@pytest.mark.parametrize("count", range(2 * SHORTEST))
def test_few_noisy_values_have_no_steps(count):
    assert find_steps(np.arange(1, count + 1) ** 3.0) == []


def test_values_without_any_noise_are_told_apart_as_well():
    assert find_steps(np.ones(20)) == []
    assert [it.index for it in find_steps(np.repeat([1.0, 2.0], 10))] == [10]
