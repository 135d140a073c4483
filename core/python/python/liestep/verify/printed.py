"""A text in C against the programs that it is written from, expression by expression."""

from __future__ import annotations

import re
from typing import Any

FUNCTION = re.compile(r"^static void (\w+)\(const \w+ \*in, double \*outputs\) \{\n(.*?)^\}$", re.M | re.S)
STATEMENT = re.compile(r"^    (?:const double )?(\w+(?:\[\d+\])?) = (.*);$", re.M)
SIGNS = ("+", "-", "*", "/")
# Names of programs and arrays that are others in C.
PROGRAMS = {"defect": "defect_of"}
ARRAYS = {"half": "y"}


def is_printed(data: dict[str, Any], text: str) -> bool:
    """Whether each program of a certificate but `newton`, which is for other doors, is a function of the text."""
    bodies = {name: STATEMENT.findall(body) for name, body in FUNCTION.findall(text)}
    # All names begin with the declaration's.
    prefix = next((name.removesuffix("constants") for name in bodies if name.endswith("_constants")), "")
    return all(
        is_body(name, program, bodies.get(prefix + PROGRAMS.get(name, name), []), prefix)
        for name, program in data["programs"].items()
        if name != "newton"
    )


def is_body(name: str, program: dict[str, Any], statements: list[tuple[str, str]], prefix: str) -> bool:
    """Whether the outputs are the same expressions. In C more constants may follow, which other functions read."""
    numbers: dict[str, int] = {}

    def number(expression: str) -> int:
        return numbers.setdefault(expression, len(numbers))

    values = [number("in->h" if array == "h" else f"in->{ARRAYS.get(array, array)}[{at}]") for array, at in program["inputs"]]
    values += [number(repr(float(literal))) for literal in program["literals"]]
    for name_of, *registers in program["operations"]:
        values.append(number(operation(name_of, [f"#{values[at]}" for at in registers], prefix)))
    expected = [values[at] for at in program["outputs"]]

    printed: dict[str, int] = {}
    for target, value in statements:
        if target.startswith("outputs"):
            printed[target] = printed.get(value, -1)
            continue
        expression = re.sub(r"\bx\d+\b", lambda register: f"#{printed.get(register[0], -1)}", value)
        try:
            expression = repr(float(expression))
        except ValueError:
            pass
        printed[target] = number(expression)
    found = [printed[target] for target in printed if target.startswith("outputs")]
    return found[: len(expected)] == expected and (name == "constants" or len(found) == len(expected))


def operation(name: str, read: list[str], prefix: str) -> str:
    if name in SIGNS:
        return f"-{read[0]}" if len(read) == 1 else f"{read[0]} {name} {read[1]}"
    family, _, order = name.rpartition("_")
    if family:
        return f"{prefix}{family}({order}, {prefix}{name}, {read[0]})"
    return f"{'log' if name == 'ln' else name}({read[0]})"
