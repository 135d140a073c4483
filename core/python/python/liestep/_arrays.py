"""Numbers that are given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .errors import Error

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def floats(name: str, value: Any, error: type[Error]) -> Array:
    """An array of real numbers, none of them hidden: neither complex nor masked ones are taken for real ones."""
    import numpy as np

    try:
        array = np.asanyarray(value)
        if np.iscomplexobj(array) or isinstance(array, np.ma.MaskedArray):
            raise error(f"`{name}` is an array of real numbers, neither complex nor masked")
        return np.asarray(array, dtype=float)
    except (TypeError, ValueError, OverflowError) as cause:
        if isinstance(cause, Error):
            raise
        raise error(f"`{name}` is a number, a vector or a matrix of numbers, not {value!r:.80}") from cause
