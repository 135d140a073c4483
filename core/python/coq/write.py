"""A certificate as a file of Coq, with a theorem for each claim: ``python write.py FILE.json > Proof.v``.

The claims are those of Step.v, over any field. Standard Python alone is needed, and the folder of `verify` on the path: the
reading of a declared text is the checker's.
"""

from __future__ import annotations

import json
import random
import sys
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[1] / "python" / "liestep"))

from symbols import Matrix, Number, field, motion, node, number, total, written  # noqa: E402
from verify.text import long_decimals  # noqa: E402

Monomial = tuple[str, ...]
Polynomial = dict[Monomial, Fraction]

ARRAYS = ("h", "parameters", "half", "target", "momentum", "advected", "attitude", "history", "factors", "constants")
# Claims by their names in a certificate, with the programs that each is of; without a name, one of all certificates.
CLAIMS = {
    "Increments": (None, []),
    "Work": ("work", []),
    "Target": ("target", ["target"]),
    "Scales": ("residual", ["newton"]),
    "Residual": ("residual", ["newton", "target"]),
    "Jacobian": ("jacobian", ["newton"]),
    "Attitude": ("attitude", ["finish"]),
    "Momentum": ("momentum", ["finish", "target"]),
    "Transport": ("transport", ["finish", "target"]),
    "Advected": ("advected", ["finish"]),
    "Guess": ("guess", ["finish"]),
    "Seen": ("seen", ["seen"]),
}
OF_TEXTS = ("Work", "Residual", "Momentum")
OPERATIONS = {"+": "Plus", "*": "Times", "/": "Over"}
ACTIONS = {
    "covector": "Covector", "vector": "Vector", "point": "Point", "contravariant tensor": "Contravariant",
    "covariant tensor": "Covariant", "mixed tensor": "Mixed", "relative": "Relative", "configuration": "Configuration", "given": "Given",
}  # fmt: skip


def listed(entries: Any) -> str:
    return "[" + "; ".join(entries) + "]"


def rational(value: Fraction) -> str:
    return f"({value.numerator}, {value.denominator})%Z"


def solved(rows: list[list[Fraction]]) -> list[list[Fraction]]:
    """The inverse of a matrix of fractions."""
    n = len(rows)
    whole = [[*row, *(Fraction(i == j) for j in range(n))] for i, row in enumerate(rows)]
    for k in range(n):
        pivot = next(i for i in range(k, n) if whole[i][k])
        whole[k], whole[pivot] = whole[pivot], whole[k]
        whole[k] = [x / whole[k][k] for x in whole[k]]
        for i in range(n):
            if i != k:
                whole[i] = [x - whole[i][k] * y for x, y in zip(whole[i], whole[k], strict=True)]
    return [row[n:] for row in whole]


class Factor(motion.Factor):
    """A factor of the group, whose elements are symbols."""

    def __init__(self, data: dict[str, Any]) -> None:
        self.name, self.rows, self.chart = data["name"], data["rows"], data["chart"]
        self.listed = [[Fraction(entry) for entry in e] for e in data["generators"]]
        self.generators = [Matrix.of([number(entry) for entry in e], self.rows) for e in self.listed]
        pairs = [[sum(a * b for a, b in zip(d, e, strict=True)) for e in self.listed] for d in self.listed]
        inverse = solved([[Fraction(entry) for entry in row] for row in pairs])
        self.dual = Matrix([number(entry) for entry in row] for row in inverse)
        spread = zip(*self.listed, strict=True)
        columns = [[sum(x * y for x, y in zip(row, at, strict=True)) for row in inverse] for at in spread]
        self.coefficients = [list(row) for row in zip(*columns, strict=True)]
        k = range(self.rows)
        self.is_translation = all(
            not sum(d[i * self.rows + m] * e[m * self.rows + j] for m in k) for d in self.listed for e in self.listed for i in k for j in k
        )
        self.is_rotation = self.listed == motion.KNOWN["SO3"]

    def grid(self, entries: list[Fraction]) -> str:
        rows = [entries[at : at + self.rows] for at in range(0, len(entries), self.rows)]
        return listed(listed(rational(entry) for entry in row) for row in rows)

    def written(self) -> str:
        chart = "true" if self.chart == "product" else "false"
        generators, components = (listed(self.grid(e) for e in each) for each in (self.listed, self.coefficients))
        return f"{{| size := {self.rows}; is_product := {chart}; generators := {generators}; components := {components} |}}"


