"""Polynomials with whole coefficients: terms by their variables, sorted, each as often as its power."""

from __future__ import annotations

import math
from collections import Counter
from functools import reduce

Monomial = tuple[int, ...]
Polynomial = dict[Monomial, int]


def times(a: Polynomial, b: Polynomial) -> Polynomial:
    found: Polynomial = {}
    for m, x in a.items():
        for k, y in b.items():
            key = tuple(sorted(m + k))
            found[key] = found.get(key, 0) + x * y
    return {m: x for m, x in found.items() if x}


def product(powers: list[tuple[Polynomial, int]]) -> Polynomial:
    return reduce(times, (one for one, k in powers for _ in range(k)), {(): 1})


def content(one: Polynomial) -> int:
    """The greatest common divisor of the coefficients."""
    return math.gcd(*one.values()) or 1


def stripped(one: Polynomial) -> tuple[set[int], Polynomial]:
    """The variables that divide a polynomial, and what remains without them."""
    common = reduce(lambda a, b: a & b, (Counter(m) for m in one)) if one else Counter()
    return set(common), {tuple(sorted((Counter(m) - common).elements())): x for m, x in one.items()}


def divided(one: Polynomial, other: Polynomial) -> Polynomial | None:
    """The quotient, where the other polynomial divides without a rest; it isn't a number."""
    if () in other and len(other) == 1:
        return None

    def leading(p: Polynomial) -> Monomial:
        return max(p, key=lambda m: (len(m), m))

    top, rest, found = leading(other), dict(one), {}
    while rest:
        m = leading(rest)
        lacking = Counter(top) - Counter(m)
        x, remainder = divmod(rest[m], other[top])
        if lacking or remainder:
            return None
        factor = tuple(sorted((Counter(m) - Counter(top)).elements()))
        found[factor] = x
        for k, y in other.items():
            key = tuple(sorted(k + factor))
            rest[key] = rest.get(key, 0) - x * y
            if not rest[key]:
                del rest[key]
    return found


def factored(value: int) -> list[int]:
    """The prime factors of a number, as far as they are small."""
    found, value, p = [], abs(value), 2
    while value > 1 and p < 100000:
        if p * p > value:
            return [*found, value]
        while value % p == 0:
            found.append(p)
            value //= p
        p += 1
    return found
