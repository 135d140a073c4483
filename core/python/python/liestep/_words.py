"""Messages of the derivation and of steps in the words of Python: parameters in the place of fields."""

from __future__ import annotations

import re

#: Words about programs, and those of Python in their place.
WORDS = [
    ("declare what changes with it by `given(u = field)`, and go on by `step_with`", "pass what changes with it as a `ls.signal`"),
    ("declare it with `advected({} = field)`, where the field holds", 'declare it with `advected={{"{}": "up"}}`, where `up` holds'),
    ("make it a field of the struct", "pass it by its name"),
    ("make this matrix a field", "pass this matrix by a name"),
    ("it is no real number: make it a field", "it is no real number: pass it by its name"),
    ("if `{}` is the diagonal of a matrix, give the matrix", "if `{0}` is the diagonal of a matrix, pass `{0}=np.diag({0})`"),
    ("remove the field, or use it", "leave it out, or use it"),
    ("a field of the struct", "a parameter"),
    ("the struct has no field", "there is no parameter"),
    ("give it the type `NonstandardInertia` or `Inertia`", "give it a name that begins with `J`"),
    ("give it the type `NonstandardInertia`", "give it a name that ends in `_d`"),
    ("give it the type `Inertia`", "give it a name that doesn't end in `_d`, and the moments of inertia themselves"),
    (" of the struct", ""),
    ("write the word `gradients` into the declaration, of each term", "there are none in Python"),
    ("let `or_substeps` divide such steps", "let `substeps` divide such steps"),
    ("the kinetic part of `GeodesicBody` turns", '`ls.body(J, kinetic="geodesic")` turns'),
    ("and that of `CayleyBody` has", 'and `kinetic="cayley"` has'),
]

#: Types of fields, and the values of Python in their place; the number is that of the rows.
TYPES = {
    "ContravariantVector": "`ls.contravariant` of {} numbers",
    "ContravariantTensor": "`ls.contravariant` of a matrix of {} rows",
    "CovariantTensor": "`ls.covariant` of a matrix of {} rows",
    "MixedTensor": "`ls.mixed` of a matrix of {} rows",
    "SVector": "a list of {} numbers", "Vector": "a list of {} numbers", "Point": "`ls.point` of {} numbers",
    "SMatrix": "a matrix of {} rows", "Matrix": "a matrix of {} rows",
}

_WORDS = [(re.compile(re.escape(old).replace(r"\{\}", r"(\w+)")), new) for old, new in WORDS]
_TYPE = re.compile(rf"\b({'|'.join(TYPES)})(\d*)<f64(?:, (\d+))?[^>`]*>")


def in_python(message: str) -> str:
    """A message in the words of Python."""
    for old, new in _WORDS:
        for found in old.finditer(message):
            message = message.replace(found[0], new.format(*found.groups()) if found.groups() else new)
    # Every second part is code.
    parts = re.split("`", message)
    return "`".join(_code(part) if number % 2 else _text(part) for number, part in enumerate(parts))


def _text(text: str) -> str:
    text = _TYPE.sub(lambda found: TYPES[found[1]].format(found[2] or found[3]), text)
    return re.sub(r"\bfield(s?)\b", r"parameter\1", text)


def _code(code: str) -> str:
    """An argument of a declaration as one of Python: `group(F = SO3)` as `group={"F": "SO3"}`."""
    if found := re.fullmatch(r"(group|discretise|velocity|pace) = (.+)", code):
        return f'{found[1]}="{found[2]}"'
    if found := re.fullmatch(r"(velocity|displacement)\((.+)\)", code):
        return f'{found[1]}="{found[2]}"'
    if found := re.fullmatch(r"generators\((\w+) = (.+)\)", code):
        return f'generators={{"{found[1]}": {found[2]}}}'
    if found := re.fullmatch(r"(group|advected)\((.+ = .+)\)", code):
        pairs = (pair.split(" = ", 1) for pair in found[2].split(", "))
        return f"{found[1]}={{{', '.join(f'{chr(34)}{name}{chr(34)}: {chr(34)}{value}{chr(34)}' for name, value in pairs)}}}"
    return re.sub(r"&(?=[\w(])", "", code)