# Polynomials, whose variables are places in arrays


def times(a: Polynomial, b: Polynomial) -> Polynomial:
    found: Polynomial = {}
    for m, x in a.items():
        for k, y in b.items():
            key = tuple(sorted(m + k))
            found[key] = found.get(key, Fraction(0)) + x * y
    return {m: x for m, x in found.items() if x}


def plus(a: Polynomial, b: Polynomial, sign: int = 1) -> Polynomial:
    found = dict(a)
    for m, x in b.items():
        found[m] = found.get(m, Fraction(0)) + sign * x
    return {m: x for m, x in found.items() if x}


def determinant(rows: list[list[Polynomial]]) -> Polynomial:
    if len(rows) == 1:
        return rows[0][0]
    found: Polynomial = {}
    for j, entry in enumerate(rows[0]):
        if entry:
            minor = determinant([row[:j] + row[j + 1 :] for row in rows[1:]])
            found = plus(found, times(entry, minor), -1 if j % 2 else 1)
    return found


class Problem:
    """A certificate, with the variables that its claims are of."""

    def __init__(self, data: dict[str, Any]) -> None:
        self.data = data
        self.factors = [Factor(one) for one in data["factors"]]
        self.counts = [len(factor.generators) for factor in self.factors]
        self.n = sum(self.counts)
        self.count = 0
        self.carried = [motion.Carried(**one) for one in data["advected"]]
        self.decimals = sorted({one for text in data["texts"] for one in long_decimals(text)})
        self.places = self.placed()
        self.declined: dict[str, str] = {}
        try:
            self.texts = self.read()
        except field.Declined as reason:
            self.declined["texts"] = str(reason)
            self.texts = {"energy": "(Number 0 1)", "virtual": "(Number 0 1)"}
        self.programs = {name: self.program(name) for name in ("constants", "target", "newton", "finish", "seen")}
        self.divisors = self.found_divisors()
        self.point, self.primes = self.found_point()

    def new(self, count: int) -> list[int]:
        self.count += count
        return list(range(self.count - count + 1, self.count + 1))

    def placed(self) -> list[list[int]]:
        """The variables of each array, in the order of Step.v."""
        n, shapes = self.n, [one for one in self.carried if one.action not in ("relative", "configuration")]
        free, in_group = sum(one.rows * one.columns for one in shapes), len(shapes) < len(self.carried)
        h, half, target, momentum = self.new(1), self.new(n), self.new(n), self.new(n)
        parameters: list[int] = []
        for one in self.data["parameters"]:
            own = self.new(one["rows"] * one["columns"])
            if one["kind"] == "symmetric":
                own[3], own[6], own[7] = own[1], own[2], own[5]
            parameters += own
        rest = [free, n, 2 * n, n, n, free, n if in_group else 0]
        return [h, parameters, half, target, momentum, *(self.new(count) for count in rest)]

    # The declared texts

    def read(self) -> dict[str, str]:
        """The sum of the Lagrangians, and that of the virtual works; or why one of them can't be read."""
        names = iter(range(1000))
        h = Number(node("Entry", 0, 0, node("Name", next(names))))

        def leaf(rows: int, columns: int) -> Matrix:
            return Matrix(node=node("Name", next(names)), shape=(rows, columns))

        parameters = [leaf(one["rows"], one["columns"]) for one in self.data["parameters"]]
        f, g = ([leaf(factor.rows, factor.rows) for factor in self.factors] for _ in range(2))
        for one, other in zip(f, g, strict=True):
            one.back = other
        w = [leaf(one.rows + (one.action == "point"), one.columns) for one in self.carried]
        eta = [leaf(self.n, 1).flat, leaf(self.n, 1).flat]
        energies, works = [], []
        at = first = 0
        for text in self.data["texts"]:
            term = motion.Term(text, self.factors, first, self.carried[at:])
            own = w[at : at + len(term.names)]
            fields = [self.value(one, stored) for one, stored in zip(term.declaration.fields, parameters[first:], strict=False)]
            at, first = at + len(term.names), first + len(fields)
            if "work" in term.declaration.expressions:
                works.append(term.work(term.scope(fields, h, f, own), eta))
            else:
                energies.append(term.lagrangian(fields, h, f, own))
        return {"energy": written(total(energies).node), "virtual": written(total(works).node)}

    @staticmethod
    def value(declared: Any, stored: Matrix) -> Any:
        """The value of a field in a text."""
        entries = stored.flat
        match motion.stored_kind(declared)[0]:
            case "scalar":
                return entries[0]
            case "diagonal":
                return Matrix([entries[i] if i == j else number(0) for j in range(3)] for i in range(3))
        return Matrix([[entry] for entry in [*entries, number(1)]]) if declared.base == "Point" else stored

    # The programs

    def program(self, name: str) -> str:
        data = self.data["programs"][name]
        functions = {name for name, *_ in data["operations"] if name.isidentifier()}
        if functions:
            self.declined[name] = f"{', '.join(sorted(functions))} in `{name}`"
            data = {"inputs": [], "literals": [], "operations": [], "outputs": []}
        inputs = listed(f"({ARRAYS.index(array)}, {at})" for array, at in data["inputs"])
        literals = listed(rational(self.literal(one)) for one in data["literals"])
        operations = listed(
            ("Minus" if len(read) == 2 else "Negative") + "".join(f" {at + 1}" for at in read)
            if sign == "-"
            else OPERATIONS[sign] + "".join(f" {at + 1}" for at in read)
            for sign, *read in data["operations"]
        )
        outputs = listed(str(at + 1) for at in data["outputs"]) + "%positive"
        return f"{{| inputs := {inputs};\n  literals := {literals};\n  operations := {operations};\n  outputs := {outputs} |}}"

    def literal(self, literal: float) -> Fraction:
        found = field.simplest(literal, self.decimals).constant
        assert found is not None
        return found

    # What stands below

    def found_divisors(self) -> list[Polynomial]:
        numbers = [self.literal(one) for data in self.data["programs"].values() for one in data["literals"]]
        primes = sorted({p for one in numbers for p in factored(one.denominator)} | {2})
        found: list[Polynomial] = [{(): Fraction(p)} for p in primes]
        found.append({("0 0",): Fraction(1)})
        if self.data["power"]:
            found.append(plus({(): Fraction(1)}, {(f"2 {k}",) * 2: Fraction(1) for k in range(self.n)}))
        used = [array for array in (2, 6, 11) if self.places[array]]
        for array in used:
            at = 0
            for factor in self.factors:
                for rows in determined(factor, array, at):
                    one = determinant(rows)
                    if len(one) > 1 and one not in found:
                        found.append(one)
                at += len(factor.generators)
        return found

    def found_point(self) -> tuple[list[int], list[int]]:
        """A point at which each divisor has a prime of its own, once."""
        draw = random.Random(0)
        for size in (100, 1000, 10000, 100000):
            for _ in range(400):
                point = [draw.randrange(2, size) for _ in range(self.count)]
                values = [self.at(one, point) for one in self.divisors]
                primes = [own_prime(values, k) for k in range(len(values))]
                if all(primes):
                    return point, [p for p in primes if p]
        raise field.Declined("no point tells the divisors apart")

    def at(self, one: Polynomial, point: list[int]) -> int:
        value = Fraction(0)
        for monomial, x in one.items():
            for name in monomial:
                array, k = map(int, name.split())
                x = x * point[self.places[array][k] - 1]
            value += x
        return int(value)

    # The file

    def claims(self) -> dict[str, str | None]:
        """The claims of Step.v that the certificate makes, each with the reason why it isn't stated here, or none."""
        made = {one["name"] for one in self.data["claims"]}
        found: dict[str, str | None] = {}
        for name, (of, programs) in CLAIMS.items():
            if of is None or of in made:
                needed = [*(["constants"] if programs else []), *programs, *(["texts"] if name in OF_TEXTS else [])]
                reasons = [self.declined[one] for one in needed if one in self.declined]
                found[name] = reasons[0] if reasons else None
        return found

    def written(self) -> str:
        advected = []
        for one in self.carried:
            action = "Given" if one.action == "given" else f"{ACTIONS[one.action]} {' '.join(map(str, one.factors))}"
            place = "None" if one.field is None else f"Some {one.field}"
            advected.append(f"{{| acts := {action}; shape := ({one.rows}, {one.columns}); in_space := {place} |}}")
        shapes = listed(f"({one['rows']}, {one['columns']})" for one in self.data["parameters"])
        parts = {
            "factors": listed(factor.written() for factor in self.factors),
            "parameters": shapes,
            "advected": listed(advected),
            "power": self.data["power"],
            **self.texts,
            **self.programs,
        }
        certificate = ";\n".join(f"  {name} := {part}" for name, part in parts.items())
        places = listed(listed(map(str, array)) + "%positive" for array in self.places)
        divisors = listed(polynomial(one) for one in self.divisors)
        return (
            "Require Import ZArith List Field.\nRequire Import Liestep.Numbers Liestep.Step Liestep.Sound.\nImport ListNotations.\n\n"
            + "\n".join(f"(* {comment(text)} *)" for text in self.data["texts"])
            + f"\nDefinition declared : certificate := {{|\n{certificate} |}}.\n\n"
            + f"Definition data : problem := {{|\n  step := declared;\n  places := {places};\n  divisors := {divisors};\n"
            + f"  a_point := {listed(map(str, self.point))}%Z;\n  some_primes := {listed(map(str, self.primes))}%Z |}}.\n"
        )


