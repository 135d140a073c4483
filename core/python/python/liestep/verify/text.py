"""The reading of a declared text, as a function of the increment and of what is carried along."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from fractions import Fraction
from typing import Any, NamedTuple

from .field import HALF, ONE, Declined, Dual, Matrix, column, cross_matrix, dot, logarithm, number, turn, vee

TOKEN = re.compile(
    r"\s+|//[^\n]*|/\*.*?\*/|(?P<number>\d[\d_]*(?:\.\d[\d_]*)?(?:[eE][+-]?\d+)?(?:_?f(?:64|32))?)"
    r"|(?P<name>(?:r#)?[^\W\d]\w*(?:\s*::\s*[^\W\d]\w*)*)|(?P<sign>\"(?:[^\"\\\\]|\\\\.)*\"|.)",
    re.S,
)


def tokens(text: str) -> list[str]:
    found = (match for match in TOKEN.finditer(text) if match.lastgroup)
    return [re.sub(r"\s|^r#", "", match[0]) for match in found]


def long_decimals(text: str) -> list[Fraction]:
    """The decimals of a text with more than six digits behind the point."""
    return [Fraction(token) for token in tokens(text) if re.fullmatch(r"\d+\.\d{7,}", token)]


def behind(given: list[str], at: int) -> int:
    """The place behind the bracket that opens at this one."""
    depth = 0
    for place in range(at, len(given)):
        depth += (given[place] in "([{") - (given[place] in ")]}")
        if depth == 0:
            return place + 1
    raise Declined("a bracket isn't closed")


def parts(given: list[str], angles: bool = False) -> list[list[str]]:
    """The parts between commas, outside of all brackets."""
    found, depth = [[]], 0  # type: tuple[list[list[str]], int]
    for token in given:
        depth += (token in "([{" or angles and token == "<") - (token in ")]}" or angles and token == ">")
        if token == "," and depth == 0:
            found.append([])
        else:
            found[-1].append(token)
    return [part for part in found if part]


# Expressions


class Parser:
    """An expression of Rust as nested tuples, by its tokens."""

    def __init__(self, given: list[str]) -> None:
        self.given, self.at = given, 0

    def next(self) -> str:
        return self.given[self.at] if self.at < len(self.given) else ""

    def take(self, *expected: str) -> str:
        token = self.next()
        if expected and token not in expected:
            raise Declined(f"{token!r} instead of {' or '.join(expected)!r}")
        self.at += 1
        return token

    def skipped(self, end: tuple[str, ...]) -> None:
        """Skips a type."""
        depth = 0
        while depth or self.next() not in end:
            token = self.take()
            depth += (token in "<([") - (token in ">)]")

    def whole(self) -> Any:
        found = self.sum()
        if self.next():
            raise Declined(f"{self.next()!r} behind an expression")
        return found

    def sum(self) -> Any:
        found = self.term()
        while self.next() in ("+", "-"):
            found = (self.take(), found, self.term())
        return found

    def term(self) -> Any:
        found = self.factor()
        while self.next() in ("*", "/"):
            found = (self.take(), found, self.factor())
        return found

    def factor(self) -> Any:
        if self.next() in ("&", "*"):
            self.take()
            return self.factor()
        if self.next() == "-":
            self.take()
            return ("negative", self.factor())
        found = self.primary()
        while self.next() in (".", "[", "("):
            match self.take():
                case "(":
                    found = ("call", found, self.list(")"))
                case "[":
                    found = ("index", found, self.list("]"))
                case _:
                    name = self.take()
                    called = self.next() == "(" and bool(self.take("("))
                    found = ("method", name, found, self.list(")")) if called else ("method", name, found, [])
        return found

    def list(self, end: str) -> list[Any]:
        found = []
        while self.next() != end:
            found.append(self.sum())
            if self.next() != end:
                self.take(",")
        self.take(end)
        return found

    def primary(self) -> Any:
        token = self.take()
        if token == "(":
            inner = self.list(")")
            return inner[0] if len(inner) == 1 else ("tuple", inner)
        if token == "{":
            return self.block()
        if token == "|":
            names = []
            while self.next() != "|":
                names.append(self.take())
                if self.next() == ":":
                    self.skipped((",", "|"))
                if self.next() == ",":
                    self.take()
            self.take("|")
            return ("function", names, self.sum())
        if token[:1].isdigit():
            return ("number", Fraction(re.sub(r"_|f(64|32)$", "", token)))
        if re.match(r"[^\W\d]", token):
            return ("name", token)
        raise Declined(f"{token!r} in an expression")

    def block(self) -> Any:
        bound = []
        while self.next() == "let":
            self.take()
            name = self.take()
            if self.next() == ":":
                self.skipped(("=",))
            self.take("=")
            bound.append((name, self.sum()))
            self.take(";")
        found = ("block", bound, self.sum())
        self.take("}")
        return found


class Chord:
    """The velocity (F − I)/h, which is a matrix near the algebra of rotations and not in it."""

    def __init__(self, matrix: Matrix) -> None:
        self.matrix = matrix

    def __rmul__(self, inertia: Matrix) -> tuple[Matrix, Chord]:
        return inertia, self

    def dot(self, other: Any) -> Dual:
        if isinstance(other, Matrix):
            return dot(vee(self.matrix).flat, other.flat)
        inertia = other[0] if isinstance(other, tuple) else Matrix.one(3)
        if isinstance(other, tuple) and other[1] is not self or isinstance(other, Chord) and other is not self:
            raise Declined("two chords")
        weight = Matrix.one(3) * (inertia.trace * HALF) - inertia
        return (self.matrix * weight * self.matrix.turned).trace


def valued(tree: Any, names: dict[str, Any], hat: Callable[[Matrix], Matrix]) -> Any:
    """The value of an expression."""

    def of(inner: Any) -> Any:
        return valued(inner, names, hat)

    match tree:
        case ("number", value):
            return number(value)
        case ("name", name):
            if name not in names:
                raise Declined(f"the name {name}")
            return names[name]
        case ("negative", inner):
            return -of(inner)
        case ("+", a, b):
            return of(a) + of(b)
        case ("-", a, b):
            return of(a) - of(b)
        case ("*", a, b):
            return of(a) * of(b)
        case ("/", a, b):
            return of(a) / of(b)
        case ("block", bound, end):
            inside = dict(names)
            for name, inner in bound:
                inside[name] = valued(inner, inside, hat)
            return valued(end, inside, hat)
        case ("function", parameters, body):
            return lambda *given: valued(body, names | dict(zip(parameters, given, strict=True)), hat)
        case ("index", inner, [("tuple", [("number", row), ("number", place)])]):
            return of(inner).rows[int(row)][int(place)]
        case ("index", inner, [("number", at)]):
            return of(inner).flat[int(at)]
        case ("method", name, inner, given):
            return method(name, of(inner), given, of)
        case ("call", ("name", name), given):
            return called(name, [of(one) for one in given], names, hat)
    raise Declined(f"{tree[0]!r} in an expression")


def called(name: str, given: list[Any], names: dict[str, Any], hat: Callable[[Matrix], Matrix]) -> Any:
    if name in names:
        return names[name](*given)
    if re.search(r"Vector\d::new$", name):
        return column(given)
    match name:
        case "hat":
            return given[0].matrix if isinstance(given[0], Chord) else hat(given[0])
        case "vee":
            return vee(given[0])
        case "log":
            return logarithm(given[0])
        case "exp":
            return turn(given[0])
        case "inverse":
            return given[0].inverse
    raise Declined(f"the function {name}")


def method(name: str, value: Any, given: list[Any], of: Callable[[Any], Any]) -> Any:
    if name == "powi":
        exponent = given[0]
        sign = -1 if exponent[0] == "negative" else 1
        exponent, found = exponent[1] if sign < 0 else exponent, ONE
        for _ in range(int(exponent[1])):
            found = found * value
        return found if sign > 0 else ONE / found
    match name, [of(one) for one in given]:
        case "x" | "y" | "z" | "w", []:
            return value.flat["xyzw".index(name)]
        case "transpose", []:
            return value.turned
        case "trace", []:
            return value.trace
        case "dot", [other]:
            if isinstance(value, Chord) or isinstance(other, Chord):
                return value.dot(other) if isinstance(value, Chord) else other.dot(value)
            return dot(value.flat, other.flat)
        case "norm_squared", []:
            return value.dot(value) if isinstance(value, Chord) else dot(value.flat, value.flat)
        case "norm", []:
            return dot(value.flat, value.flat).applied("sqrt")
        case "cross", [other]:
            return cross_matrix(value) * other
        case "cross_matrix", []:
            return cross_matrix(value)
        case "component_mul", [other]:
            return column(a * b for a, b in zip(value.flat, other.flat, strict=True))
        case "sqrt" | "ln" | "exp" | "sin" | "cos", []:
            return value.applied(name)
        case "clone", []:
            return value
    raise Declined(f"the method {name}")


# Declarations


class Field(NamedTuple):
    """A field of the struct: the base and the size of its type."""

    name: str
    base: str
    size: int


KINDS = {"NonstandardInertia": "symmetric", "Inertia": "symmetric", "DiagonalNonstandardInertia": "diagonal"}


def field(given: list[str]) -> Field:
    at = given.index(":")
    name, kind = given[at - 1], given[at + 1].rpartition("::")[2]
    sizes = [int(token) for token in given[at + 2 :] if token.isdigit()]
    if kind in KINDS or kind in ("f64", "f32", "T"):
        return Field(name, kind, 3)
    base, size = re.fullmatch(r"(.*?)(\d?)", kind).groups()  # type: ignore[union-attr]
    return Field(name, base, int(size) if size else sizes[0])


class Declaration:
    """A text: its arguments, and its fields."""

    def __init__(self, text: str) -> None:
        given, at, found = tokens(text), 0, None
        while given[at] != "struct":
            if given[at] == "#":
                end = behind(given, at + 1)
                name = given[at + 2].rpartition("::")[2]
                if name in ("lagrangian", "force"):
                    found = parts(given[at + 4 : end - 2])
                at = end
            else:
                at += 1
        if found is None:
            raise Declined("there is neither `lagrangian` nor `force`")
        self.arguments = {part[0]: part[1:] for part in found if len(part) > 1}
        rest = given[at:]
        fields = rest[rest.index("{") + 1 : behind(rest, rest.index("{")) - 1] if "{" in rest else []
        self.fields = [field(without_attributes(part)) for part in parts(fields, angles=True)]
        expressions = {key: self.arguments[key][1:] for key in ("l_d", "l", "work", "pace") if key in self.arguments}
        self.expressions: dict[str, Any] = {key: Parser(given).whole() for key, given in expressions.items()}

    def list(self, key: str) -> list[list[str]]:
        """The parts of `key(…)`, or the one of `key = …`."""
        given = self.arguments.get(key, [])
        if given[:1] == ["("]:
            return parts(given[1:-1])
        return [given[1:]] if given else []

    def generators(self, group: str) -> Any:
        """The matrices of a group of one's own, by its name where several stand in the text."""
        given = self.arguments.get("generators", [])
        named = {part[0]: part[2:] for part in self.list("generators")} if given[:1] == ["("] else {group: given[1:]}
        own = named.get(group)
        return json.loads("".join(own).replace(".]", ".0]").replace(".,", ".0,")) if own else None


def without_attributes(given: list[str]) -> list[str]:
    while given[:1] == ["#"]:
        given = given[behind(given, 1) :]
    return given
