"""Declared texts as expressions of Coq: the checker's own reading, with symbols in the place of its numbers and matrices."""

from __future__ import annotations

import importlib
from fractions import Fraction
from typing import Any, ClassVar

from verify import field


class Node:
    """A constructor and its arguments; equal ones are one."""

    known: ClassVar[dict[tuple[Any, ...], Node]] = {}

    def __init__(self, parts: tuple[Any, ...]) -> None:
        self.parts = parts


def node(*parts: Any) -> Node:
    return Node.known.setdefault(parts, Node(parts))


def number(value: Any) -> Number:
    fraction = Fraction(value)
    return Number(node("Number", fraction.numerator, fraction.denominator))


class Number:
    """An expression of one entry."""

    def __init__(self, node: Node) -> None:
        self.node = node

    @property
    def constant(self) -> Fraction | None:
        return Fraction(*self.node.parts[1:]) if self.node.parts[0] == "Number" else None

    def __add__(self, other: Number) -> Number:
        return other if self.constant == 0 else self if other.constant == 0 else Number(node("Sum", self.node, other.node))

    def __sub__(self, other: Number) -> Number:
        return self if other.constant == 0 else -other if self.constant == 0 else Number(node("Difference", self.node, other.node))

    def __neg__(self) -> Number:
        return self if self.constant == 0 else Number(node("Opposite", self.node))

    def __mul__(self, other: Any) -> Any:
        if not isinstance(other, Number):
            return NotImplemented
        if self.constant == 0 or other.constant == 1:
            return self
        return other if other.constant == 0 or self.constant == 1 else Number(node("Product", self.node, other.node))

    def __truediv__(self, other: Number) -> Number:
        if self.constant is not None and other.constant:
            return number(self.constant / other.constant)
        return self if other.constant == 1 else Number(node("Quotient", self.node, other.node))

    def applied(self, function: str) -> Number:
        return Number(node("At", called(function), self.node))


FUNCTIONS = {"sqrt": "Sqrt", "sin": "Sin", "cos": "Cos", "exp": "Exp", "ln": "Ln", "stumpff": "(Stumpff {})", "log_ratio": "(LogRatio {})"}


def called(function: str) -> str:
    """A function of a program or a text in Coq."""
    family, _, order = function.rpartition("_")
    name = family if order.isdigit() else function
    if name not in FUNCTIONS:
        raise field.Declined(f"there is no rule for the function {function}")
    return FUNCTIONS[name].format(order)


class Entries(list[Number]):
    """The entries of a matrix, row by row."""

    matrix: Matrix


class Matrix:
    """An expression of more entries."""

    def __init__(self, rows: Any = (), node: Node | None = None, shape: tuple[int, int] = (0, 0)) -> None:
        self.back: Matrix | None = None
        if node is not None:
            self.node, self.shape = node, shape
            return
        grid = [list(row) for row in rows]
        self.shape = len(grid), len(grid[0])
        self.node = joined("Above", [joined("Beside", [entry.node for entry in row]) for row in grid])

    @staticmethod
    def of(entries: Any, columns: int) -> Matrix:
        return Matrix(entries[at : at + columns] for at in range(0, len(entries), columns))

    @staticmethod
    def one(size: int) -> Matrix:
        return Matrix([number(int(i == j)) for j in range(size)] for i in range(size))

    @property
    def rows(self) -> list[list[Number]]:
        return [[Number(node("Entry", i, j, self.node)) for j in range(self.shape[1])] for i in range(self.shape[0])]

    @property
    def flat(self) -> Entries:
        found = Entries(entry for row in self.rows for entry in row)
        found.matrix = self
        return found

    def like(self, *parts: Any) -> Matrix:
        return Matrix(node=node(*parts), shape=self.shape)

    def __add__(self, other: Matrix) -> Matrix:
        if self.shape != other.shape:
            raise field.Declined(f"a sum of {self.shape} and {other.shape}")
        return self.like("Sum", self.node, other.node)

    def __sub__(self, other: Matrix) -> Matrix:
        return self.like("Difference", self.node, other.node)

    def __neg__(self) -> Matrix:
        return self.like("Opposite", self.node)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Number):
            return self if other.constant == 1 else self.like("Scaled", other.node, self.node)
        if not isinstance(other, Matrix):
            return NotImplemented
        if self.shape[1] != other.shape[0]:
            raise field.Declined(f"a product of {self.shape} and {other.shape}")
        return Matrix(node=node("Product", self.node, other.node), shape=(self.shape[0], other.shape[1]))

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> Matrix:
        return self.like("Quotient", self.node, other.node)

    @property
    def turned(self) -> Matrix:
        return Matrix(node=node("Turned", self.node), shape=(self.shape[1], self.shape[0]))

    @property
    def trace(self) -> Number:
        return Number(node("Trace", self.node))

    @property
    def inverse(self) -> Matrix:
        return self.back or self.like("Inverse", self.node)

    def solved(self, right: Matrix) -> Matrix:
        return self.inverse * right


def joined(name: str, nodes: list[Node]) -> Node:
    found = nodes[-1]
    for one in reversed(nodes[:-1]):
        found = node(name, one, found)
    return found


def dot(left: Any, right: Any) -> Number:
    if isinstance(left, Entries) and isinstance(right, Entries):
        return (left.matrix.turned * right.matrix).trace
    found = number(0)
    for a, b in zip(left, right, strict=True):
        found = found + a * b
    return found


def written(last: Node, names: int = 0) -> str:
    """An expression in Coq; what it has several times is bound first, and stands in front of the names."""
    count: dict[Node, int] = {}
    shared: list[Node] = []

    def counted(node: Node) -> None:
        count[node] = count.get(node, 0) + 1
        if count[node] == 1:
            for part in node.parts:
                if isinstance(part, Node):
                    counted(part)
            shared.append(node)

    counted(last)
    shared = [node for node in shared if count[node] > 1 and node.parts[0] not in ("Number", "Name")]
    place = {node: at for at, node in enumerate(shared)}

    def text(node: Node, depth: int) -> str:
        return f"(Name {depth - 1 - place[node]})" if place.get(node, depth) < depth else whole(node, depth)

    def whole(node: Node, depth: int) -> str:
        name, *parts = node.parts
        if name == "Name":
            parts = [parts[0] + depth]
        return "(" + " ".join([name, *(text(part, depth) if isinstance(part, Node) else signed(part) for part in parts)]) + ")"

    found = text(last, len(shared))
    for depth in reversed(range(len(shared))):
        found = f"(Let {whole(shared[depth], depth)}\n    {found})"
    return found


def signed(value: Any) -> str:
    return f"({value})" if isinstance(value, int) and value < 0 else str(value)


def column(entries: Any) -> Matrix:
    return Matrix([entry] for entry in entries)


def total(numbers: Any) -> Number:
    return sum(numbers, number(0))


field.Dual, field.Matrix, field.number, field.dot, field.column, field.total = Number, Matrix, number, dot, column, total  # type: ignore[assignment,misc]
field.ZERO, field.ONE, field.HALF = number(0), number(1), number(Fraction(1, 2))  # type: ignore[assignment]
motion = [importlib.reload(importlib.import_module(f"verify.{room}")) for room in ("text", "motion")][1]