def comment(text: str) -> str:
    return text.replace("(*", "( *").replace("*)", "* )").replace('"', "'")


def determined(factor: Factor, array: int, at: int) -> list[list[list[Polynomial]]]:
    """I ± ŷ for the coordinates at this place of an array, multiplied by a whole number; by a product's chart for each generator."""
    size, places = factor.rows, range(len(factor.generators))
    common = 1
    for entry in (entry for e in factor.listed for entry in e):
        common = common * entry.denominator // gcd_(common, entry.denominator)
    groups = [[k] for k in places] if factor.chart == "product" else [list(places)]
    found = []
    for group in groups:
        for sign in (-1, 1):
            rows: list[list[Polynomial]] = []
            for i in range(size):
                row: list[Polynomial] = []
                for j in range(size):
                    entry: Polynomial = {(): Fraction(common)} if i == j else {}
                    for k in group:
                        value = factor.listed[k][i * size + j] * common * sign
                        entry = plus(entry, {(f"{array} {at + k}",): value})
                    row.append(entry)
                rows.append(row)
            found.append(rows)
    return found


def gcd_(a: int, b: int) -> int:
    return a if not b else gcd_(b, a % b)


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


def own_prime(values: list[int], k: int) -> int | None:
    if not values[k]:
        return None
    factors = factored(values[k])
    rest = [value for at, value in enumerate(values) if at != k]
    return next((p for p in factors if factors.count(p) == 1 and all(value % p for value in rest)), None)


