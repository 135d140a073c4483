"""The claims of certificates as identities of rational functions, without a probability: ``python exact.py FILE …``.

The checker's own code, with the field of rational functions in all that it draws in the place of the field of p elements. It needs
python-flint. Functions that aren't rational are declined.
"""

from __future__ import annotations

import importlib
import json
import sys
from fractions import Fraction
from pathlib import Path

import flint
from verify import field

RING = flint.fmpq_mpoly_ctx.get([f"v{i}" for i in range(60)], "degrevlex")


class Quotient:
    """A rational function, reduced."""

    __slots__ = ("above", "below")

    def __init__(self, above, below=None):
        if below is not None and not below.is_constant():
            common = above.gcd(below) if above else below
            above, below = above / common, below / common
        self.above, self.below = above, below or RING.constant(1)
        if self.below.is_constant():
            self.above, self.below = self.above * (1 / self.below.leading_coefficient()), RING.constant(1)

    def __add__(self, other):
        other = quotient(other)
        if self.below == other.below:
            return Quotient(self.above + other.above, self.below)
        return Quotient(self.above * other.below + other.above * self.below, self.below * other.below)

    def __neg__(self):
        return Quotient(-self.above, self.below)

    def __sub__(self, other):
        return self + -quotient(other)

    def __mul__(self, other):
        other = quotient(other)
        return Quotient(self.above * other.above, self.below * other.below)

    __radd__, __rmul__ = __add__, __mul__

    def __eq__(self, other):
        other = quotient(other)
        return self.above * other.below == other.above * self.below

    def __bool__(self):
        return bool(self.above)


def quotient(value):
    if isinstance(value, Quotient):
        return value
    fraction = Fraction(value)
    return Quotient(RING.constant(flint.fmpq(fraction.numerator, fraction.denominator)))


def reciprocal(value):
    value = quotient(value)
    if not value:
        raise field.Unlucky
    return Quotient(value.below, value.above)


def initial(dual, a, b=0):
    dual.a, dual.b = quotient(a), quotient(b)


def declined(functions, name, x):
    raise field.Declined(f"{name} isn't rational")


field.Dual.__init__, field.Functions.at, field.reciprocal = initial, declined, reciprocal
field.ZERO, field.ONE, field.HALF = field.number(0), field.number(1), field.number(Fraction(1, 2))
for room in ("text", "motion", "claims"):
    importlib.reload(importlib.import_module(f"verify.{room}"))
claims = sys.modules["verify.claims"]


class Step(claims.Step):
    """A step whose vectors and tensors are any at all."""

    def __init__(self, data):
        supply = iter(range(60))
        field.draw = lambda: Quotient(RING.gen(next(supply)))
        super().__init__(data)

    def point(self):
        g = self.elements(field.drawn(self.n))
        seen = self.seen(g)
        for at, one in enumerate(self.carried):
            if one.action not in ("relative", "configuration"):
                seen[at] = one.whole(field.drawn(one.rows * one.columns))
        y = field.drawn(self.n)
        return claims.Point(g, y, self.elements(y), seen)


def main():
    is_right = True
    for file in sys.argv[1:]:
        data = json.loads(Path(file).read_text(encoding="utf-8"))
        for one in data["claims"]:
            holds, _ = claims.decided(Step(data), claims.CLAIMS[one["name"]])
            is_right &= holds is not False
            print(f"{data['name']}: {one['name']}: {holds or 'WRONG'}", flush=True)
    return 0 if is_right else 1


if __name__ == "__main__":
    sys.exit(main())
