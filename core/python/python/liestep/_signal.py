"""Signals: parameters that change with time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import floats, shown
from .errors import SceneError, SetupError

if TYPE_CHECKING:
    from ._arrays import Array


class Signal:
    """A quantity over time, made by `liestep.signal`: a value for any parameter of a term.

    Attributes
    ----------
    shape : tuple of int
        That of a value: ``()`` of a number, ``(3,)`` of a vector.
    """

    def __init__(self, times: Any, values: Any, between: str | None) -> None:
        self._source: tuple[Any, ...] = (times, values, between)
        self._native: _native.Signal | _native.Along | None = None
        if between is None:
            self.shape: tuple[int, ...] = self._called([0.0]).shape[1:]
        elif between == "orbit":
            self.shape = () if values[0] == "distance" else (3,)
            self._native = _native.Along(times._native, *values)
        else:
            self.shape = values.shape[1:]
            self._native = _native.Signal(times.tolist(), values.ravel().tolist(), between == "lines")

    @property
    def ends(self) -> tuple[float, float]:
        """The first time with a value, and the last one, s; infinite where there is no end."""
        if not isinstance(self._native, _native.Signal):
            return -float("inf"), float("inf")
        first, last = self._native.ends
        return first, last

    def at(self, times: Any) -> Array:
        """The values at times, s, a row for each; NaN where there are none."""
        asked = floats("times", times, SetupError)
        flat: list[float] = asked.ravel().tolist()
        values = self._called(flat) if self._native is None else floats("values", self._native.at(flat), SetupError)
        return values.reshape(asked.shape + self.shape)

    def _called(self, times: list[float]) -> Array:
        """The values of a function."""
        import numpy as np

        values = floats("values of a signal", self._source[1](np.array(times)), SetupError)
        if values.shape[:1] != (len(times),) or values.shape[1:] != getattr(self, "shape", values.shape[1:]):
            raise SetupError(f"a signal's function returns a value for each of {len(times)} times, not the shape {values.shape}")
        if not np.isfinite(values).all():
            raise SetupError(f"a signal's function returns finite values, and not so from {times[0]:g} s on")
        return values

    def mapped(self, function: Callable[[Array], Array]) -> Signal:
        """A signal of a linear function of all values."""
        times, values, between = self._source
        if between == "orbit":
            raise SetupError(f"{self!r} is no inertia")
        return Signal(times, _Composition(function, values) if between is None else floats("values", function(values), SetupError), between)

    @property
    def first(self) -> Array:
        """The value at the start, or the one that is next to it."""
        first, last = self.ends
        return self.at(min(max(0.0, first), last))

    @property
    def has_unit_values(self) -> bool:
        """Whether its values are of length one up to rounding; those of a function are looked at where they are taken."""
        import numpy as np

        if self._source[2] is None:
            return True
        if self._source[2] == "orbit":
            return bool(self._source[1][0] == "nadir")
        lengths = np.linalg.norm(self._source[1].reshape(len(self._source[0]), -1), axis=1)
        return bool((abs(lengths - 1) <= _native.OFF_UNIT).all())

    @property
    def source(self) -> _native.Signal | _native.Along | Callable[[list[float]], list[float]]:
        """The signal as Rust takes it: its own, or a function of times that returns the numbers of all values."""
        return self._numbers if self._native is None else self._native

    @property
    def is_function(self) -> bool:
        """Whether a function of Python returns the values."""
        return self._native is None

    def table(self) -> dict[str, Any]:
        """The signal as a scene's file has it."""
        times, values, between = self._source
        if not isinstance(between, str) or between not in ("steps", "lines"):
            raise SceneError("a file has signals by values: write `ls.signal(times, function, between=…)`")
        return {"times": times, "values": values, "between": between}

    def _numbers(self, times: list[float]) -> list[float]:
        numbers: list[float] = self._called(times).ravel().tolist()
        return numbers

    def key(self) -> tuple[Any, ...]:
        """The key that tells this signal from others."""
        times, values, between = self._source
        is_table = between in ("steps", "lines")
        return (times.tobytes(), values.tobytes(), values.shape, between) if is_table else self._source

    def __eq__(self, other: object) -> bool:
        return self.key() == other.key() if isinstance(other, Signal) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.key())

    def __reduce__(self) -> tuple[Any, ...]:
        return Signal, self._source

    def __repr__(self) -> str:
        if self._native is None:
            return f"<Signal by {self._source[1]!r}>"
        if self._source[2] == "orbit":
            return f"<Signal of {self._source[1][0]} along {self._source[0]!r}>"
        return f"<Signal of {len(self._source[0])} values by {self._source[2]} from {self.ends[0]:g} s to {self.ends[1]:g} s>"