def polynomial(one: Polynomial) -> str:
    """A polynomial as a text, whose names are the arrays."""
    found = number(0)
    for monomial, x in one.items():
        term = number(x)
        for name in monomial:
            array, k = map(int, name.split())
            term = term * Number(node("Entry", k, 0, node("Name", array)))
        found = found + term
    return written(found.node)


FIELD = "K k0 k1 kadd kmul ksub kdiv kopp"


def theorem(name: str) -> str:
    return (
        f"\nLemma {name}_found : found data {name} = Holds. Proof. vm_cast_no_check (eq_refl Holds). Qed.\n"
        f"Definition {name}_holds K k0 k1 kadd kmul ksub kdiv kopp kinv (theory : field_theory k0 k1 kadd kmul ksub kopp kdiv kinv (@eq K)) :\n"
        f"  holds {FIELD} data {name} := sound {FIELD} kinv theory data {name} {name}_found.\n"
    )


def proof(data: dict[str, Any], verdicts: bool = False) -> tuple[str, dict[str, str | None]]:
    """The file of a certificate, with proofs or with what is found of each claim; and its claims, with the reasons of those left out."""
    problem = Problem(data)
    claims = problem.claims()
    stated = [name for name, reason in claims.items() if not reason]
    parts = [f"Eval vm_compute in ({name}, found data {name}).\n" if verdicts else theorem(name) for name in stated]
    every = "" if verdicts else "\nDefinition all := (" + ", ".join(f"@{name}_holds" for name in stated) + ").\nPrint Assumptions all.\n"
    return problem.written() + "".join(parts) + every, claims


if __name__ == "__main__":
    print(proof(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8")))[0])
