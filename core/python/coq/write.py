"""A certificate as a file of Coq, with a theorem for each claim: ``python write.py FILE.json > Proof.v``.

The claims are those of Step.v, over any field. Standard Python alone is needed, and the folder of `verify` on the path: the
reading of a declared text is the checker's. Divisors and rules for functions are found by asking Coq, see `Problem.answer`.
"""

from __future__ import annotations

import copy
import json
import math
import random
import sys
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[1] / "python" / "liestep"))

from polynomials import Polynomial, content, divided, factored, product, stripped  # noqa: E402
from symbols import FUNCTIONS, Matrix, Number, called, field, motion, node, number, total, written  # noqa: E402
from verify.text import long_decimals  # noqa: E402

ARRAYS = ("h", "parameters", "half", "target", "momentum", "advected", "attitude", "history", "factors", "constants")
# Claims by their names in a certificate, with the programs that each is of; without a name, one of all certificates.
CLAIMS = {
    "Increments": (None, []),
    "Work": ("work", []),
    "Target": ("target", ["target"]),
    "Scales": ("residual", ["newton"]),
    "Residual": ("residual", ["newton", "target"]),
    "Jacobian": ("jacobian", ["newton"]),
    "Update": ("update", ["newton"]),
    "Attitude": ("attitude", ["finish"]),
    "Momentum": ("momentum", ["finish", "target"]),
    "Transport": ("transport", ["finish", "target"]),
    "Advected": ("advected", ["finish"]),
    "Guess": ("guess", ["finish"]),
    "Checks": ("checks", ["finish"]),
    "Seen": ("seen", ["seen"]),
}
# Unknowns of a solve that is stated for any Jacobian, whose determinant stands below.
MOST = 5
OF_TEXTS = ("Work", "Residual", "Momentum")
RULES = {"sin": "AngleAt", "cos": "AngleAt", "exp": "ExpAt", "ln": "LnAt", "stumpff": "StumpffAt", "log_ratio": "RatioAt"}
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

    @property
    def distance(self) -> str:
        """How a step measures an increment: `Factor.measure` of the reading, as columns and a multiple."""
        if self.is_translation:
            return "None"
        n, grids = self.rows, [[e[at : at + self.rows] for at in range(0, len(e), self.rows)] for e in self.listed]

        def is_skew(k: int) -> bool:
            return all(e[i][j] + e[j][i] == 0 for e in grids for i in range(k) for j in range(k)) and not any(x for e in grids for row in e[k:] for x in row)

        columns = next((k for k in reversed(range(2, n + 1)) if is_skew(k)), n)
        multiple = Fraction(1, 8) if self.is_rotation else Fraction(1, 2) if columns < n else Fraction(1)
        return f"Some ({columns}%nat, {rational(multiple)})"

    def grid(self, entries: list[Fraction]) -> str:
        rows = [entries[at : at + self.rows] for at in range(0, len(entries), self.rows)]
        return listed(listed(rational(entry) for entry in row) for row in rows)

    def written(self) -> str:
        chart = "true" if self.chart == "product" else "false"
        generators, components = (listed(self.grid(e) for e in each) for each in (self.listed, self.coefficients))
        return f"{{| size := {self.rows}; is_product := {chart}; generators := {generators}; components := {components}; distance := {self.distance} |}}"


