"""Growth classes as people write them: "O(n log n)", "n lg n", "O(N*log(N))", "linearithmic".

A class is n^power · (log n)^logs · e^(base · n), an `Order`; of two orders the larger one grows
faster. Constant factors do not matter, and of a sum the term that grows fastest does.
"""

import re
from collections.abc import Iterator
from functools import lru_cache
from math import e, exp, isfinite, log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LARGE = 500  # logarithm of the largest value of what outgrows all numbers


class Order(NamedTuple):
    """Exponents of a growth class, the most telling first; those of a product are their sums."""

    base: float = 0.0  # natural logarithm of b in b^n
    power: float = 0.0
    logs: float = 0.0

    def times(self, other: "Order") -> "Order":
        """The order of a product."""
        return Order(*(a + b for a, b in zip(self, other, strict=True)))

    def to_the(self, exponent: float) -> "Order":
        """The order of a power."""
        return Order(*(a * exponent for a in self))

    @property
    def name(self) -> str:
        """As it is printed: "O(n² log n)"."""
        base = f"{exp(self.base):g}^n" if self.base else ""
        plain: dict[float, str] = {0: "", 0.5: "√n", 1: "n", 2: "n²", 3: "n³"}
        power = plain.get(self.power, f"n^{self.power:g}")
        logs = f"log^{self.logs:g} n".replace("^1 ", " ") if self.logs else ""
        return f"O({' '.join(filter(None, (base, power, logs))) or '1'})"

    def __call__(self, n: Array) -> Array:
        """The growth function; one that outgrows all numbers is scaled to end at the largest."""
        with np.errstate(over="ignore", divide="ignore"):
            log = np.log(n)
            grown = n**self.power * (log**self.logs if self.logs else 1.0) * np.exp(self.base * n)
            if np.isfinite(grown).all():
                return grown
            large = self.base * n + self.power * log + (self.logs * np.log(log) if self.logs else 0)
        return np.exp(large - np.max(large) + LARGE)


WORDS = {
    "constant": "1", "logarithmic": "log n", "linear": "n", "linearithmic": "n log n",
    "loglinear": "n log n", "quasilinear": "n log n", "quadratic": "n^2", "cubic": "n^3",
    "exponential": "2^n",
}  # fmt: skip
SPELLED = (
    (r"\$|\\left|\\right", ""), (r"\\mathcal\s*{o}", "o"), (r"\\cdot|\\times", " "),  # of LaTeX
    ("{", "("), ("}", ")"),
    (r"\b(amortized|amortised|expected|average|time)\b|\b[oθ](?=\s*\()|\btheta(?=\s*\()", ""),
    (r"\*\*", "^"), (r"²", "^(2)"), (r"³", "^(3)"), (r"ⁿ", "^n"), (r"√", "sqrt "),
    (r"[\\·⋅×*|]", " "),
    (r"\^\s*\(\s*([a-z])\s*\)", r"^\1"), (r"\be(?=\s*\^\s*[a-z])", f"{e}"),
    (r"(?<=[a-z)])\s*/\s*\d+(\.\d+)?", ""),  # a factor
    (r"(?<=[a-z)])\s*-\s*\d+(\.\d+)?(?!\s*[\w.^(/])", ""),  # a term, not the factor of one
)  # fmt: skip
LOGS = r"(_\w+)|log_?(2|10|₂)(?!\d)|lg|ln|ld"  # or, told apart from them, what a name ends with
VARIABLE = re.compile(r"[a-z](_\w+)?", re.IGNORECASE)
TOKEN = re.compile(r"\s*(sqrt|log|[a-z](?:_\w+)?|\d+(?:\.\d+)?(?:/\d+)?|[()^+])")


