"""The claims of a certificate, each at a random point."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

from .field import (
    HALF, ONE, ZERO, Declined, Dual, Matrix, Unlucky, column, dot, drawn, functions, number, product, simplest, total,
)
from .motion import Carried, Factor, Term, drawn_field, stored_kind
from .text import long_decimals

Arrays = dict[str, list[Dual]]
DRAWS = 16
# A claim on two rotations takes four square roots at once, each of which half of the points have.
POINTS = 2000


def same(left: Sequence[Dual], right: Sequence[Dual]) -> bool:
    return [x.a for x in left] == [x.a for x in right]


class Program:
    """A list of operations."""

    def __init__(self, data: dict[str, Any], decimals: list[Fraction]) -> None:
        self.inputs, self.operations, self.outputs = data["inputs"], data["operations"], data["outputs"]
        self.literals = [simplest(literal, decimals) for literal in data["literals"]]

    def run(self, arrays: Arrays) -> list[Dual]:
        registers = [arrays[name][at] for name, at in self.inputs] + self.literals
        for name, *read in self.operations:
            a, b = registers[read[0]], registers[read[-1]]
            match name, len(read):
                case "+", 2:
                    registers.append(a + b)
                case "-", 2:
                    registers.append(a - b)
                case "*", 2:
                    registers.append(a * b)
                case "/", 2:
                    registers.append(a / b)
                case "-", 1:
                    registers.append(-a)
                case _:
                    registers.append(a.applied(name))
        return [registers[at] for at in self.outputs]


class Point(NamedTuple):
    """A point at which claims are evaluated: attitude, half the coordinates, increment, and what is carried along."""

    g: list[Matrix]
    y: list[Dual]
    f: list[Matrix]
    w: list[Matrix]


class System(NamedTuple):
    """A Newton system at a point: residual, Jacobian, update, determinants."""

    point: Point
    a: list[Dual]
    r: list[Dual]
    jacobian: Matrix
    update: list[Dual]
    pairs: list[Dual]


class Step:
    """A step by its certificate, with the numbers of its parameters drawn."""

    def __init__(self, data: dict[str, Any]) -> None:
        if data["format"] != "liestep certificate 1":
            raise Declined(f"the format {data['format']}")
        self.data, self.power, self.ends = data, data["power"], data["ends"]
        self.factors = [Factor(one) for one in data["factors"]]
        self.n = sum(len(factor.generators) for factor in self.factors)
        decimals = sorted({one for text in data["texts"] for one in long_decimals(text)})
        self.programs = {name: Program(one, decimals) for name, one in data["programs"].items()}
        self.carried = [Carried(**one) for one in data["advected"]]
        self.terms, at, field = [], 0, 0
        for text in data["texts"]:
            term = Term(text, self.factors, field, self.carried[at:])
            self.terms.append(term)
            at, field = at + len(term.names), field + len(term.declaration.fields)
        fields = [one for term in self.terms for one in term.declaration.fields]
        kinds = [(one["kind"], one["rows"], one["columns"]) for one in data["parameters"]]
        if [stored_kind(one) for one in fields] != kinds or at != len(self.carried):
            raise Declined("other parameters")
        numbers = [drawn_field(one) for one in fields]
        self.stored, self.values = [entries for entries, _ in numbers], [value for _, value in numbers]
        self.h = drawn(1)[0]

    def arrays(self, h: Dual, point: Point | None = None, **others: list[Dual]) -> Arrays:
        known: Arrays = {"h": [h], "parameters": sum(self.stored, [])}
        if point:
            known |= {"half": point.y, "advected": self.entries(point.w), "attitude": sum((g.flat for g in point.g), [])}
        return known | {"constants": self.programs["constants"].run(known)} | others

    def run(self, program: str, point: Point | None = None, **others: list[Dual]) -> list[Dual]:
        return self.programs[program].run(self.arrays(self.h, point, **others))

    def entries(self, w: Sequence[Matrix]) -> list[Dual]:
        return sum((one.stored(value) for one, value in zip(self.carried, w, strict=True)), [])

    def own(self, y: Sequence[Dual]) -> list[list[Dual]]:
        """The components of each factor."""
        found, rest = [], list(y)
        for factor in self.factors:
            found.append(rest[: len(factor.generators)])
            rest = rest[len(factor.generators) :]
        return found

    def elements(self, y: Sequence[Dual]) -> list[Matrix]:
        return [factor.element(own) for factor, own in zip(self.factors, self.own(y), strict=True)]

    def moved(self, w: Sequence[Matrix], f: Sequence[Matrix], inverse: Sequence[Matrix]) -> list[Matrix]:
        return [one.moved(value, f, inverse) for one, value in zip(self.carried, w, strict=True)]

    def seen(self, g: Sequence[Matrix]) -> list[Matrix]:
        space = []
        for one in self.carried:
            entries = Matrix.one(one.rows).flat if one.field is None else self.stored[one.field]
            space.append(one.whole(entries))
        return self.moved(space, g, [one.inverse for one in g])

    @cached_property
    def here(self) -> Point:
        """The point of most claims."""
        return self.point()

    @cached_property
    def system(self) -> System:
        """The Newton system there, with some target."""
        a, n = drawn(self.n), self.n
        found = self.newton(self.here.y, a, self.here)
        rest = found[n + n * n :]
        return System(self.here, a, found[:n], Matrix.of(found[n : n + n * n], n), rest[:n], rest[n:])

    def point(self) -> Point:
        g = self.elements(drawn(self.n))
        w = self.seen(g)
        for at, one in enumerate(self.carried):
            if one.action == "given":
                w[at] = one.whole(drawn(one.rows * one.columns))
        return Point(g, *self.increment(w), w)

    def increment(self, w: Sequence[Matrix]) -> tuple[list[Dual], list[Matrix]]:
        """Half the coordinates of an increment at which the texts have a value: several draws, one for each radicand."""
        for _ in range(DRAWS):
            y = drawn(self.n)
            try:
                f = self.elements(y)
                self.declared(f, w)
                self.work(f, w, ([ZERO] * self.n, [ZERO] * self.n))
            except Unlucky:
                continue
            return y, f
        raise Unlucky

    def each(self, w: Sequence[Matrix]) -> list[tuple[Term, list[Any], list[Matrix]]]:
        """The terms, with their fields and what they see."""
        found, carried, field = [], 0, 0
        for term in self.terms:
            ends = carried + len(term.names), field + len(term.declaration.fields)
            found.append((term, self.values[field : ends[1]], list(w[carried : ends[0]])))
            carried, field = ends
        return found

    def declared(self, f: Sequence[Matrix], w: Sequence[Matrix]) -> Dual:
        """The sum of the declared Lagrangians."""
        texts = ((term, fields, own) for term, fields, own in self.each(w) if "work" not in term.declaration.expressions)
        return total(term.lagrangian(fields, self.h, f, own) for term, fields, own in texts)

    def work(self, f: Sequence[Matrix], w: Sequence[Matrix], eta: Sequence[Sequence[Dual]]) -> Dual:
        texts = ((term, fields, own) for term, fields, own in self.each(w) if "work" in term.declaration.expressions)
        return total(term.work(term.scope(fields, self.h, f, own), eta) for term, fields, own in texts)

    def momenta(self, point: Point) -> tuple[list[Dual], list[Dual]]:
        """The momenta of the declared texts before and after an increment, (2.7) and (2.6)."""
        f, w, none = point.f, point.w, [ZERO] * self.n
        before, after = [], []
        for k in range(self.n):
            unit = [Dual(int(j == k)) for j in range(self.n)]
            along = [[x * Dual(0, 1) for x in own] for own in self.own(unit)]
            small = [factor.hat(own) for factor, own in zip(self.factors, along, strict=True)]
            forth, back = ([Matrix.one(len(e.rows)) + e * number(sign) for e in small] for sign in (1, -1))
            turned = self.declared([e * one for e, one in zip(forth, f, strict=True)], self.moved(w, back, forth))
            before.append(Dual(turned.b) - self.work(f, w, (unit, none)))
            beyond = self.declared([one * e for e, one in zip(forth, f, strict=True)], w)
            after.append(Dual(beyond.b) + self.work(f, w, (none, unit)))
        return before, after

    def kick(self, point: Point) -> list[Dual]:
        target = self.run("target", point, momentum=[ZERO] * self.n)
        return target[: self.n]

    def newton(self, y: list[Dual], a: list[Dual], point: Point) -> list[Dual]:
        return self.run("newton", point._replace(y=y), target=a)

    def determinants(self, jacobian: Matrix) -> list[list[Dual]]:
        """For each block the leading minor at its end, and its part of the diagonal."""
        found, first = [], 0
        for end in self.ends:
            minor = Matrix(row[:end] for row in jacobian.rows[:end]).det
            diagonal = product(jacobian.rows[i][i] for i in range(first, end)) if len(self.factors) > 1 else ONE
            found.append([minor, diagonal])
            first = end
        return found

    def are_determinants(self, pairs: Sequence[Dual], jacobian: Matrix) -> bool:
        minors = [product(pairs[0 : 2 * k + 2 : 2]) for k in range(len(self.ends))]
        expected = self.determinants(jacobian)
        has_all = len(pairs) == 2 * len(self.ends)
        return has_all and same(minors, [a for a, _ in expected]) and same(pairs[1::2], [b for _, b in expected])


# Each claim is a function of a step; a claim that holds for some points only is none.


def work(step: Step) -> bool:
    point, n = step.here, step.n
    eta = drawn(n), drawn(n)
    units, none = Matrix.one(n).rows, [ZERO] * n
    before = [step.work(point.f, point.w, (unit, none)) for unit in units]
    after = [step.work(point.f, point.w, (none, unit)) for unit in units]
    return same([step.work(point.f, point.w, eta)], [dot(eta[0], before) + dot(eta[1], after)])


def target(step: Step) -> bool:
    point, momentum = step.here, drawn(step.n)
    found = step.run("target", point, momentum=momentum)
    a = found[: step.n]
    return same([x - m for x, m in zip(a, momentum, strict=True)], step.kick(point)) and same(found[step.n :], [dot(a, a)])


def residual(step: Step) -> bool:
    scales = []
    for point in (step.here, step.point()):
        a = drawn(step.n)
        before, _ = step.momenta(point)
        weight = product([ONE + dot(point.y, point.y)] * step.power)
        found = step.newton(point.y, a, point)[: step.n]
        missed = [m + k - x for m, k, x in zip(before, step.kick(point), a, strict=True)]
        scales.append([r / (weight * x) for r, x in zip(found, missed, strict=True)])
    return same(*scales) and all(scale.a for scale in scales[0])


def jacobian(step: Step) -> bool:
    at = step.system
    columns = []
    for j in range(step.n):
        along = [Dual(y.a, int(i == j)) for i, y in enumerate(at.point.y)]
        columns.append([Dual(r.b) for r in step.newton(along, at.a, at.point)[: step.n]])
    return same(Matrix(columns).turned.flat, at.jacobian.flat)


def update(step: Step) -> bool:
    at = step.system
    return same((at.jacobian * column(at.update)).flat, at.r)


def determinants(step: Step) -> bool:
    at = step.system
    return step.are_determinants(at.pairs, at.jacobian)


def iterate(step: Step) -> bool:
    at, n = step.system, step.n
    found = step.run("iterate", at.point, target=at.a)
    following = [y - u for y, u in zip(at.point.y, at.update, strict=True)]
    squares = [dot(at.update, at.update), dot(following, following)]
    return same(found[: n + 2 + len(at.pairs)], [*following, *squares, *at.pairs])


def again(step: Step) -> bool:
    at, n = step.system, step.n
    y, _ = step.increment(at.point.w)
    factors = step.run("iterate", at.point, target=at.a)[n + 2 :]
    found = step.run("again", at.point._replace(y=y), target=at.a, factors=factors)
    moved = [a - b for a, b in zip(y, found[:n], strict=True)]
    r = step.newton(y, at.a, at.point)[:n]
    return same((at.jacobian * column(moved)).flat, r) and same(found[n:], [dot(moved, moved), dot(found[:n], found[:n])])


class End(NamedTuple):
    """The end of a step, whatever the momentum, and its parts."""

    point: Point
    history: list[Dual]
    attitude: list[Dual]
    momentum: list[Dual]
    advected: list[Dual]
    guess: list[Dual]
    checks: list[Dual]


def end(step: Step, point: Point, momentum: list[Dual]) -> End:
    n, history = step.n, drawn(2 * step.n)
    a = [m + k for m, k in zip(momentum, step.kick(point), strict=True)]
    found = step.run("finish", point, target=a, momentum=momentum, history=history)
    sizes = [sum(factor.rows**2 for factor in step.factors), n, len(step.entries(point.w)), 3 * n, len(found)]
    cut = []
    for size in sizes:
        cut.append(found[:size])
        found = found[size:]
    return End(point, history, *cut)


def at_end(step: Step) -> End:
    return end(step, step.here, drawn(step.n))


def attitude(step: Step) -> bool:
    found = at_end(step)
    return same(found.attitude, sum(((g * f).flat for g, f in zip(found.point.g, found.point.f, strict=True)), []))


def momentum(step: Step) -> bool:
    point = step.here
    before, after = step.momenta(point)
    return same(end(step, point, before).momentum, after)


def transport(step: Step) -> bool:
    point, before, change = step.here, drawn(step.n), drawn(step.n)
    first, second = end(step, point, before), end(step, point, [m + x for m, x in zip(before, change, strict=True)])
    expected = []
    for factor, f, own in zip(step.factors, point.f, step.own(change), strict=True):
        expected += [dot(own, factor.components(f * e * f.inverse)) for e in factor.generators]
    return same([b - a for a, b in zip(first.momentum, second.momentum, strict=True)], expected)


def advected(step: Step) -> bool:
    found = at_end(step)
    moved = step.moved(found.point.w, found.point.f, [f.inverse for f in found.point.f])
    return same(found.advected, step.entries(moved))


def guess(step: Step) -> bool:
    found, n = at_end(step), step.n
    last, before = found.history[:n], found.history[n:]
    change = [y - x for y, x in zip(found.point.y, last, strict=True)]
    following = [y + d + d - x for y, d, x in zip(found.point.y, change, before, strict=True)]
    return same(found.guess, found.point.y + change + following)


def checks(step: Step) -> bool:
    found = at_end(step)
    each = zip(step.factors, step.own(found.point.y), strict=True)
    near = [factor.measure(y) for factor, y in each if not factor.is_translation]
    return same(found.checks, [total(found.momentum + found.advected), *near])


def seen(step: Step) -> bool:
    g = step.elements(drawn(step.n))
    return same(step.run("seen", attitude=sum((one.flat for one in g), [])), step.entries(step.seen(g)))


def orthogonality(g: Matrix) -> Matrix:
    return g.turned * g - Matrix.one(len(g.rows))


def norm(matrix: Matrix) -> Dual:
    return dot(matrix.flat, matrix.flat).applied("sqrt")


def restored(step: Step) -> bool:
    g = [Matrix.of(drawn(factor.rows**2), factor.rows) for factor in step.factors]
    expected: list[Dual] = []
    for factor, one in zip(step.factors, g, strict=True):
        if factor.is_skew:
            expected += [norm(orthogonality(one)), *(one - one * orthogonality(one) * HALF).flat]
    return same(step.run("restored", attitude=sum((one.flat for one in g), [])), expected)


def off(factor: Factor, is_positive: bool) -> tuple[Matrix, Dual]:
    """A matrix that isn't in the group, and how far it is: of rotations and translations; of others it is in, and that is zero.

    A square stands for what is positive, and so its negative for what is negative.
    """
    for _ in range(DRAWS):
        g, one = Matrix.of(drawn(factor.rows**2), factor.rows), Matrix.one(factor.rows)
        try:
            if factor.is_translation:
                shared = [not any(e.flat[at].a for e in factor.generators) for at in range(factor.rows**2)]
                return g, norm(Matrix([[x for x, is_shared in zip((g - one).flat, shared, strict=True) if is_shared]]))
            if factor.is_rotation:
                g = g if same([(g.det * g.det).applied("sqrt")], [g.det]) == is_positive else -g
                return g, norm(orthogonality(g)) + (ZERO if is_positive else ONE - g.det)
            return factor.element(drawn(len(factor.generators))), ZERO
        except Unlucky:
            continue
    raise Unlucky


def defect(step: Step) -> bool:
    inside = [(g, ZERO) for g in step.elements(drawn(step.n))]
    places = [inside, *([off(factor, is_positive) for factor in step.factors] for is_positive in (True, False))]
    found = [step.run("defect", attitude=sum((g.flat for g, _ in each), [])) for each in places]
    return same(sum(found, []), [total(far for _, far in each) for each in places])


def at_rest(step: Step, point: Point, h: Dual) -> Matrix:
    none = [ZERO] * step.n
    known = step.arrays(h, point._replace(y=none), target=none)
    return Matrix.of(step.programs["newton"].run(known)[step.n : step.n + step.n**2], step.n)


def rest(step: Step) -> bool:
    point = step.here
    found, still = step.run("rest", point), at_rest(step, point, step.h)
    return same(found[:1], [still.trace]) and step.are_determinants(found[1:], still)


def safe(step: Step) -> bool:
    """The limit by the polynomial in `h` through many points, whose degree is tested by one point more."""
    point, none, a = step.here, [ZERO] * step.n, drawn(step.n)
    nodes, found = drawn(14), []
    for h in nodes:
        r = [step.programs["newton"].run(step.arrays(h, point._replace(y=none), target=x))[: step.n] for x in (none, a)]
        scale = [(x - y) / z for x, y, z in zip(*r, a, strict=True)]
        rows = zip(at_rest(step, point, h).rows, scale, strict=True)
        found.append(Matrix([entry * h * HALF / s for entry in row] for row, s in rows))

    def limit(first: int, last: int) -> Matrix:
        places = range(first, last)
        weights = [product(nodes[k] / (nodes[k] - nodes[j]) for k in places if k != j) for j in places]
        return sum((found[j] * weight for j, weight in zip(places, weights, strict=True)), found[0] * ZERO)

    inertia = limit(0, 13)
    if not same(inertia.flat, limit(1, 14).flat):
        raise Declined("an inertia that isn't the value of a polynomial in h")
    return step.are_determinants(step.run("safe", point), inertia)


CLAIMS: dict[str, Callable[[Step], bool]] = {
    claim.__name__: claim
    for claim in (
        *(work, target, residual, jacobian, update, determinants, iterate, again, attitude, momentum, transport),
        *(advected, guess, checks, seen, restored, defect, rest, safe),
    )
}


def verified(data: dict[str, Any]) -> dict[str, bool | str]:
    """Each claim that a certificate makes: whether it holds, or the reason why it can't be decided here."""
    functions.drawn.clear()
    try:
        step = Step(data)
    except Declined as reason:
        return {one["name"]: str(reason) for one in data["claims"]}
    found = {}
    for name in (one["name"] for one in data["claims"]):
        found[name], step = decided(step, CLAIMS[name])
    return found


def decided(step: Step, claim: Callable[[Step], bool]) -> tuple[bool | str, Step]:
    """Whether a claim holds, and the step of which that was found."""
    for _ in range(POINTS):
        try:
            return claim(step), step
        except Unlucky:
            step = Step(step.data)
        except Declined as reason:
            return str(reason), step
    return f"no point was found in {POINTS} draws", step
