"""Laws of how growth classes are read."""

import numpy as np
import pytest

from hem.complexity import NAMES, canonical, parse

SPELLINGS = {
    "O(1)": ["amortized O(1)"],
    "O(n)": [
        "O(n_t)", "O(n_ev)", "o(N)", "O(|V|)", "linear", "O(3n + log n + 2)", "O(n/2)",
        "O(log(2^n))",
    ],
    "O(√n)": ["O(sqrt n)", "O(sqrt(n_t))", "O(n^(1/2))"],
    "O(n log n)": [
        "n log n", "nlogn", "O(n lg n)", "O(N*log(N))", "Θ(n · log₂ n)", "O(n_t log n_t)",
        "O(n·log(n))", "linearithmic", "n ⋅ log n", "loglinear", r"\mathcal{O}(n \cdot \log n)",
    ],
    "O(n²)": [
        "O(n^2)", "O(n_v**2)", "quadratic time", "n^{2}", "$O(n^2)$", "O(n²/2)", "O(n(n-1)/2)",
        "O(E^2)",
    ],
    "O(n^1.5)": ["O(n√n)"],
    "O(log^2 n)": ["O((log n)^2)", "O(log(n)^2)"],
    "O(log n)": ["O(log n^2)"],
    "O(2.71828^n)": ["O(e^n)"],
    "O(2^n)": ["exponential"],
    "O(1.5^n)": ["O(1.5^n)"],
}  # fmt: skip


@pytest.mark.parametrize(
    ("spelling", "name"),
    [
        *((name, name) for name in (*NAMES, "O(n³)", "O(n² log n)", "O(2^n)", "O(n^1.58)")),
        *((spelling, name) for name, some in SPELLINGS.items() for spelling in some),
    ],
)
def test_usual_spellings_name_a_class(spelling: str, name: str) -> None:
    assert canonical(spelling) == name


def test_of_several_variables_one_is_varied_and_the_others_are_held_fixed() -> None:
    assert canonical("O(n·m·log m)", "m") == "O(n log n)"
    assert canonical("O(n·m·log m)", "n") == "O(n)"
    assert canonical("O(n + k)", "k") == "O(n)"
    assert canonical("O(n)", "m") == "O(1)"
    assert canonical("O(n_ev·m)", "n_ev") == "O(n)"
    assert canonical("linear", "m") == "O(n)"
    assert canonical("O(2^k·n)", "n") == "O(n)"
    assert canonical("O(2^k·n)", "k") == "O(2^n)"
    for name in ("n_old", "n_Fields", "n_time", "n_lg2"):  # that hold what is a word of its own
        assert canonical(f"O({name}² log {name} · m)", name) == "O(n² log n)"
    for name in ("", "nv", "rows"):
        with pytest.raises(ValueError, match="a variable is a letter"):
            canonical("O(n·m)", name)
    for other in ("n", "n_old"):
        with pytest.raises(ValueError, match=f"names m, {other}: say which"):
            canonical(f"O({other}·m)")


@pytest.mark.parametrize(
    "claim",
    [
        "", "N/A", "O(n!)", "O(n", "O(n))", "log log n", "n^n", "fast",
        "O(log 2n)", "O(log^2 2n)", "O(n log 2 n)", "O(√2n)", "O(sqrt 2 n)", "O(2^2n)",
        "O(n2)", "O(3n2)", "log3(n)", "n^1/2", "n^2/2", "n - 2n", "n^-1", "2^{2n}",
        "O(log* n)", "O(lg* n)", "O(n log*n)", "O(n log^* n)", "O(0.5^n)", f"n^{10**400}",
    ],
)  # fmt: skip
def test_what_is_no_growth_class_is_refused(claim: str) -> None:
    with pytest.raises(ValueError, match=r"unknown growth class|say which"):
        canonical(claim)


def test_orders_are_sorted_as_their_functions_are_at_large_sizes() -> None:
    names = ["O(1)", "O(log n)", "O(√n)", "O(n)", "O(n log n)", "O(n^1.5)", "O(n²)", "O(n³)"]
    assert sorted({*names}, key=parse) == names
    last = [float(parse(name)(np.array([1e9]))[0]) for name in names]
    assert last == sorted(last)
    assert max(map(parse, names)) < parse("O(2^n)")


def test_exponentials_keep_their_shape_where_numbers_end() -> None:
    assert parse("O(2^n)")(np.array([3.0, 10.0])) == pytest.approx([8, 1024])
    large = parse("O(2^n)")(np.array([10.0, 9_999.0, 10_000.0]))
    assert np.isfinite(large).all()
    assert large[2] / large[1] == pytest.approx(2)
    one, other = parse("O(n^200 log^9 n)")(np.array([2e5, 3e5]))
    assert np.isfinite(other)
    assert other / one == pytest.approx(1.5**200 * (np.log(3e5) / np.log(2e5)) ** 9)
