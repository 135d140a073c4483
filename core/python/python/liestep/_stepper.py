"""Steppers: a declaration, a step and a method."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

from . import _native
from ._declared import Term
from ._run import Run
from .errors import SetupError


def _numbers(name: str, value: Any, shapes: tuple[tuple[int, ...], ...] = ()) -> list[float]:
    import numpy as np

    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise SetupError(f"`{name}` is an array of numbers, not {value!r:.80}") from error
    if shapes and array.shape not in shapes:
        known = " or ".join(map(str, shapes))
        raise SetupError(f"`{name}` has the shape {array.shape}: give {known}")
    if array.size > 1000:
        raise SetupError(f"`{name}` has {array.size} numbers: it is one state, and starts one motion")
    flat: list[float] = array.ravel().tolist()
    return flat


def _attitude(value: Any) -> tuple[list[float], bool]:
    """The numbers of an attitude, and whether they are a quaternion ``w, x, y, z``."""
    import numpy as np

    if value is None:
        return [], False
    if hasattr(value, "as_quat"):
        # SciPy's Rotation has its scalar last.
        x, y, z, w = _numbers("attitude", value.as_quat(), ((4,),))
        return [w, x, y, z], True
    if isinstance(value, (list, tuple)) and value and all(np.ndim(part) == 2 for part in value):
        return [number for part in value for number in _numbers("attitude", part)], False
    numbers = _numbers("attitude", value)
    return numbers, np.shape(value) == (4,)


def euler(precession: float, nutation: float, spin: float = 0.0, *, degrees: bool = False) -> list[float]:
    """The attitude ``R_z(φ) R_x(θ) R_z(ψ)`` as a quaternion ``[w, x, y, z]``.

    Examples
    --------
    >>> import liestep as ls
    >>> [round(part, 3) for part in ls.euler(0, 60, degrees=True)]
    [0.866, 0.5, 0.0, 0.0]
    """
    from math import cos, radians, sin

    phi, theta, psi = (radians(a) if degrees else a for a in (precession, nutation, spin))
    return [
        cos(theta / 2) * cos((phi + psi) / 2),
        sin(theta / 2) * cos((phi - psi) / 2),
        sin(theta / 2) * sin((phi - psi) / 2),
        cos(theta / 2) * sin((phi + psi) / 2),
    ]


def translation(shift: Any) -> Any:
    """The matrix of a translation, as an element of R1, R2 or R3.

    Examples
    --------
    >>> import liestep as ls
    >>> ls.translation([1.0]).tolist()
    [[1.0, 1.0], [0.0, 1.0]]
    """
    import numpy as np

    matrix = np.eye(len(shift) + 1)
    matrix[:-1, -1] = shift
    return matrix


_EVENT = re.compile(
    r"\s*(?P<of>\w+)\s*(?P<sign>[<>]|=)\s*(?P<value>[-+]?[\d.]+(?:e[-+]?\d+)?)\s*(?P<unit>deg|rad|rpm)?\s*(?P<stop>,\s*stop)?\s*"
)
_UNITS = {None: 1.0, "rad": 1.0, "deg": 0.017453292519943295, "rpm": 0.10471975511965977}


@dataclass
class _Watch:
    quantity: str
    value: float
    direction: int
    stops: bool


@dataclass
class _Start:
    attitude: list[float]
    is_quaternion: bool
    velocity: list[float]


@dataclass
class _Course:
    until: float
    every: int
    times: list[float] | None
    events: list[_Watch]


def _watch(text: Any) -> _Watch:
    found = _EVENT.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        raise SetupError(f'{text!r} is no event: write "tilt > 60 deg", "energy < 3", "velocity_x = 0, stop"')
    direction = {">": 1, "<": -1, "=": 0}[found["sign"]]
    return _Watch(found["of"], float(found["value"]) * _UNITS[found["unit"]], direction, bool(found["stop"]))


def _course(until: Any, every: Any, times: Any, events: Mapping[str, str] | None) -> _Course:
    try:
        end = float(until)
    except (TypeError, ValueError, OverflowError) as error:
        raise SetupError(f"`until` is a time, s, not {until!r:.80}") from error
    if isinstance(every, bool) or not isinstance(every, int) or not 0 < every < 2**63:
        raise SetupError(f"`every` is a whole number of steps above zero, not {every!r:.80}")
    if times is None:
        return _Course(end, every, None, [_watch(text) for text in (events or {}).values()])
    import numpy as np

    try:
        asked = np.asarray(times, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise SetupError("`times` are numbers, s") from error
    if asked.ndim != 1:
        raise SetupError(f"`times` is a list of times, not an array of shape {asked.shape}")
    return _Course(end, 0, asked.tolist(), [_watch(text) for text in (events or {}).values()])


def _start(attitude: Any, velocity: Any) -> _Start:
    numbers, is_quaternion = _attitude(attitude)
    return _Start(numbers, is_quaternion, _numbers("velocity", velocity))


class Stepper:
    """What makes steps of one length: a declaration with a method.

    Parameters
    ----------
    term : Term
        What is stepped.
    step : float
        Its length, s.
    composition, splitting, processed : str, optional
        The name of a scheme of `liestep.schemes`: of the declared step, or, on SO(3) where a potential is apart, of the
        exact motion of the free body and its kicks.
    collocation : {4, 8}, optional
        The stages of a Gauss collocation.
    density : mapping, optional
        On SO(3) ``{"turn": 1.0}``: the first step is about `step`, and in each the body turns by about as much, from this
        velocity on, rad/s. Reversible; without members of an ensemble, a force, or another method.
    compensated : bool
        Whether what rounding takes from sums is added to the next.
    substeps : int
        Into how many parts a step is divided at most that has no solution.

    Examples
    --------
    >>> import liestep as ls
    >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1])
    >>> top.stepper(0.01, composition="Suzuki 4")
    <Stepper of rigid_body + gravity: steps of 0.01 s by the composition Suzuki 4>
    """

    def __init__(
        self,
        term: Term,
        step: float,
        *,
        composition: str | None = None,
        splitting: str | None = None,
        processed: str | None = None,
        collocation: int | None = None,
        density: Mapping[str, float] | None = None,
        compensated: bool = False,
        substeps: int = 1,
    ) -> None:
        given: dict[str, Any] = {
            "composition": composition, "splitting": splitting, "processed": processed, "collocation": collocation,
        }
        if density is not None:
            is_turn = isinstance(density, Mapping) and list(density) == ["turn"]
            (floor,) = _numbers("density", density["turn"], ((),)) if is_turn else (0.0,)
            if not 0 < floor < inf:
                raise SetupError(f'a density is `{{"turn": velocity}}`, rad/s, above zero, not {density!r:.80}')
            given["density"] = repr(floor)
        named = [(kind, str(scheme)) for kind, scheme in given.items() if scheme is not None]
        if len(named) > 1:
            raise SetupError(f"one method at a time: {' and '.join(kind for kind, _ in named)} are two")
        if not isinstance(substeps, int) or not 0 < substeps < 2**16:
            raise SetupError(f"`substeps` is a whole number above zero, not {substeps!r:.80}")
        kind, scheme = named[0] if named else ("step", "")
        self.term = term
        self.step = float(step)
        self.method = (kind, scheme, bool(compensated), substeps)
        self._native = term._scene()
        # What is wrong with the method is said here, and not where it runs.
        self._native.check(self.step, self.method)

    def run(
        self,
        *,
        velocity: Any,
        attitude: Any = None,
        until: float,
        every: int = 1,
        times: Any = None,
        events: Mapping[str, str] | None = None,
    ) -> Run:
        """Makes the steps to a time, and records them.

        Parameters
        ----------
        velocity : array_like
            Body velocity at the start, on SO(3) in rad/s.
        attitude : array_like, optional
            Body to space: a quaternion ``[w, x, y, z]``, a matrix, SciPy's ``Rotation``, on a product a list of matrices;
            the identity, if none is given.
        until : float
            The time, s.
        every : int
            Steps from row to row.
        times : array_like, optional
            The times of the rows instead, s, between the steps too.
        events : mapping, optional
            Names, and what is looked for: ``"tilt > 60 deg"``, ``"velocity_x = 0"``; with ``", stop"`` it ends the run.

        Returns
        -------
        Run

        Raises
        ------
        StepError
            Where a step has no solution. Its ``run`` is what was recorded until then, as it is of a `KeyboardInterrupt`.

        Examples
        --------
        >>> import liestep as ls
        >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1])
        >>> run = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=10, events={"low": "tilt > 10 deg"})
        >>> run["energy"].shape, run.velocity.shape
        ((1001,), (1001, 3))
        >>> run.events["low"].rising.all()
        np.True_
        """
        return self._made(_start(attitude, velocity), _course(until, every, times, events), list(events or {}))

    def _made(self, start: _Start, course: _Course, names: list[str]) -> Run:
        made = self._native.run(self.step, self.method, start, course)
        return _finished(self.term, self.step, made, names, self._about())

    def _about(self) -> str:
        kind, scheme, compensated, substeps = self.method
        by = {"step": "", "density": f" at first, of a density by the turn from {scheme} rad/s on", "collocation": f" by {scheme} stages"}.get(kind, f" by the {kind} {scheme}")
        rest = (", compensated" if compensated else "") + (f", or {substeps} parts" if substeps > 1 else "")
        return f"steps of {self.step:g} s{by}{rest}"

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self.term, self.step, self.method)

    def __repr__(self) -> str:
        return f"<Stepper of {self.term.name}: {self._about()}>"


def _again(term: Term, step: float, method: tuple[str, str, bool, int]) -> Stepper:
    kind, scheme, compensated, substeps = method
    given: dict[str, Any] = {} if kind == "step" else {kind: {"turn": float(scheme)} if kind == "density" else scheme}
    return Stepper(term, step, **given, compensated=compensated, substeps=substeps)


def _finished(term: Term, step: float, made: dict[str, Any], names: list[str], about: str) -> Run:
    run = Run(term.name, about, step, made, names)
    failure = made["failure"]
    if failure is not None:
        failure.run = run
        raise failure
    return run


class _Search(Stepper):
    """A stepper whose method and step are found by trial runs, for the motion that it is to make."""

    def __init__(self, term: Term, tolerance: float) -> None:
        self.term, self.tolerance = term, float(tolerance)

    def _made(self, start: _Start, course: _Course, names: list[str]) -> Run:
        made = self.term._scene().ask(self.tolerance, start, course)
        about = f"steps of {made['step']:.4g} s by {made['method']}"
        run = _finished(self.term, made["step"], made, names, about)
        run.method = _method(made["method"])
        return run


def accurate(term: Term, tolerance: float, **run: Any) -> Run:
    """As `Stepper.run`, by the method and the step that trial runs have found; `Run.choice` has them all."""
    return _Search(term, tolerance).run(**run)


def _method(name: str) -> dict[str, Any]:
    """The arguments of `Stepper` for what the search calls a method."""
    if name in ("its own step", "exact"):
        # Nothing is kicked: any splitting is the exact motion.
        return {} if name == "its own step" else {"splitting": "Strang"}
    if stages := re.search(r"(\d+) stages", name):
        return {"collocation": int(stages[1])}
    scheme = name.removeprefix("exact, ")
    return {kind: scheme for kind, known in schemes().items() if scheme in known}


def schemes() -> dict[str, list[str]]:
    """The names of all schemes, by the argument of `Stepper` that takes them.

    Examples
    --------
    >>> import liestep as ls
    >>> "Suzuki 4" in ls.schemes()["composition"]
    True
    """
    return {kind: list(names) for kind, names in _native.schemes()}