class Problem:
    """A certificate, with the variables that its claims are of.

    Where it isn't exact, it is more general: roots are any numbers, whatever their squares, and elements of the group any matrices.
    """

    def __init__(self, data: dict[str, Any], is_exact: bool = False) -> None:
        self.data, self.is_exact = data, is_exact
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
        numbers = [self.literal(one) for program in data["programs"].values() for one in program["literals"]]
        primes = sorted({p for one in numbers for p in factored(one.denominator)} | {2})
        self.divisors: list[Polynomial] = [*({(): p} for p in primes), {(1,): 1}]
        self.rules: list[str] = []
        self.point, self.primes = self.found_point()

    def new(self, count: int) -> list[int]:
        self.count += count
        return list(range(self.count - count + 1, self.count + 1))

    def placed(self) -> list[list[int]]:
        """The variables of each array, in the order of Step.v."""
        n, free = self.n, sum(one.rows * one.columns for one in self.carried)
        in_group = any(one.action in ("relative", "configuration") for one in self.carried)
        h, half, target, momentum = self.new(1), self.new(n), self.new(n), self.new(n)
        parameters: list[int] = []
        for one in self.data["parameters"]:
            own = self.new(one["rows"] * one["columns"])
            if one["kind"] == "symmetric":
                own[3], own[6], own[7] = own[1], own[2], own[5]
            parameters += own
        rest = [free, n, 2 * n, n, n, free, n if in_group else 0, 0, n + n * n]
        return [h, parameters, half, target, momentum, *(self.new(count) for count in rest)]

    def changed(self, data: dict[str, Any]) -> Problem:
        """The same problem with the programs of another certificate."""
        found = copy.copy(self)
        found.data = data
        found.programs = {name: found.program(name) for name in self.programs}
        return found

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
        inputs = listed(f"({ARRAYS.index(array)}, {at})" for array, at in data["inputs"])
        literals = listed(rational(self.literal(one)) for one in data["literals"])
        operations = listed(
            " ".join([operation(sign, len(read)), *(str(at + 1) for at in read)]) for sign, *read in data["operations"]
        )
        outputs = listed(str(at + 1) for at in data["outputs"]) + "%positive"
        return f"{{| inputs := {inputs};\n  literals := {literals};\n  operations := {operations};\n  outputs := {outputs} |}}"

    def literal(self, literal: float) -> Fraction:
        found = field.simplest(literal, self.decimals).constant
        assert found is not None
        return found

    # What stands below, and functions

    def answer(self, questions: list[Any]) -> bool:
        """Takes up what a check has asked for: divisors, and functions at their arguments; whether there was any."""
        before = len(self.divisors), len(self.rules)
        for code, order, terms, powers in questions:
            if code:
                self.call(list(FUNCTIONS)[code - 1], expanded(terms), powers, order)
        asked = [expanded(terms) for code, _, terms, _ in questions if not code]
        for one in sorted(asked, key=len):
            self.divide(one)
        self.point, self.primes = self.found_point()
        return before != (len(self.divisors), len(self.rules))

    def divide(self, one: Polynomial) -> None:
        """The parts of a polynomial become divisors that have no common parts."""
        variables, one = stripped(one)
        new = [{(): p} for p in factored(content(one))] + [{(variable,): 1} for variable in variables]
        self.divisors += [part for part in new if part not in self.divisors]
        unit = content(one) * (1 if one[max(one, key=lambda m: (len(m), m))] > 0 else -1)
        one = {m: x // unit for m, x in one.items()}
        for other in self.divisors:
            while len(other) > 1 and (rest := divided(one, other)) is not None:
                one = rest
        if len(one) > 1:
            for at, other in enumerate(self.divisors):
                while (rest := divided(other, one)) is not None:
                    self.divisors[at] = other = rest
            self.divisors.append(one)

    def call(self, function: str, argument: Polynomial, powers: list[int], order: int) -> None:
        """A rule for a function at argument / (divisors to these powers)."""
        known = []
        for one, k in zip(self.divisors, powers, strict=False):
            while k and (rest := divided(argument, one)) is not None:
                argument, k = rest, k - 1
            known.append((one, k))
        value, x = self.quotient(argument, product(known)), len(self.places[12])
        if function != "sqrt" and argument == ({(): 1} if function == "ln" else {}):
            self.rules.append("AtOrigin")
            return
        self.places[12] += self.new(1)
        if function == "sqrt" and not self.is_exact:
            self.rules.append(f"RootAt {value} (Number 1 1) (Number 0 1) {x}")
        elif function == "sqrt":
            below = product([(one, (k + 1) // 2) for one, k in known])
            square = product([(argument, 1), *((one, k % 2) for one, k in known)])
            self.rules.append(f"RootAt {value} {self.text(below)} {self.text(square)} {x}")
        else:
            self.rules.append(f"{RULES[function]} {value} {x}")

    def quotient(self, above: Polynomial, below: Polynomial) -> str:
        return self.text(above) if below == {(): 1} else f"(Quotient {self.text(above)} {self.text(below)})"

    def text(self, one: Polynomial) -> str:
        """A polynomial as a text, whose names are the arrays."""
        place = {variable: (array, at) for array, own in enumerate(self.places) for at, variable in enumerate(own)}
        terms = []
        for monomial, x in one.items():
            terms.append(number(x))
            for variable in monomial:
                array, at = place[variable]
                terms[-1] *= Number(node("Entry", at, 0, node("Name", array)))
        while len(terms) > 1:
            terms = [total(terms[at : at + 2]) for at in range(0, len(terms), 2)]
        return written(total(terms).node)

    def found_point(self) -> tuple[list[int], list[int]]:
        """A point at which each divisor has a prime of its own, once; or is one."""
        draw = random.Random(0)
        for size in (100, 1000, 10000, 100000):
            for _ in range(400):
                point = [draw.randrange(2, size) for _ in range(self.count)]
                values = [sum(x * math.prod(point[j - 1] for j in m) for m, x in one.items()) for one in self.divisors]
                primes = [one[()] if list(one) == [()] else own_prime(value, values) for one, value in zip(self.divisors, values, strict=True)]
                if all(primes):
                    return point, [p for p in primes if p]
        raise field.Declined("no point tells the divisors apart")

    # The file

    def claims(self) -> dict[str, str | None]:
        """The claims of Step.v that the certificate makes, each with the reason why it isn't stated here, or none."""
        made = {one["name"] for one in self.data["claims"]}
        found: dict[str, str | None] = {}
        for name, (of, programs) in CLAIMS.items():
            if of is None or of in made:
                found[name] = self.declined.get("texts") if name in OF_TEXTS else self.mixed() if name == "Update" else None
        return found

    def mixed(self) -> str | None:
        """Why a solve isn't stated for any Jacobian: it has too many entries, or operations before them are read."""
        program, n = self.data["programs"]["newton"], self.n
        if n > MOST:
            return f"the determinant of {n} unknowns has too many terms"
        first, free = len(program["inputs"]) + len(program["literals"]), set(program["outputs"][: n + n * n])
        behind, needed = set(free), set(program["outputs"][n + n * n : 2 * n + n * n]) - free
        for at, (_, *read) in enumerate(program["operations"], first):
            if behind.intersection(read):
                behind.add(at)
        for at, (_, *read) in reversed(list(enumerate(program["operations"], first))):
            needed |= set(read) - free if at in needed else set()
        reads = any(at >= first and at not in behind for at in needed)
        return "the solve reads parts of the Jacobian's entries" if reads else None

    @property
    def stated(self) -> list[str]:
        return [name for name, reason in self.claims().items() if not reason]

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
            "in_products": str(self.is_exact).lower(),
            **self.texts,
            **self.programs,
        }
        certificate = ";\n".join(f"  {name} := {part}" for name, part in parts.items())
        places = listed(listed(map(str, array)) + "%positive" for array in self.places)
        divisors = listed(self.text(one) for one in self.divisors)
        return (
            "Require Import ZArith List Field.\nRequire Import Liestep.Numbers Liestep.Step Liestep.Sound.\nImport ListNotations.\n\n"
            + "\n".join(f"(* {comment(text)} *)" for text in self.data["texts"])
            + f"\nDefinition declared : certificate := {{|\n{certificate} |}}.\n\n"
            + f"Definition data : problem := {{|\n  step := declared;\n  places := {places};\n  divisors := {divisors};\n"
            + f"  a_point := {listed(map(str, self.point))}%Z;\n  some_primes := {listed(map(str, self.primes))}%Z;\n"
            + f"  rules := {listed(self.rules)} |}}.\n"
        )


def comment(text: str) -> str:
    return text.replace("(*", "( *").replace("*)", "* )").replace('"', "'")


def own_prime(value: int, values: list[int]) -> int | None:
    """A prime that divides a value once, and no other one."""
    return next((p for p in factored(value) if value % (p * p) and sum(not other % p for other in values) == 1), None) if value else None


def expanded(terms: list[Any]) -> Polynomial:
    return {tuple(sorted(j for j, k in powers for _ in range(k))): x for x, powers in terms}


def operation(sign: str, reads: int) -> str:
    if sign == "-":
        return "Minus" if reads == 2 else "Negative"
    return OPERATIONS.get(sign) or f"Apply {called(sign)}"


FIELD = "K k0 k1 kadd kmul ksub kdiv kopp"


def theorem(name: str) -> str:
    return (
        f"\nLemma {name}_found : found data {name} = Holds. Proof. vm_cast_no_check (eq_refl Holds). Qed.\n"
        f"Definition {name}_holds K k0 k1 kadd kmul ksub kdiv kopp kinv (theory : field_theory k0 k1 kadd kmul ksub kopp kdiv kinv (@eq K)) apply :\n"
        f"  holds {FIELD} apply data {name} := sound {FIELD} kinv theory apply data {name} {name}_found.\n"
    )


def proof(problem: Problem, names: list[str]) -> str:
    """The file of a certificate, with proofs of these claims."""
    every = ", ".join(f"@{name}_holds" for name in names)
    return problem.written() + "".join(map(theorem, names)) + f"\nDefinition all := ({every}).\nPrint Assumptions all.\n"


def verdict(problem: Problem, name: str) -> str:
    """The file of a certificate, with what is found of a claim."""
    return problem.written() + f"Eval vm_compute in found data {name}.\n"


def questions(problem: Problem, most: int, names: list[str]) -> str:
    """The file of a certificate, with what a check of these claims asks for; products of more terms are left out."""
    printing = "Set Printing Depth 1000000.\nSet Printing Width 1000.\n"
    return problem.written() + printing + f"Eval vm_compute in asked {most} data {listed(names)}.\n"
