"""Laws of the growth models and their fit."""

import numpy as np
import pytest

from hem.complexity import judge
from hem.complexity.models import NAMES, design, entire_slowdown, fit, measured_slowdowns, predict
from hem.complexity.notation import Array


@pytest.mark.parametrize("lower", [None, np.array([-90.0, 50.0])])
def test_fits_are_the_nonnegative_least_squares_of_scipy(lower: Array | None) -> None:
    from scipy.optimize import nnls

    rng = np.random.default_rng(0)
    sizes = np.geomspace(100, 1e5, 7)
    slowdowns = measured_slowdowns(np.geomspace(1, 30, 7), steps=4)
    models = design(sizes, slowdowns, 1.3, lower=lower)
    pure, mixed = models.columns()
    assert len(pure[0]) == len(slowdowns.scaling) * (1 if lower is None else 3)
    for _ in range(20):
        cost, error = rng.lognormal(0, 2, 7), rng.uniform(0.01, 0.1, 7)
        fitted = fit(models, cost, 1 / (cost * error))
        for m in range(len(NAMES)):
            pairs = zip(pure[m], mixed[m], strict=True)
            residuals = [
                nnls(np.stack(pair, 1) / (cost * error)[:, None], 1 / error)[1] for pair in pairs
            ]
            assert fitted.chi2[m] == pytest.approx(min(residuals) ** 2, rel=1e-6)


def test_a_lower_order_term_is_told_with_its_class() -> None:
    sizes, lower = np.geomspace(10, 1e4, 12), np.array([-8.0, 30.0, 300.0])
    cost = 4e-9 * sizes**2 * (1 + 300 / sizes)
    models = design(sizes, entire_slowdown(np.ones(12)), 1.3, lower=lower)
    fitted = fit(models, cost, 1 / cost)
    assert fitted.chi2.argmin() == NAMES.index("O(n²)")
    assert models.lower[fitted.lower[-1]] == 300
    assert fitted.factor[-1] == pytest.approx(4e-9)
    slowed, fast = predict(models, fitted)
    assert slowed[-1] == pytest.approx(cost) == fast[-1]
    found = judge(sizes, cost[:, None], "n^2", exact=True, lower=lower)
    assert found.predicted("O(n²)", sizes[::2]) == pytest.approx(cost[::2])
    for name in NAMES[:3]:  # of what grows less than n, nothing is below
        assert found.coefficients[name]["lower"] == 0


@pytest.mark.parametrize("lower", [None, np.array([-2.0, 500.0])])
def test_predictions_have_the_misfit_of_their_fit(lower: Array | None) -> None:
    rng = np.random.default_rng(1)
    sizes = np.geomspace(4, 4096, 6)
    slowdowns = measured_slowdowns(np.geomspace(1, 10, 6))
    cost, error = sizes * rng.lognormal(0, 0.2, 6), np.full(6, 0.05)
    models = design(sizes, slowdowns, 1.3, lower=lower)
    fitted = fit(models, cost, 1 / (cost * error))
    slowed, fast = predict(models, fitted)
    assert (((slowed / cost - 1) / error) ** 2).sum(1) == pytest.approx(fitted.chi2)
    assert np.all(fast <= slowed * (1 + 1e-12))


@pytest.mark.parametrize("growth", [1.3, 2.1])
def test_no_model_but_constant_time_hides_its_growth_in_the_intercept(growth: float) -> None:
    sizes = np.geomspace(100, 1e6, 7)
    models = design(sizes, entire_slowdown(np.ones(7)), growth)
    _, fast = predict(models, fit(models, np.ones(7), np.ones(7)))
    assert fast[0] == pytest.approx(np.ones(7))
    assert fast[1:, -1] / fast[1:, 0] == pytest.approx(np.full(5, growth), rel=1e-6)


def test_many_costs_are_fitted_as_each_alone() -> None:
    rng = np.random.default_rng(2)
    sizes = np.geomspace(4, 4096, 6)
    models = design(sizes, measured_slowdowns(np.geomspace(1, 10, 6)), 1.3).only(3)
    costs = sizes * rng.lognormal(0, 0.2, (5, 6))
    together = fit(models, costs, 1 / sizes)
    for i, cost in enumerate(costs):
        alone = fit(models, cost, 1 / sizes)
        assert predict(models, together)[0][i] == pytest.approx(predict(models, alone)[0])
