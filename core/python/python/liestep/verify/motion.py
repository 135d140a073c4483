"""The declared motion: increments of the group, actions on what is carried along, and the values of the declared texts."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from .field import HALF, ONE, ZERO, Declined, Dual, Matrix, column, dot, drawn, logarithm, number
from .text import KINDS, Chord, Declaration, Field, valued


def sparse(size: int, generators: list[list[tuple[int, int, Fraction | int]]]) -> list[list[Fraction]]:
    def entries(e: list[tuple[int, int, Fraction | int]]) -> list[Fraction]:
        known = {(i, j): Fraction(value) for i, j, value in e}
        return [known.get((at // size, at % size), Fraction(0)) for at in range(size * size)]

    return [entries(e) for e in generators]


def skew(i: int, j: int, size: Fraction | int = 1) -> list[tuple[int, int, Fraction | int]]:
    return [(i, j, -size), (j, i, size)]


def shifts(rows: int, last: int) -> list[list[tuple[int, int, Fraction | int]]]:
    return [[(i, last, 1)] for i in range(rows)]


half, turns = Fraction(1, 2), [skew(1, 2), skew(2, 0), skew(0, 1)]
KNOWN = {
    "SO2": sparse(2, [skew(0, 1)]),
    "SE2": sparse(3, [skew(0, 1), *shifts(2, 2)]),
    "SO3": sparse(3, turns),
    "SE3": sparse(4, [*turns, *shifts(3, 3)]),
    "SE23": sparse(5, [*turns, *shifts(3, 3), *shifts(3, 4)]),
    "SU2": sparse(4, [skew(0, i, half) + skew(j, k, half) for i, j, k in ((1, 2, 3), (2, 3, 1), (3, 1, 2))]),
    "SL2": sparse(2, [[(0, 0, half), (1, 1, -half)], [(0, 1, half), (1, 0, half)], skew(0, 1, half)]),
    "Heisenberg": sparse(3, [[(0, 1, 1)], [(1, 2, 1)], [(0, 2, 1)]]),
    "R1": sparse(2, shifts(1, 1)),
    "R2": sparse(3, shifts(2, 2)),
    "R3": sparse(4, shifts(3, 3)),
}


class Factor:
    """A factor of the group, by its generators."""

    def __init__(self, data: dict[str, Any]) -> None:
        self.name, self.rows, self.chart = data["name"], data["rows"], data["chart"]
        self.generators = [Matrix.of([number(Fraction(entry)) for entry in e], self.rows) for e in data["generators"]]
        pairs = [[dot(a.flat, b.flat) for b in self.generators] for a in self.generators]
        self.dual = Matrix(pairs).inverse
        self.is_skew = all(is_zero(e + e.turned) for e in self.generators)
        self.is_translation = all(is_zero(a * b) for a in self.generators for b in self.generators)
        self.listed = [[Fraction(entry) for entry in e] for e in data["generators"]]
        self.is_rotation = self.listed == KNOWN["SO3"]

    def hat(self, x: Sequence[Dual]) -> Matrix:
        zero = Matrix.one(self.rows) * ZERO
        return sum((e * entry for e, entry in zip(self.generators, x, strict=True)), zero)

    def components(self, matrix: Matrix) -> list[Dual]:
        """The components of an element of the algebra."""
        return (self.dual * column(dot(e.flat, matrix.flat) for e in self.generators)).flat

    def element(self, y: Sequence[Dual]) -> Matrix:
        one = Matrix.one(self.rows)
        if self.chart == "product":
            found = one
            for e, entry in zip(self.generators, y, strict=True):
                found = found * (one - e * entry).solved(one + e * entry)
            return found
        return (one - self.hat(y)).solved(one + self.hat(y))

    def measure(self, y: Sequence[Dual]) -> Dual:
        """How far an increment is from the identity, as a step has it."""
        hat = self.hat(y)
        if self.is_rotation:
            return dot(y, y) * number(Fraction(1, 4))
        if self.is_skew:
            return dot(hat.flat, hat.flat)
        for k in reversed(range(2, self.rows)):
            blocks = [Matrix(row[:k] for row in e.rows[:k]) for e in self.generators]
            below = [entry.a for e in self.generators for row in e.rows[k:] for entry in row]
            if all(is_zero(e + e.turned) for e in blocks) and not any(below):
                left = [entry for row in hat.rows for entry in row[:k]]
                return dot(left, left) * HALF
        return dot(hat.flat, hat.flat)


def is_zero(matrix: Matrix) -> bool:
    return not any(entry.a or entry.b for entry in matrix.flat)


class Carried(NamedTuple):
    """An advected or given parameter."""

    action: str
    factors: list[int]
    field: int | None
    rows: int
    columns: int

    def whole(self, entries: Sequence[Dual]) -> Matrix:
        """The matrix of stored entries; a point with its last coordinate."""
        return Matrix.of([*entries, ONE] if self.action == "point" else list(entries), self.columns)

    def moved(self, w: Matrix, f: Sequence[Matrix], inverse: Sequence[Matrix]) -> Matrix:
        """F⁻¹·w."""
        k, last = (self.factors[0], self.factors[-1]) if self.factors else (0, 0)
        match self.action:
            case "covector":
                return f[k].turned * w
            case "vector" | "point":
                return inverse[k] * w
            case "contravariant tensor":
                return inverse[k] * w * inverse[k].turned
            case "covariant tensor":
                return f[k].turned * w * f[k]
            case "mixed tensor":
                return inverse[k] * w * f[k]
            case "relative":
                return inverse[last] * w * f[k]
            case "configuration":
                return w * f[k]
            case "given":
                return w
        raise Declined(f"the action {self.action}")

    def stored(self, w: Matrix) -> list[Dual]:
        return w.flat[:-1] if self.action == "point" else w.flat


ACTIONS = {"Vector": "covector", "SVector": "covector", "Point": "point", "ContravariantVector": "vector"}
ACTIONS |= {f"{kind}Tensor": f"{kind.lower()} tensor" for kind in ("Contravariant", "Covariant", "Mixed")}


class Term:
    """A declared text on the group, with the places of its numbers among those of all terms."""

    def __init__(self, text: str, factors: list[Factor], first: int, carried: list[Carried]) -> None:
        self.declaration = Declaration(text)
        self.factors, self.first, self.carried = factors, first, carried
        self.is_product = self.declaration.arguments.get("group", [""])[0] == "("
        named = self.declaration.list("group")
        self.increments = [part[0] for part in named] if self.is_product else ["F"]
        self.names: list[str] = []
        self.check_group(named)
        for key in self.declaration.arguments:
            if key in ("advected", "given"):
                for part in self.declaration.list(key):
                    self.check_carried(key, part)
        self.carried = carried[: len(self.names)]

    def check_group(self, named: list[list[str]]) -> None:
        groups = [part[-1].rpartition("::")[2] for part in named]
        if groups != [factor.name for factor in self.factors]:
            raise Declined(f"the groups {groups}")
        for factor in self.factors:
            own = self.declaration.generators(factor.name)
            expected = [[Fraction(entry) for row in e for entry in row] for e in own] if own else KNOWN.get(factor.name)
            if expected != factor.listed:
                raise Declined(f"the generators of {factor.name}")

    def check_carried(self, key: str, part: list[str]) -> None:
        name, _, value, *rest = part
        expected = self.carried[len(self.names)] if len(self.names) < len(self.carried) else None
        own = {field.name: at for at, field in enumerate(self.declaration.fields)}
        seen = rest[rest.index("(") + 1] if "(" in rest else None
        found: tuple[str, list[int], int | None]
        if value in self.increments:
            of = [self.increments.index(value)]
            places = of if seen == "space" else [*of, self.increments.index(str(seen))]
            found = ("configuration" if seen == "space" else "relative", places, None)
        else:
            field = self.declaration.fields[own[value]]
            action = "given" if key == "given" else ACTIONS[field.base]
            by = [] if key == "given" else [self.increments.index(seen) if seen else 0]
            found = (action, by, own[value] + self.first)
        if expected is None or found != expected[:3]:
            raise Declined(f"another action on {name}")
        self.names.append(name)

    def is_added(self, factor: int) -> bool:
        return self.is_product and self.factors[factor].is_translation

    def of_factor(self, factor: int, matrix: Matrix) -> Any:
        """A matrix of a factor as the text has it: that of a translation is its displacement."""
        if not self.is_added(factor):
            return matrix
        shift = [row[-1] for row in matrix.rows[:-1]]
        return shift[0] if len(shift) == 1 else column(shift)

    def hat(self, v: Matrix) -> Matrix:
        return next(f for f in self.factors if len(f.generators) == len(v.flat)).hat(v.flat)

    def value(self, key: str, names: dict[str, Any]) -> Dual:
        found = valued(self.declaration.expressions[key], names, self.hat)
        if not isinstance(found, Dual):
            raise Declined(f"`{key}` isn't a number")
        return found

    def scope(self, fields: list[Any], h: Dual, f: Sequence[Matrix], w: Sequence[Matrix]) -> dict[str, Any]:
        size = next((factor.rows for at, factor in enumerate(self.factors) if not self.is_added(at)), 1)
        own = zip(self.declaration.fields, fields, strict=True)
        names = {field.name: value for field, value in own} | {"h": h, "I": Matrix.one(size)}
        names |= {name: self.of_factor(at, f[at]) for at, name in enumerate(self.increments)}
        return names | self.seen(w)

    def seen(self, w: Sequence[Matrix]) -> dict[str, Any]:
        found = {}
        for name, one, value in zip(self.names, self.carried, w, strict=True):
            is_place = one.action in ("relative", "configuration")
            given = value.flat[0] if one.action == "given" and value.shape == (1, 1) else value
            found[name] = self.of_factor(one.factors[0], value) if is_place else given
        return found

    def after(self, names: dict[str, Any], f: Sequence[Matrix], w: Sequence[Matrix]) -> dict[str, Any]:
        """The names at the end of a step."""
        inverse = [one.inverse for one in f]
        return names | self.seen([one.moved(value, f, inverse) for one, value in zip(self.carried, w, strict=True)])

    def lagrangian(self, fields: list[Any], h: Dual, f: Sequence[Matrix], w: Sequence[Matrix]) -> Dual:
        names, given = self.scope(fields, h, f, w), self.declaration.expressions
        has_pace = "pace" in given
        if "l_d" in given:
            if not has_pace:
                return self.value("l_d", names)
            ends = [self.value("pace", one) for one in (names, self.after(names, f, w))]
            names["h"] = h * (ends[0] + ends[1]) * HALF
            energy: Dual = names["h"] * names["E_0"]
            return self.value("l_d", names) + energy
        rule, *rest = self.declaration.arguments["discretise"][1:]
        velocities = self.velocities(rest[1] if rest else "chord", h, f)

        def at(end: dict[str, Any]) -> Dual:
            s = self.value("pace", end) if has_pace else ONE
            inside = {name: velocity / s if has_pace else velocity for name, velocity in velocities.items()}
            return s * (self.value("l", end | inside) + (end["E_0"] if has_pace else ZERO))

        if rule == "trapezoid":
            return h * HALF * (at(names) + at(self.after(names, f, w)))
        if rule == "chord":
            after = self.after(names, f, w)
            return h * at(names | {name: (names[name] + after[name]) * HALF for name in self.names})
        raise Declined(f"the discretisation {rule}")

    def velocities(self, coordinates: str, h: Dual, f: Sequence[Matrix]) -> dict[str, Any]:
        declared = [part[0] for part in self.declaration.list("velocity")]
        found: list[Any] = []
        for at, (factor, element) in enumerate(zip(self.factors, f, strict=True)):
            one = Matrix.one(factor.rows)
            if self.is_added(at):
                found.append(self.of_factor(at, element) / h)
            elif coordinates == "chord":
                found.append(Chord((element - one) / h))
            elif coordinates == "Cayley":
                y = (element + one).turned.solved((element - one).turned).turned
                found.append(column(factor.components(y)) * (number(2) / h))
            elif factor.is_rotation:
                found.append(logarithm(element) / h)
            else:
                raise Declined(f"the coordinates {coordinates} on {factor.name}")
        if len(declared) != len(found) and len(found) == 1:
            # A rigid motion has names for its turn and its shift.
            flat, shifts = found[0].flat, self.factors[0].rows - 1
            turn_, found = flat[:-shifts], [column(flat[:-shifts]), column(flat[-shifts:])]
            found[0] = turn_[0] if len(turn_) == 1 else found[0]
        return dict(zip(declared, found, strict=True)) if declared else {}

    def work(self, names: dict[str, Any], eta: Sequence[Sequence[Dual]]) -> Dual:
        """The virtual work of displacements before and after, in the scope of an increment."""
        declared = [part[0] for part in self.declaration.list("displacement")] or ["eta"]
        for suffix, given in zip(("", "_next"), eta, strict=True):
            first = 0
            for at, name in enumerate(declared):
                own = given[first : first + len(self.factors[at].generators)]
                first += len(own)
                is_number = self.is_added(at) and len(own) == 1
                names[name + suffix] = own[0] if is_number else column(own)
        return self.value("work", names)


def stored_kind(field: Field) -> tuple[str, int, int]:
    """The kind, the rows and the columns of a field's stored numbers."""
    if field.base in KINDS:
        return (KINDS[field.base], 3, 1 if KINDS[field.base] == "diagonal" else 3)
    if field.base in ("f64", "f32", "T"):
        return ("scalar", 1, 1)
    is_column = field.base.endswith("Vector") or field.base == "Point"
    return ("vector", field.size, 1) if is_column else ("matrix", field.size, field.size)


def drawn_field(field: Field) -> tuple[list[Dual], Any]:
    """Stored numbers of a field, and its value in a text."""
    kind, rows, columns = stored_kind(field)
    entries = drawn(rows * columns)
    match kind:
        case "scalar":
            return entries, entries[0]
        case "diagonal":
            return entries, Matrix([entries[i] if i == j else ZERO for j in range(3)] for i in range(3))
        case "symmetric":
            entries[3], entries[6], entries[7] = entries[1], entries[2], entries[5]
    whole = [*entries, ONE] if field.base == "Point" else entries
    return entries, Matrix.of(whole, columns)
