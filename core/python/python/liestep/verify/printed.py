"""A text in C against the programs that it is written from, statement by statement."""

from __future__ import annotations

import re
from typing import Any

FUNCTION = re.compile(r"^static void (\w+)\(const Inputs \*in, double \*outputs\) \{\n(.*?)^\}$", re.M | re.S)
STATEMENT = re.compile(r"^    (?:const double )?(\w+(?:\[\d+\])?) = (.*);$", re.M)
SIGNS = ("+", "-", "*", "/")


def is_printed(data: dict[str, Any], text: str) -> bool:
    """Whether each program of a certificate but `newton`, which is for other doors, is a function of the text."""
    bodies = {name: STATEMENT.findall(body) for name, body in FUNCTION.findall(text)}
    programs = {name: program for name, program in data["programs"].items() if name != "newton"}
    return all(is_body(program, bodies.get(name, [])) for name, program in programs.items())


def is_body(program: dict[str, Any], statements: list[tuple[str, str]]) -> bool:
    expected: list[Any] = ["in->h" if array == "h" else f"in->{array}[{at}]" for array, at in program["inputs"]]
    literals = range(len(expected), len(expected) + len(program["literals"]))
    expected += [*program["literals"], *map(operation, program["operations"])]
    names = [f"x{at}" for at in range(len(expected))] + [f"outputs[{at}]" for at in range(len(program["outputs"]))]
    expected += [f"x{at}" for at in program["outputs"]]
    found = [float(value) if at in literals else value for at, (_, value) in enumerate(statements)]
    return [name for name, _ in statements] == names and found == expected


def operation(given: list[Any]) -> str:
    name, *registers = given
    read = [f"x{at}" for at in registers]
    if name in SIGNS:
        return f"-{read[0]}" if len(read) == 1 else f"{read[0]} {name} {read[1]}"
    family, _, order = name.rpartition("_")
    if family:
        return f"{family}({order}, {name}, {read[0]})"
    return f"{'log' if name == 'ln' else name}({read[0]})"
