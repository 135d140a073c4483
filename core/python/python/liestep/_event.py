"""Events: what is looked for in a run."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from ._arrays import number
from ._state import matrices
from .errors import SetupError

if TYPE_CHECKING:
    from ._arrays import Array

_EVENT = re.compile(
    r"\s*(?P<of>\w+)\s*(?P<sign>[<>]|=)\s*(?P<value>[-+]?[\d.]+(?:e[-+]?\d+)?)\s*(?P<unit>deg|rad|rpm)?\s*(?P<stop>,\s*stop)?\s*"
)
_UNITS = {None: 1.0, "rad": 1.0, "deg": 0.017453292519943295, "rpm": 0.10471975511965977}


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


def watch(text: Any) -> Watch:
    """An event from its text, or from a function of a `Moment`."""
    if callable(text):
        direction, stops = getattr(text, "direction", 0), bool(getattr(text, "terminal", False))
        return Watch("", _numbers(text), 0.0, (direction > 0) - (direction < 0), stops)
    found = _EVENT.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        raise SetupError(f'{text!r} is no event: write "tilt > 60 deg", "energy < 3", "velocity_x = 0, stop", or a function')
    direction = {">": 1, "<": -1, "=": 0}[found["sign"]]
    return Watch(found["of"], None, float(found["value"]) * _UNITS[found["unit"]], direction, bool(found["stop"]))
