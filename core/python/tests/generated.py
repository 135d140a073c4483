"""Random declarations, each as text for the library and as a function of numbers that shares no code with it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import expm, logm

Values = dict[str, Any]


class Part(NamedTuple):
    """A part of an expression: its text, and its value by the values of all names."""

    text: str
    value: Callable[[Values], Any]


def unit(n, *entries):
    matrix = np.zeros((n, n))
    for row, column, value in entries:
        matrix[row, column] = value
    return matrix


def turns(n):
    return [unit(n, (1, 2, -1), (2, 1, 1)), unit(n, (0, 2, 1), (2, 0, -1)), unit(n, (0, 1, -1), (1, 0, 1))]


def shifts(n, *columns):
    return [unit(n, (row, column, 1)) for column in columns for row in range(min(columns))]


#: The basis of each group's Lie algebra, typed from the pages of the groups.
BASES = {
    "SO2": [unit(2, (0, 1, -1), (1, 0, 1))],
    "SE2": [unit(3, (0, 1, -1), (1, 0, 1)), *shifts(3, 2)],
    "SO3": turns(3), "SE3": turns(4) + shifts(4, 3), "SE23": turns(5) + shifts(5, 3, 4),
    "SU2": [unit(4, (0, 1, -.5), (1, 0, .5), (2, 3, -.5), (3, 2, .5)), unit(4, (0, 2, -.5), (1, 3, .5), (2, 0, .5), (3, 1, -.5)),
            unit(4, (0, 3, -.5), (1, 2, -.5), (2, 1, .5), (3, 0, .5))],
    "SL2": [unit(2, (0, 0, .5), (1, 1, -.5)), unit(2, (0, 1, .5), (1, 0, .5)), unit(2, (0, 1, -.5), (1, 0, .5))],
    "Heisenberg": [unit(3, (0, 1, 1)), unit(3, (1, 2, 1)), unit(3, (0, 2, 1))],
    "R1": shifts(2, 1), "R2": shifts(3, 2), "R3": shifts(4, 3),
    "Affine": [unit(2, (0, 0, 1)), unit(2, (0, 1, 1))],
    "Affine2": [unit(3, (row, column, 1)) for row in range(2) for column in range(3)],
}
OWN = {"Affine", "Affine2"}
LOGARITHM = {"SO3", "Heisenberg", "R1", "R2", "R3"}


class Factor:
    """A factor of the group: its increment's name, its basis, and how an element moves."""

    def __init__(self, name: str, group: str, is_added: bool):
        self.name, self.group, self.is_added = name, group, is_added
        self.basis = np.array(BASES[group])
        self.size, self.dimension = self.basis.shape[1], len(self.basis)

    def along(self, g, k, by):
        """The element moved along a generator of the body's axes."""
        if self.is_added:
            return g + by * np.eye(self.dimension)[k]
        return g @ expm(by * self.basis[k])

    def increment(self, g, after):
        if self.is_added:
            return (after - g)[0] if self.dimension == 1 else after - g
        return np.linalg.solve(g, after)

    def element(self, random, size):
        if self.is_added:
            return random.normal(size=self.dimension)
        return expm(np.tensordot(size * random.normal(size=self.dimension), self.basis, 1))

    def matrix(self, g):
        """The element as a matrix, as the library has it."""
        if not self.is_added:
            return g
        matrix = np.eye(self.size)
        matrix[:-1, -1] = g
        return matrix

    def of_matrix(self, matrix):
        return np.array(matrix)[:-1, -1] if self.is_added else np.array(matrix)

    def velocity(self, increment, h, by_cayley):
        """The components of the velocity of an increment, by the inverse of the Cayley map or by the logarithm."""
        if self.is_added:
            return increment / h
        one = np.eye(self.size)
        x = 2 * (increment - one) @ np.linalg.inv(increment + one) if by_cayley else logm(increment).real
        return np.linalg.lstsq(self.basis.reshape(self.dimension, -1).T, x.ravel() / h, rcond=None)[0]

    def half(self, increment):
        return increment / 2 if self.is_added else expm(logm(increment).real / 2)


#: What a body sees of each kind of value that is fixed in space.
SEEN = {
    "covector": lambda g, up: g.T @ up, "point": lambda g, p: np.linalg.solve(g, p),
    "contravariant": lambda g, v: np.linalg.solve(g, v), "form": lambda g, b: g.T @ b @ g,
    "mixed": lambda g, m: np.linalg.solve(g, m) @ g,
}


