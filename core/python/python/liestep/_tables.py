"""A scene's tables as the text of a file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from ._arrays import floats, shown
from ._signal import Signal
from .errors import SceneError

#: Largest number of tables in each other.
DEEPEST = 16


def written(tables: Mapping[str, Any]) -> str:
    """The text of these tables: a key of the file on each line, and below it each table of several."""
    lines = []
    for key, value in tables.items():
        if isinstance(value, (list, tuple)) and any(isinstance(one, Mapping) for one in value):
            each = "".join(f"  {_value(str(key), one, 1)},\n" for one in value)
            lines.append(f"{_text(key)} = [\n{each}]\n")
        else:
            lines.append(f"{_text(key)} = {_value(str(key), value, 1)}\n")
    return "".join(lines)


def _text(text: Any) -> str:
    if not isinstance(text, str):
        raise SceneError(f"keys of a scene are texts, not {shown(text)}")
    try:
        text.encode()
    except UnicodeEncodeError:
        raise SceneError(f"{text!a:.80} is no text") from None
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(name: str, value: Any, depth: int) -> str:
    if depth > DEEPEST:
        raise SceneError(f"`{name}` has tables in tables without an end")
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise SceneError(f"`{name}` is a number, not {shown(value)}")
        return str(value)
    if isinstance(value, Signal):
        return _value(name, value.table(), depth)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_text(key)} = {_value(f'{name}.{key}', one, depth + 1)}" for key, one in value.items()) + " }"
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray, memoryview)):
        return "[" + ", ".join(_value(name, one, depth + 1) for one in value) + "]"
    numbers = floats(name, value, SceneError)
    return repr(numbers.tolist())
