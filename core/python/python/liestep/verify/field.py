"""The field of p = 2**127 - 1 elements: numbers with a derivative, functions by their relations, and matrices."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

P = 2**127 - 1


class Declined(Exception):
    """A text or a program has something that no rule here is for."""


class Unlucky(Exception):
    """A drawn point can't be used: a radicand isn't a square, or a denominator is zero."""


class Dual:
    """A number of the field with a derivative, a + b ε."""

    __slots__ = ("a", "b")

    def __init__(self, a: Any, b: Any = 0) -> None:
        self.a, self.b = a % P, b % P

    def __add__(self, other: Any) -> Dual:
        return Dual(self.a + other.a, self.b + other.b)

    def __sub__(self, other: Any) -> Dual:
        return Dual(self.a - other.a, self.b - other.b)

    def __neg__(self) -> Dual:
        return Dual(-self.a, -self.b)

    def __mul__(self, other: Dual) -> Dual:
        if not isinstance(other, Dual):
            return NotImplemented
        return Dual(self.a * other.a, self.a * other.b + self.b * other.a)

    def __truediv__(self, other: Any) -> Dual:
        below = reciprocal(other.a)
        return Dual(self.a * below, (self.b - self.a * below * other.b) * below)

    def applied(self, function: str) -> Dual:
        value, slope = functions.at(function, self.a)
        return Dual(value, slope * self.b)


def reciprocal(a: Any) -> Any:
    try:
        return pow(a, -1, P)
    except ValueError:
        raise Unlucky from None


def number(value: Fraction | int | str) -> Dual:
    fraction = Fraction(value)
    return Dual(fraction.numerator * reciprocal(fraction.denominator))


def simplest(literal: float, decimals: Sequence[Fraction] = ()) -> Dual:
    """The simplest fraction that a literal is the nearest float to, or a multiple of a long decimal of the text."""
    for unit in (Fraction(1), *(decimal**k for decimal in decimals for k in range(1, 5))):
        exact = Fraction(literal) / unit
        for digits in range(7):
            found = exact.limit_denominator(10**digits) * unit
            if float(found) == literal:
                return number(found)
    raise Declined(f"the literal {literal!r} is no fraction of small numbers")


class Functions:
    """Functions that aren't rational, as unknowns at each argument with their differential relations."""

    def __init__(self) -> None:
        self.drawn: dict[tuple[str, Any], Any] = {}

    def unknown(self, family: str, argument: Any) -> Any:
        key = (family, argument)
        if key not in self.drawn:
            self.drawn[key] = draw()
        return self.drawn[key]

    def at(self, name: str, x: Any) -> tuple[Any, Any]:
        """The value at x, and the derivative."""
        family, _, order = name.rpartition("_")
        if family == "stumpff":
            return self.stumpff(int(order), x)
        if family == "log_ratio":
            slopes = self.log_ratio(int(order) + 1, x)
            return slopes[-2], slopes[-1]
        if name == "sqrt":
            root = pow(x, (P + 1) // 4, P)
            if (root * root - x) % P:
                raise Unlucky
            return root, reciprocal(2 * root % P) if x else 0
        if name == "ln":
            return self.unknown("ln", x), reciprocal(x)
        # exp(−x) = 1/exp(x), and likewise for sine and cosine: one of both signs has the unknown.
        is_kept = x <= P - x
        t = self.unknown("exp" if name == "exp" else "turn", x if is_kept else P - x)
        if name == "exp":
            value = t if is_kept else reciprocal(t)
            return value, value
        if name not in ("sin", "cos"):
            raise Declined(f"there is no rule for the function {name}")
        below = reciprocal((1 + t * t) % P)
        sine, cosine = 2 * t * below * (1 if is_kept else -1), (1 - t * t) * below
        return (sine, cosine) if name == "sin" else (cosine, -sine)

    def stumpff(self, order: int, q: Any) -> tuple[Any, Any]:
        inverse = [reciprocal(math.factorial(k)) for k in range(order + 3)]
        if q == 0:
            return inverse[order], -inverse[order + 2]
        t, over = self.unknown("stumpff", q), reciprocal(q)
        below = reciprocal((1 + q * t * t) % P)
        values = [(1 - q * t * t) * below, 2 * t * below]
        half = reciprocal(2)
        slopes = [-values[1] * half, (values[0] - values[1]) * half * over]
        for k in range(order - 1):
            values.append((inverse[k] - values[k]) * over % P)
            slopes.append((-slopes[k] - values[k + 2]) * over % P)
        return values[order], slopes[order]

    def log_ratio(self, order: int, n: Any) -> list[Any]:
        """The derivatives up to an order, by u G⁽ᵏ⁺¹⁾ + (2k + 1) s G⁽ᵏ⁾ = 2k² G⁽ᵏ⁻¹⁾, which begins with u G′ + s G = 1."""
        s, u = 1 - 2 * n, 2 * n * (1 - n)
        if n == 0:
            found = [1]
            for k in range(1, order + 1):
                found.append(2 * k * k * found[-1] * reciprocal(2 * k + 1) % P)
            return found
        found, over = [self.unknown("log_ratio", n)], reciprocal(u % P)
        for k in range(order):
            right = 2 * k * k * found[k - 1] if k else 1
            found.append((right - (2 * k + 1) * s * found[k]) * over % P)
        return found


functions = Functions()


def draw() -> Any:
    return random.randrange(1, P)


def drawn(count: int) -> list[Dual]:
    return [Dual(draw()) for _ in range(count)]


ZERO, ONE, HALF = number(0), number(1), number(Fraction(1, 2))


def total(numbers: Iterable[Dual]) -> Dual:
    return sum(numbers, ZERO)


def product(numbers: Iterable[Dual]) -> Dual:
    return math.prod(numbers, start=ONE)


def dot(left: Iterable[Dual], right: Iterable[Dual]) -> Dual:
    return total(a * b for a, b in zip(left, right, strict=True))


class Matrix:
    """A matrix or a column."""

    def __init__(self, rows: Iterable[Iterable[Dual]]) -> None:
        self.rows = [list(row) for row in rows]

    @staticmethod
    def of(entries: Sequence[Dual], columns: int) -> Matrix:
        return Matrix(entries[at : at + columns] for at in range(0, len(entries), columns))

    @staticmethod
    def one(size: int) -> Matrix:
        return Matrix([ONE if i == j else ZERO for j in range(size)] for i in range(size))

    @property
    def shape(self) -> tuple[int, int]:
        return len(self.rows), len(self.rows[0])

    @property
    def flat(self) -> list[Dual]:
        return [entry for row in self.rows for entry in row]

    def map(self, of: Callable[[Dual], Any]) -> Matrix:
        return Matrix([of(entry) for entry in row] for row in self.rows)

    def __add__(self, other: Matrix) -> Matrix:
        if self.shape != other.shape:
            raise Declined(f"a sum of {self.shape} and {other.shape}")
        return Matrix.of([a + b for a, b in zip(self.flat, other.flat, strict=True)], self.shape[1])

    def __sub__(self, other: Matrix) -> Matrix:
        return self + -other

    def __neg__(self) -> Matrix:
        return self.map(lambda entry: -entry)

    def __mul__(self, other: Any) -> Matrix:
        if isinstance(other, Dual):
            return self.map(lambda entry: entry * other)
        if not isinstance(other, Matrix):
            return NotImplemented
        return Matrix([dot(row, column) for column in zip(*other.rows, strict=True)] for row in self.rows)

    def __rmul__(self, other: Dual) -> Matrix:
        return self * other

    def __truediv__(self, other: Dual) -> Matrix:
        return self * (ONE / other)

    @property
    def turned(self) -> Matrix:
        return Matrix(zip(*self.rows, strict=True))

    @property
    def trace(self) -> Dual:
        return total(self.rows[i][i] for i in range(len(self.rows)))

    def solved(self, right: Matrix) -> Matrix:
        """X with A X = B, by elimination."""
        rows, n = [[*a, *b] for a, b in zip(self.rows, right.rows, strict=True)], len(self.rows)
        for k in range(n):
            pivot = next((i for i in range(k, n) if rows[i][k].a), None)
            if pivot is None:
                raise Unlucky
            rows[k], rows[pivot] = rows[pivot], rows[k]
            rows[k] = [entry / rows[k][k] for entry in rows[k]]
            for i in range(n):
                if i != k:
                    rows[i] = [entry - rows[i][k] * above for entry, above in zip(rows[i], rows[k], strict=True)]
        return Matrix(row[n:] for row in rows)

    @property
    def inverse(self) -> Matrix:
        return self.solved(Matrix.one(len(self.rows)))

    @property
    def det(self) -> Dual:
        """The determinant, by minors of the first rows in each set of columns."""
        n, minors = len(self.rows), {0: ONE}
        for chosen in range(1, 1 << n):
            row, here = self.rows[chosen.bit_count() - 1], [j for j in range(n) if chosen >> j & 1]
            terms = (row[j] * minors[chosen ^ 1 << j] for j in here)
            signs = ((chosen >> j).bit_count() % 2 for j in here)
            minors[chosen] = total(term if sign else -term for term, sign in zip(terms, signs, strict=True))
        return minors[(1 << n) - 1]


def column(entries: Iterable[Dual]) -> Matrix:
    return Matrix([entry] for entry in entries)


def cross_matrix(v: Matrix) -> Matrix:
    x, y, z = v.flat
    return Matrix([[ZERO, -z, y], [z, ZERO, -x], [-y, x, ZERO]])


def vee(a: Matrix) -> Matrix:
    m = (a - a.turned) * HALF
    return column([m.rows[2][1], m.rows[0][2], m.rows[1][0]])


def logarithm(rotation: Matrix) -> Matrix:
    n = (number(3) - rotation.trace) * number(Fraction(1, 4))
    return vee(rotation) * n.applied("log_ratio_0")


def turn(v: Matrix) -> Matrix:
    """The rotation by a vector."""
    q, hat = dot(v.flat, v.flat), cross_matrix(v)
    return Matrix.one(3) + hat * q.applied("stumpff_1") + hat * hat * q.applied("stumpff_2")
