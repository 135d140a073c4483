"""Numbers and texts that are given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from .errors import DeclarationError, Error, SetupError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def floats(name: str, value: Any, error: type[Error]) -> Array:
    """An array of real numbers, none of them hidden: no text, complex number, masked one or nothing is taken for one."""
    import numpy as np

    try:
        array = np.asanyarray(value)
        is_plain = array.dtype.kind in "biuf"
        if np.iscomplexobj(array) or isinstance(array, np.ma.MaskedArray):
            raise error(f"`{name}` is an array of real numbers, neither complex nor masked")
        if is_plain or array.dtype.kind == "O" and all(map(_is_real, array.flat)):
            return np.asarray(array, dtype=float)
        raise TypeError
    except Exception as cause:
        if isinstance(cause, Error):
            raise
        raise error(f"`{name}` is a number, a vector or a matrix of numbers, not {shown(value)}") from cause


def shown(value: Any, by: Callable[[Any], str] = repr) -> str:
    """An object in a message, in 80 letters at most; the name of its type where it has no text."""
    try:
        return by(value)[:80]
    except Exception:
        return f"an object of the type {type(value).__name__}"


def by_names(name: str, values: Any) -> Mapping[str, Any]:
    """Values by their names; nothing where none are given."""
    if values is None or isinstance(values, Mapping):
        return values or {}
    raise SetupError(f"`{name}` has values by their names, as {{\"velocity\": …}}, and isn't {shown(values)}")


def listed(name: str, values: Any) -> list[str]:
    """Names: one text, or several."""
    try:
        return [text(name, one) for one in ([values] if isinstance(values, str) else values)]
    except Exception as cause:
        if isinstance(cause, Error):
            raise
        raise SetupError(f"`{name}` is a name, or a list of some, not {shown(values)}") from cause


def _is_real(one: Any) -> bool:
    """Whether an object, such as a fraction, is a real number."""
    return hasattr(one, "__float__") and not isinstance(one, complex)


def number(name: str, value: Any) -> float:
    """One real number."""
    array = floats(name, value, SetupError)
    if array.shape != ():
        raise SetupError(f"`{name}` is a number, not an array of the shape {array.shape}")
    return float(array)


def vector(name: str, value: Any) -> list[float]:
    """A list of real numbers."""
    import numpy as np

    if type(value) is np.ndarray and value.dtype == float and value.ndim == 1:
        own: list[float] = value.tolist()
        return own
    array = floats(name, value, SetupError)
    if array.ndim != 1:
        raise SetupError(f"`{name}` is a list of numbers, not an array of the shape {array.shape}")
    numbers: list[float] = array.tolist()
    return numbers


def whole(name: str, value: Any, least: int, most: int) -> int:
    """A whole number between two."""
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise SetupError(f"`{name}` is a whole number from {least} to {most:g}, not {shown(value)}")
    return value


def text(name: str, value: Any) -> str:
    """A text."""
    if not isinstance(value, str):
        raise DeclarationError(f"`{name}` is a text, not {shown(value)}")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise DeclarationError(f"`{name}` is a text, and {value!a:.80} has half of a character") from None
    return value