@lru_cache(maxsize=256)
def parse(claim: str, variable: str | None = None) -> Order:
    """The order that a claim names, in one variable: the others are held fixed.

    variable: a letter, or one with more behind it such as n_ev; it may be left out where the claim
    names no more than one. Raises ValueError for what is no growth class, and where the variable is
    missing or no such name.
    """
    if variable is not None and not VARIABLE.fullmatch(variable):
        raise ValueError(f"a variable is a letter, or such as n_ev, not {variable!r}")
    text = re.sub(LOGS, lambda it: it[1] or "log", claim.strip().lower())
    if re.search(r"log\s*\^?\s*\*(?!\*)", text):  # the iterated logarithm, of union-find
        raise _unknown(claim)
    for pattern, plain in SPELLED:
        text = re.sub(pattern, plain, text)
    word = WORDS.get(text.strip(" ()"))
    text = word or text.strip()
    tokens = TOKEN.findall(text)
    short = re.sub("sqrt|log", "O", re.sub(r"_\w+", "_", text))  # √2n and 2^2n are two things each
    words = re.search(r"[a-z]{3}|[a-z]\d|O\s*\d|\d\^\d+[a-zO]", short)
    if not tokens or words or "".join(tokens) != re.sub(r"\s", "", text):
        raise _unknown(claim)
    found = sorted({it for it in tokens if it[0].isalpha() and it not in ("sqrt", "log")})
    if variable is None and len(found) > 1:
        names = ", ".join(found)
        raise ValueError(
            f"{claim!r} names {names}: say which of them is varied, as variable=…; to hem judge, "
            "which knows it by its parameter, by the parameter's name"
        )
    chosen = variable.lower() if variable and not word else next(iter(found), "n")
    try:
        reader = _Reader(iter([*tokens, ""]), chosen)
        order = reader.sum()
    except (ValueError, ZeroDivisionError):
        raise _unknown(claim) from None
    if reader.token or order.base < 0 or not all(map(isfinite, order)):
        raise _unknown(claim)
    return order


def _unknown(claim: str) -> ValueError:
    return ValueError(
        f"unknown growth class {claim!r}; known are products of powers, logarithms and exponentials"
        ", such as O(1), O(log n), O(√n), O(n), O(n log n), O(n^1.5), O(n²), O(n³), O(2^n)"
    )


class _Reader:
    """Reads tokens by recursive descent; ValueError where they are no growth class."""

    def __init__(self, tokens: Iterator[str], variable: str) -> None:
        self._tokens, self._variable = tokens, variable
        self.token = next(tokens)

    def _take(self, expected: str | None = None) -> str:
        taken = self.token
        if not taken or expected not in (None, taken):
            raise ValueError(taken)
        self.token = next(self._tokens)
        return taken

    def _took(self, expected: str) -> bool:
        """Whether the next token is this one, and is taken."""
        return self.token == expected and bool(self._take())

    def sum(self) -> Order:
        largest = self._product()
        while self._took("+"):
            largest = max(largest, self._product())
        return largest

    def _product(self) -> Order:
        product = self._power()
        while self.token and self.token not in "+)":
            product = product.times(self._power())
        return product

    def _power(self) -> Order:
        number = self.token if self.token[:1].isdigit() else ""
        atom = self._atom()
        if not self._took("^"):
            return atom
        if number and self._took(self._variable):
            return Order(base=log(float(number)))
        varies = not self.token[:1].isalpha() or self.token in ("sqrt", "log", self._variable)
        if varies or atom != Order():
            return atom.to_the(self._number())
        self._take()  # a variable that is held fixed
        return atom

    def _atom(self) -> Order:
        token = self._take()
        if token == "(":
            inside = self.sum()
            self._take(")")
            return inside
        if token == "sqrt":
            return self._atom().to_the(0.5)
        if token == "log":
            return self._log()
        if token == self._variable:
            return Order(power=1.0)
        if token.isalpha() or "_" in token or token[0].isdigit():
            return Order()
        raise ValueError(token)

    def _log(self) -> Order:
        exponent = self._number() if self._took("^") else 1.0
        number = self.token[:1].isdigit()
        inside = self._atom() if self.token == "(" else self._power()  # log(n)^2 is (log n)^2
        if inside.base:
            return Order(power=exponent)
        if number or (inside.logs and not inside.power):
            raise ValueError("log 2n may be log(2n) or log(2) n; log log n is no class")
        return Order(logs=exponent) if inside.power else Order()

    def _number(self) -> float:
        bracketed = self._took("(")
        over, slash, under = self._take().partition("/")
        if bracketed:
            self._take(")")
        elif slash:
            raise ValueError("n^1/2 may be √n or n/2")
        return float(over) / float(under or 1)


def canonical(claim: str, variable: str | None = None) -> str:
    """Name of the class that `parse` reads: "O(n_ev)" is "O(n)", "O(sqrt n)" is "O(√n)"."""
    return parse(claim, variable).name