class _Composition:
    """A function after another."""

    def __init__(self, last: Callable[[Array], Array], first: Callable[[Array], Any]) -> None:
        self._functions = last, first

    def __call__(self, times: Array) -> Array:
        last, first = self._functions
        return last(floats("values of a signal", first(times), SetupError))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Composition) and self._functions == other._functions

    def __hash__(self) -> int:
        return hash(self._functions)

    def __repr__(self) -> str:
        return repr(self._functions[1])


def signal(times: Any, values: Any = None, *, between: str | None = None) -> Signal:
    """A quantity over time, as a parameter of a term: a torque that is switched, a field that turns, a mass that is lost.

    A step has the mean of such a parameter over its length, which is exact by values: a force has its impulse wherever its
    corners lie between steps. In a composition each stage has that of its own time, so that the order of the method stays where
    the values are smooth. A state has the values of its own time, and so have its energy and its velocity. Time is that since
    the start, s. Signals are beside the declared step and a ``composition``.

    Parameters
    ----------
    times : array_like or callable
        Increasing times, s; or instead of times and values a function of an array of times that returns a value for each, and is
        called for the middle and the end of each stage.
    values : array_like or callable
        A value for each time: a number, a vector or a matrix; or a function that returns them for all `times` at once.
    between : {"steps", "lines"}
        A value holds until the next time, and the last one on; or values lie on straight lines, and end with the last time.

    Returns
    -------
    Signal

    Raises
    ------
    SetupError
        Times that don't increase, values that aren't as many, or aren't finite.

    Examples
    --------
    A torque from 0.7 s to 2.2 s has its impulse by steps of 0.4 s, too.

    >>> import liestep as ls
    >>> push = ls.signal([0, 0.7, 2.2], [[0, 0, 0], [0, 0, 2], [0, 0, 0]], between="steps")
    >>> run = (ls.body([3, 3, 4]) + ls.torque(push)).stepper(0.4).run(velocity=[0, 0, 1], until=4)
    >>> round(float(run.momentum[-1, 2]), 12)
    7.0

    An oscillator that is damped as its energies grow, by Caldirola and Kanai:

    >>> import numpy as np
    >>> grows = ls.signal(lambda t: np.exp(0.2 * t))
    >>> damped = ls.lagrangian("R1", velocity="v", advected={"p": "fixed"}, discretise="trapezoid(Cayley)",
    ...     l="c * (v[0].powi(2) - 4.0 * p[0].powi(2)) / 2.0", c=grows, fixed=ls.point([0.0]))
    >>> run = damped.stepper(0.01, composition="Suzuki 4").run(attitude=ls.translation([1.0]), velocity=[0], until=5)
    >>> rate = 3.99 ** 0.5
    >>> bool(abs(run["x"][-1] - np.exp(-0.5) * (np.cos(5 * rate) + 0.1 / rate * np.sin(5 * rate))) < 1e-8)
    True
    """
    if callable(times) and values is None and between is None:
        return Signal(None, times, None)
    if callable(times):
        raise SetupError("a signal is a function of an array of times alone, or has `times`, `values` and `between`")
    if not isinstance(between, str) or between not in ("steps", "lines"):
        raise SetupError(f'`between` is "steps", where a value holds, or "lines", not {shown(between)}')
    asked = floats("times", times, SetupError)
    if asked.ndim != 1:
        raise SetupError(f"`times` is a list of times, not an array of the shape {asked.shape}")
    given = floats("values", values(asked.copy()) if callable(values) else values, SetupError)
    if given.ndim == 0 or len(given) != len(asked):
        raise SetupError(f"a signal has a value for each of {len(asked)} times, and `values` have the shape {given.shape}")
    return Signal(asked.copy(), given.copy(), between)


def diagonal(moments: Array) -> Array:
    """The matrices of these rows of moments."""
    import numpy as np

    return moments[..., None] * np.eye(moments.shape[-1])


def reach(signals: Mapping[str, Signal], until: float) -> None:
    """Checks that all signals have values from the start to the end of a run."""
    for name, signal in signals.items():
        first, last = signal.ends
        if first > min(0.0, until) or last < max(0.0, until) * (1 - 1e-9):
            raise SetupError(f"`{name}` has values from {first:g} s to {last:g} s, and a run goes from 0 to {until:g} s")
