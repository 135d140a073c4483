"""Events of a run, by texts and by functions."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _native
from ._arrays import number, shown
from ._state import matrices
from .errors import SetupError

if TYPE_CHECKING:
    from ._arrays import Array

_EVENT = re.compile(
    r"\s*(?P<of>\w+)\s*(?P<sign>[<>]|=)\s*(?P<value>[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*"
    r"(?P<unit>[^\W\d][^,]*?)?\s*(?P<stop>,\s*stop)?\s*"
)
#: SI units of quantities, by the first word of their names.
_SI = {"tilt": ("rad",), "speed": ("rad/s",), "velocity": ("rad/s", "m/s"), "momentum": ("kg m²/s",), "energy": ("J",)}


@dataclass
class Watch:
    """An event as Rust takes it."""

    quantity: str
    function: Callable[..., float] | None
    value: float
    direction: int
    stops: bool


class Moment(NamedTuple):
    """A motion at one time, as a function of `events` sees it: `liestep.Stepper.run`.

    Attributes
    ----------
    time : float
        The time since the start, s.
    attitude
        As `State.attitude`: a matrix, body to space; on a product a list of matrices.
    velocity, momentum : array
        In the axes of the body.
    energy : float
        J.
    """

    time: float
    attitude: Any
    velocity: Array
    momentum: Array
    energy: float


def _numbers(function: Callable[[Moment], Any]) -> Callable[..., float]:
    """A function of a `Moment` as one of its numbers."""
    def called(
        time: float, attitude: list[float], rows: list[int], velocity: list[float], momentum: list[float], energy: float
    ) -> float:
        import numpy as np

        moment = Moment(time, matrices(attitude, rows), np.array(velocity), np.array(momentum), energy)
        return number("event", function(moment))

    return called


def _size(quantity: str, unit: str | None) -> float:
    """The size of a quantity's unit in that of SI."""
    if unit is None:
        return 1.0
    known = _SI.get(quantity.split("_")[0], ())
    sizes = [size for one in known if (size := _native.ratio(unit, one)) is not None]
    if not sizes:
        raise SetupError(f"`{quantity}` isn't in `{unit}`" + (f" but in `{known[0]}`" if known else ": leave the unit out"))
    return sizes[0]


def watch(text: Any) -> Watch:
    """An event from its text, or from a function of a `Moment`."""
    if callable(text):
        direction, stops = getattr(text, "direction", 0), bool(getattr(text, "terminal", False))
        return Watch("", _numbers(text), 0.0, (direction > 0) - (direction < 0), stops)
    found = _EVENT.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        raise SetupError(f'{shown(text)} is no event: write "tilt > 60 deg", "energy < 3", "velocity_x = 0, stop", or a function')
    direction = {">": 1, "<": -1, "=": 0}[found["sign"]]
    return Watch(found["of"], None, float(found["value"]) * _size(found["of"], found["unit"]), direction, bool(found["stop"]))