#: The names that such values have in a declaration.
LETTERS = {"covector": "w", "point": "p", "contravariant": "u", "form": "B", "mixed": "M"}


class Generated:
    """A random declaration, with the values of its parameters."""

    def __init__(self, seed: int):
        self.random = np.random.default_rng(seed)
        self.parameters: Values = {}
        self.advected: dict[str, tuple[str, Callable[[list[Any]], Any]]] = {}
        self._factors()
        self.is_continuous = self.chance(0.4)
        self._advect()
        self.rule = self._rule() if self.is_continuous else ""
        self.lets: list[tuple[str, Part]] = []
        self.sum = self._sum()
        self.work = self._work() if self.chance(0.2) else None

    def chance(self, share: float) -> bool:
        return bool(self.random.random() < share)

    def pick(self, choices):
        return choices[self.random.integers(len(choices))]

    def _factors(self) -> None:
        if self.chance(0.5):
            self.factors = [Factor("F", self.pick(list(BASES)), False)]
            return
        names, self.factors, left = [name for name in BASES if name not in OWN], [], 12
        for number in range(1, 2 + int(self.random.integers(1, 4))):
            fitting = [name for name in names if len(BASES[name]) <= left]
            if not fitting:
                break
            group = self.pick(fitting)
            added = group in ("R1", "R2", "R3")
            self.factors.append(Factor(f"{'d' if added else 'F'}_{number}", group, added))
            left -= self.factors[-1].dimension
        if all(one.is_added for one in self.factors):
            self.factors[0] = Factor("F_1", "SO3", False)

    def parameter(self, name: str, value) -> Part:
        self.parameters[name] = value
        return Part(name, lambda values: values[name])

    def vector(self, name: str, n: int) -> Part:
        return self.parameter(name, self.random.normal(size=n))

    def _advect(self) -> None:
        import liestep as ls

        made = {"point": lambda v: ls.point(v[:-1]), "contravariant": ls.contravariant, "form": ls.covariant, "mixed": ls.mixed}
        is_one, self.vectors, self.matrices, self.scalars = len(self.factors) == 1, {}, {}, []
        for at, one in enumerate(self.factors):
            seen_from = "" if is_one else f".seen_from({one.name})"
            n, kinds = one.size, ["covector"]
            if one.is_added:
                self._place(at, one)
                continue
            kinds += [kind for kind in ("contravariant", "form", "mixed") if self.chance(0.3 if is_one else 0.15)]
            kinds += ["point"] if one.group in ("SE2", "SE3") and self.chance(0.4) else []
            self.vectors[at], self.matrices[at] = [], []
            for kind in kinds:
                name, space = f"{LETTERS[kind]}{at}", f"{kind}_{at}"
                value = self.random.normal(size=(n, n) if kind in ("form", "mixed") else n)
                if kind == "point":
                    value[-1] = 1
                own = made[kind](value) if kind in made else value
                self.parameters[space] = own
                self.advected[name] = space + seen_from, lambda g, at=at, kind=kind, value=value: SEEN[kind](g[at], value)
                part = Part(name, lambda values, name=name: values[name])
                (self.matrices if kind in ("form", "mixed") else self.vectors)[at].append(part)
            if not is_one and self.chance(0.3):
                name = f"R{at}"
                self.advected[name] = f"{one.name}.seen_from(space)", lambda g, at=at: g[at]
                self.matrices[at].append(Part(name, lambda values, name=name: values[name]))
            self.vectors[at].append(self.vector(f"a{at}", n))
            self.matrices[at].append(self.parameter(f"A{at}", self.random.normal(size=(n, n))))
        # No more than six are advected, and each factor keeps its first.
        for name in [name for name in self.advected if name[0] not in "wx"][6 - len(self.advected):] if len(self.advected) > 6 else []:
            self._forget(name)

    def _forget(self, name: str) -> None:
        space = self.advected.pop(name)[0].split(".")[0]
        self.parameters.pop(space, None)
        for parts in (*self.vectors.values(), *self.matrices.values()):
            parts[:] = [part for part in parts if part.text != name]

    def _place(self, at: int, one: Factor) -> None:
        """The place of a translated body, as an advected vector."""
        name, is_one = f"x{at}", one.dimension == 1
        self.advected[name] = f"{one.name}.seen_from(space)", lambda g: g[at][0] if is_one else g[at]
        part = Part(name, lambda values: values[name])
        if is_one:
            self.scalars.append(part)
        else:
            self.vectors[at], self.matrices[at] = [part, self.vector(f"a{at}", one.dimension)], []

    def _rule(self) -> str:
        rules = ["trapezoid(Cayley)", "chord(Cayley)"]
        if all(one.group in LOGARITHM for one in self.factors):
            rules += ["trapezoid(exp)", "midpoint(exp)", "chord(exp)"]
        return self.pick(rules)

    def seen(self, at: int) -> Part:
        """A vector of a factor that depends on the motion."""
        one = self.factors[at]
        if one.is_added and one.dimension == 1:
            raise ValueError(one.group)
        moving = [part for part in self.vectors[at] if not part.text.startswith("a")]
        part = self.pick(moving)
        if self.is_continuous:
            return part
        name = one.name
        if one.is_added:
            return self.pick([part, Part(f"({part.text} + {name})", lambda values: part.value(values) + values[name])])
        turned = Part(f"({name}.transpose() * {part.text})", lambda values: values[name].T @ part.value(values))
        if part.text[0] in "up":
            turned = Part(f"(inverse({name}) * {part.text})", lambda values: np.linalg.solve(values[name], part.value(values)))
        return self.pick([part, turned])

    def any_vector(self, at: int, depth: int) -> Part:
        choice = self.random.integers(6 if depth else 3)
        a = self.pick(self.vectors[at])
        if choice == 0:
            return a
        if choice == 1 or not self.matrices[at] and choice in (2, 3):
            return self.seen(at)
        if choice in (2, 3):
            m, v = self.pick(self.matrices[at]), self.seen(at) if depth == 0 else self.any_vector(at, depth - 1)
            return Part(f"({m.text} * {v.text})", lambda values: m.value(values) @ v.value(values))
        one, other = self.any_vector(at, depth - 1), self.any_vector(at, depth - 1)
        if choice == 4 and self.factors[at].group == "SO3":
            return Part(f"{one.text}.cross({other.text})", lambda values: np.cross(one.value(values), other.value(values)))
        return Part(f"({one.text} + {other.text})", lambda values: one.value(values) + other.value(values))

    def scalar(self, depth: int) -> Part:
        places = list(self.vectors)
        at = self.pick(places)
        choice = self.random.integers(9 if depth else 2)
        if choice == 1 and self.scalars:
            return self.pick(self.scalars)
        if choice == 2 and self.matrices[at]:
            return self._trace(at)
        if choice in (0, 1, 2):
            one, other = self.seen(at), self.any_vector(at, depth)
            return Part(f"{one.text}.dot({other.text})", lambda values: one.value(values) @ other.value(values))
        one = self.scalar(depth - 1)
        if choice in (3, 4):
            name, function = self.pick([("sin", np.sin), ("cos", np.cos)])
            return Part(f"({one.text}).{name}()", lambda values: function(one.value(values)))
        if choice == 5:
            power = int(self.random.integers(2, 4))
            return Part(f"({one.text}).powi({power})", lambda values: one.value(values) ** power)
        other = self.any_vector(at, 1)
        norm = Part(f"{other.text}.norm_squared()", lambda values: other.value(values) @ other.value(values))
        if choice == 6:
            name, function = self.pick([("sqrt", np.sqrt), ("ln", np.log)])
            return Part(f"(1 + {norm.text}).{name}()", lambda values: function(1 + norm.value(values)))
        if choice == 7:
            return Part(f"{one.text} / (2 + {norm.text})", lambda values: one.value(values) / (2 + norm.value(values)))
        return Part(f"(0.1 * {one.text}).exp()", lambda values: np.exp(0.1 * one.value(values)))

    def _trace(self, at: int) -> Part:
        m, other = self.pick(self.matrices[at]), self.pick(self.matrices[at])
        name = self.factors[at].name
        if self.is_continuous:
            return Part(f"({m.text} * {other.text}).trace()", lambda values: np.trace(m.value(values) @ other.value(values)))
        return Part(f"({m.text} * {name} * {other.text}).trace()",
                    lambda values: np.trace(m.value(values) @ values[name] @ other.value(values)))

    def _positive(self, name: str, n: int) -> Part:
        root = 0.5 * self.random.normal(size=(n, n))
        return self.parameter(name, np.eye(n) + root @ root.T)

    def kinetic(self, at: int) -> Part:
        one = self.factors[at]
        name = self.velocity(at) if self.is_continuous else one.name
        per = "2" if self.is_continuous else "(2 * h)"
        half = (lambda values: 2.0) if self.is_continuous else (lambda values: 2 * values["h"])
        if one.is_added or self.is_continuous and one.dimension == 1:
            m = self.parameter(f"mass{at}", 1 + self.random.random())
            square = f"{name} * {name}" if one.is_added and one.dimension == 1 else f"{name}.norm_squared()"
            return Part(f"{m.text} * {square} / {per}",
                        lambda values: m.value(values) * np.dot(values[name], values[name]) / half(values))
        if self.is_continuous and self.chance(0.5):
            k = self._positive(f"K{at}", one.dimension)
            return Part(f"{name}.dot({k.text} * {name}) / 2", lambda values: values[name] @ k.value(values) @ values[name] / 2)
        k, n = self._positive(f"K{at}", one.size), one.size

        def value(values):
            x = np.tensordot(values[name], one.basis, 1) if self.is_continuous else values[name] - np.eye(n)
            return np.trace(x @ k.value(values) @ x.T) / half(values)

        # Only one factor has a `hat`.
        if self.is_continuous:
            if len(self.factors) > 1:
                return self.kinetic(at)
            return Part(f"({{ let X = hat({name}); (X * {k.text} * X.transpose()).trace() / 2 }})", value)
        return Part(f"(({name} - I) * {k.text} * ({name} - I).transpose()).trace() / {per}", value)

    def velocity(self, at: int) -> str:
        return "xi" if len(self.factors) == 1 else f"v_{at + 1}"

    def _sum(self) -> Part:
        parts = [self.kinetic(at) for at in range(len(self.factors))]
        for _ in range(self.random.integers(1, 4)):
            moving, other = self._moving(), self.scalar(2)
            c = self.parameter(f"c{len(parts)}", self.random.normal())
            term = Part(f"{c.text} * {moving.text} * (1 + {other.text})",
                        lambda values, c=c, moving=moving, other=other: c.value(values) * moving.value(values) * (1 + other.value(values)))
            if self.chance(0.4):
                term = self._named(term, other)
            if not self.is_continuous:
                parts.append(Part(f"h * {term.text}", lambda values, term=term: values["h"] * term.value(values)))
            else:
                parts.append(term)
        text = parts[0].text + "".join(f" - {part.text}" if k >= len(self.factors) else f" + {part.text}" for k, part in enumerate(parts) if k)
        bound = "".join(f"let {name} = {part.text}; " for name, part in self.lets)
        first = len(self.factors)
        return Part(f"{{ {bound}{text} }}" if bound else text,
                    lambda values: sum(part.value(values) for part in parts[:first]) - sum(part.value(values) for part in parts[first:]))

    def _named(self, term: Part, inner: Part) -> Part:
        name = f"q{len(self.lets)}"
        self.lets.append((name, inner))
        return Part(term.text.replace(inner.text, name), term.value)

    def _moving(self) -> Part:
        """A scalar that depends on the motion for certain."""
        at = self.pick(list(self.vectors))
        b, one = self.vector(f"b{len(self.parameters)}", len(self._sample(at))), self.seen(at)
        return Part(f"{one.text}.dot({b.text})", lambda values: one.value(values) @ b.value(values))

    def _sample(self, at: int):
        one = self.factors[at]
        return np.zeros(one.dimension if one.is_added else one.size)

    def _work(self) -> Part:
        names = ["eta"] if len(self.factors) == 1 else [f"eta_{at + 1}" for at in range(len(self.factors))]
        at = int(self.random.integers(len(names)))
        one, name = self.factors[at], names[at]
        c, size = self.parameter("force", 0.3 * self.random.normal()), self.scalar(1)
        if one.is_added and one.dimension == 1:
            return Part(f"h * {c.text} * ({name} + {name}_next) / 2",
                        lambda values: values["h"] * c.value(values) * (values[name] + values[f"{name}_next"]) / 2)
        tau = self.vector("tau", one.dimension)
        return Part(f"h * {c.text} * (1 + {size.text}) * {tau.text}.dot({name} + {name}_next) / 2",
                    lambda values: values["h"] * c.value(values) * (1 + size.value(values)) * (tau.value(values) @ (values[name] + values[f"{name}_next"])) / 2)

    # The declaration in the library.

    def term(self):
        """The declaration as the library reads its text."""
        import liestep as ls

        one = len(self.factors) == 1
        group = self.factors[0].group if one else {factor.name: factor.group for factor in self.factors}
        more = {"generators": BASES[group]} if one and group in OWN else {}
        if self.is_continuous:
            more |= {"velocity": ", ".join(map(self.velocity, range(len(self.factors)))), "discretise": self.rule, "l": self.sum.text}
        else:
            more["l_d"] = self.sum.text
        term = ls.lagrangian(group, advected=self.used(self.sum.text), **more, **self.named(self.sum.text))
        if self.work:
            of = {} if one else {"displacement": ", ".join(f"eta_{at + 1}" for at in range(len(self.factors)))}
            of |= {"generators": BASES[group]} if one and group in OWN else {}
            text = self.work.text
            term += ls.force(group, work=text, advected=self.used(text), **of, **self.named(text))
        return term

    def words(self, text: str) -> set[str]:
        return set("".join(letter if letter.isalnum() or letter == "_" else " " for letter in text).split())

    def used(self, text: str) -> dict[str, str]:
        return {name: space for name, (space, _) in self.advected.items() if name in self.words(text)}

    def named(self, text: str) -> Values:
        words = self.words(text) | {space.split(".")[0] for space in self.used(text).values()}
        return {name: value for name, value in self.parameters.items() if name in words}

    # The same in numbers.

    def values(self, g, after, h: float) -> Values:
        """The values of all names at the beginning of a step between two configurations."""
        values = {**self.parameters, "h": h}
        values |= {name: seen(g) for name, (_, seen) in self.advected.items()}
        for one, now, then in zip(self.factors, g, after):
            values[one.name] = one.increment(now, then)
        return values

    def discrete(self, g, after, h: float) -> float:
        """The Lagrangian of a step."""
        values = self.values(g, after, h)
        if not self.is_continuous:
            return float(self.sum.value(values))
        by_cayley = "Cayley" in self.rule
        for at, one in enumerate(self.factors):
            values[self.velocity(at)] = one.velocity(values[one.name], h, by_cayley)
        ends = [{name: seen(at) for name, (_, seen) in self.advected.items()} for at in (g, after)]
        if self.rule.startswith("chord"):
            return float(h * self.sum.value(values | {name: (ends[0][name] + ends[1][name]) / 2 for name in ends[0]}))
        if self.rule.startswith("midpoint"):
            steps = [one.half(values[one.name]) for one in self.factors]
            middle = [now + step if one.is_added else now @ step for one, now, step in zip(self.factors, g, steps)]
            return float(h * self.sum.value(values | {name: seen(middle) for name, (_, seen) in self.advected.items()}))
        return float(h / 2 * sum(self.sum.value(values | end) for end in ends))

    def impulse(self, g, after, h: float) -> list[list[float]]:
        """The force at both ends of a step along all directions."""
        if not self.work:
            return [[0.0] * sum(one.dimension for one in self.factors)] * 2
        names = ["eta"] if len(self.factors) == 1 else [f"eta_{at + 1}" for at in range(len(self.factors))]
        values, ends = self.values(g, after, h), []
        still = {f"{name}{end}": np.zeros(one.dimension) for name, one in zip(names, self.factors) for end in ("", "_next")}
        for end in ("", "_next"):
            along = [(name + end, row) for name, one in zip(names, self.factors) for row in np.eye(one.dimension)]
            ends.append([float(np.squeeze(self.work.value(values | still | {name: row}))) for name, row in along])
        return ends

    def momenta(self, g, after, h: float, distance: float):
        """The momenta before and after a step, by differences of the Lagrangian of the step."""
        before, behind = [], []
        for at, one in enumerate(self.factors):
            for k in range(one.dimension):
                def moved(by, of, at=at, one=one, k=k):
                    new = list(of)
                    new[at] = one.along(of[at], k, by)
                    return new
                before.append(-_slope(lambda by: self.discrete(moved(by, g), after, h), distance))
                behind.append(_slope(lambda by: self.discrete(g, moved(by, after), h), distance))
        first, last = self.impulse(g, after, h)
        return np.array(before) - first, np.array(behind) + last


def _slope(function: Callable[[float], float], e: float) -> float:
    near, far = ((function(by) - function(-by)) / (2 * by) for by in (e, 2 * e))
    return (4 * near - far) / 3
