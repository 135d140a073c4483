"""Steppers: a declaration, a step and a method."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import ceil, inf, isfinite
from typing import Any

from . import _native
from ._arrays import floats, number, shown, whole
from ._declared import Sum
from ._event import Moment, Watch, watch
from ._gradient import Origin
from ._run import Run
from ._signal import Signal, reach
from ._state import State
from .errors import Error, SetupError, StepError


def _numbers(name: str, value: Any, shapes: tuple[tuple[int, ...], ...] = ()) -> list[float]:
    array = floats(name, value, SetupError)
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
    if type(value) in (list, tuple) and value and all(isinstance(part, (list, tuple, np.ndarray)) and np.ndim(part) == 2 for part in value):
        return [number for part in value for number in _numbers("attitude", part)], False
    return _numbers("attitude", value), floats("attitude", value, SetupError).shape == (4,)


def euler(precession: float, nutation: float, spin: float = 0.0, *, degrees: bool = False) -> list[float]:
    """The attitude ``R_z(φ) R_x(θ) R_z(ψ)``, body to space, as a quaternion ``[w, x, y, z]``.

    The angles are precession, nutation and spin, z-x-z about axes that turn with the body, rad; those of a 3-2-1 sequence are
    others: SciPy's ``Rotation.from_euler("ZYX", …)`` is taken as an attitude.

    Examples
    --------
    >>> import liestep as ls
    >>> [round(part, 3) for part in ls.euler(0, 60, degrees=True)]
    [0.866, 0.5, 0.0, 0.0]
    """
    from math import cos, pi, radians, sin

    angles = [number("angle", angle) for angle in (precession, nutation, spin)]
    if not degrees and max(map(abs, angles)) > 2 * pi:
        listed = ", ".join(f"{angle:g}" for angle in angles)
        raise SetupError(f"these angles are in rad, and beyond a whole turn: write `ls.euler({listed}, degrees=True)`")
    phi, theta, psi = (radians(angle) if degrees else angle for angle in angles)
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

    column = floats("shift", shift, SetupError)
    if column.ndim != 1:
        raise SetupError(f"`shift` is a list of numbers, not an array of the shape {column.shape}")
    matrix = np.eye(len(column) + 1)
    matrix[:-1, -1] = column
    return matrix


@dataclass
class _Start:
    attitude: list[float]
    is_quaternion: bool
    velocity: list[float]
    is_by_momentum: bool = False


@dataclass
class _Course:
    until: float
    every: int
    times: list[float] | None
    events: list[Watch]


def _end(until: Any, times: list[float] | None, step: float | None) -> float:
    """The time that a run comes to; by its last row, if it isn't given."""
    if until is None:
        if not times:
            raise SetupError("a run has an end: give `until`, s, or `times`")
        steps = max(1, ceil(times[-1] / step - 1e-9)) if step and isfinite(times[-1] / step) else 0
        return steps * step if step and steps else times[-1]
    end = number("until", until)
    if end == 0:
        raise SetupError("a run of no steps: `until` is behind the start, or before it where the step is below zero")
    if times and max(map(abs, times)) > abs(end) * (1 + 1e-12):
        raise SetupError(f"`times` go beyond the end of the run at {end:g} s: leave `until` out")
    return end


def _course(until: Any, every: Any, times: Any, events: Mapping[str, Any] | None, step: float | None) -> _Course:
    whole("every", every, 1, 2**63 - 1)
    if events is not None and not isinstance(events, Mapping):
        raise SetupError(f'`events` are texts by names, as {{"low": "tilt > 60 deg"}}, not {shown(events)}')
    watched = [watch(text) for text in (events or {}).values()]
    if times is None:
        return _Course(_end(until, None, step), every, None, watched)
    asked = floats("times", times, SetupError)
    if asked.ndim != 1:
        raise SetupError(f"`times` is a list of times, not an array of shape {asked.shape}")
    if asked.size == 0:
        raise SetupError("`times` are those of the rows, and there is none: give one, or leave `times` out")
    lengths = asked[1:] - asked[:-1]
    if (lengths > 0).any() and (lengths < 0).any():
        raise SetupError("`times` are in their order, and some come after a later one: sort them")
    return _Course(_end(until, asked.tolist(), step), 0, asked.tolist(), watched)


def _start(attitude: Any, velocity: Any, momentum: Any = None) -> _Start:
    if (velocity is None) == (momentum is None):
        raise SetupError("a start has a `velocity`, or a `momentum` in its place")
    numbers, is_quaternion = _attitude(attitude)
    name, value = ("velocity", velocity) if momentum is None else ("momentum", momentum)
    flat = _numbers(name, value)
    shape = floats(name, value, SetupError).shape
    if len(shape) > 1:
        raise SetupError(f"`{name}` is a list of numbers, and has the shape {shape}")
    return _Start(numbers, is_quaternion, flat, momentum is not None)


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
        Whether what rounding takes from sums is added to the next; off SO(3) without `substeps`.
    substeps : int
        Into how many parts a step is divided at most that has no solution.

    Beside a `liestep.signal` there are the declared step and a composition of it.

    Examples
    --------
    >>> import liestep as ls
    >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1])
    >>> top.stepper(0.01, composition="Suzuki 4")
    <Stepper of rigid_body + gravity: steps of 0.01 s by the composition Suzuki 4>
    """

    def __init__(
        self,
        term: Sum,
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
            floor = number("density", density["turn"]) if is_turn else 0.0
            if not 0 < floor < inf:
                raise SetupError(f'a density is `{{"turn": velocity}}`, rad/s, above zero, not {shown(density)}')
            given["density"] = repr(floor)
        named = [(kind, shown(scheme, str)) for kind, scheme in given.items() if scheme is not None]
        if len(named) > 1:
            raise SetupError(f"one method at a time: {' and '.join(kind for kind, _ in named)} are two")
        whole("substeps", substeps, 1, 2**16 - 1)
        kind, scheme = named[0] if named else ("step", "")
        self.term = term
        self.step = number("step", step)
        self.method = (kind, scheme, bool(compensated), substeps)
        self._native = term._scene()
        # What is wrong with the method is said here, and not where it runs.
        self._native.check(self.step, self.method)

    def run(
        self,
        *,
        velocity: Any = None,
        momentum: Any = None,
        attitude: Any = None,
        until: float | None = None,
        every: int | None = None,
        times: Any = None,
        events: Mapping[str, str | Callable[[Moment], Any]] | None = None,
    ) -> Run:
        """Makes the steps to a time, and records them.

        Parameters
        ----------
        velocity : array_like
            Body velocity at the start, in the axes of the body and not of space; on SO(3) in rad/s.
        momentum : array_like
            Body momentum at the start instead, in the axes of the body; on SO(3) in kg m²/s.
        attitude : array_like, optional
            Body to space, ``x_space = R x_body``: a quaternion ``[w, x, y, z]`` with its scalar first, a matrix, SciPy's
            ``Rotation``, on a product a list of matrices; the identity, if none is given.
        until : float
            The time, s, a whole number of steps. A step below zero goes back, to a time below zero.
        every : int
            Steps from row to row: one, if nothing else is said.
        times : array_like, optional
            The times of the rows instead, s, between the steps too; without `until` the last of them is the end.
        events : mapping, optional
            Names, and what is looked for: ``"tilt > 60 deg"``, ``"velocity_x = 0"``; with ``", stop"`` it ends the run after
            the step in which it happens. Or a function of a `liestep.Moment` that passes zero there; its attributes
            ``direction`` and ``terminal`` are SciPy's. Of two crossings within one step neither is found; a run to an
            accuracy with events makes a thousand steps at least.

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
        course = self._course(until, every, times, events)
        return self._made(_start(attitude, velocity, momentum), course, list(events or {}))

    def start(self, *, velocity: Any = None, momentum: Any = None, attitude: Any = None) -> State:
        """The state at a start, for a loop of your own: ``state.step(torque=…)``.

        Parameters
        ----------
        velocity, momentum, attitude
            As of `run`.

        Returns
        -------
        State
        """
        return State(self, self._native.start(self.step, self.method, _start(attitude, velocity, momentum)))

    def _resumed(self, numbers: list[float]) -> _native.State:
        return self._native.resume(self.step, self.method, numbers)

    def _seen(self, numbers: list[float]) -> dict[str, Any]:
        return self.term._seen(numbers)

    def _given(self, parameters: Mapping[str, Any]) -> list[float]:
        if not isinstance(parameters, Mapping):
            raise SetupError(f'`given` are values by the names of parameters, as {{"m": 2.0}}, not {shown(parameters)}')
        if any(isinstance(value, Signal) for value in parameters.values()):
            raise SetupError("`given` are values: a signal is a parameter of the term, as in `term.with_(m=ls.signal(…))`")
        return [number for _, numbers in self.term.with_(**parameters)._terms() for number in numbers]

    def _course(self, until: Any, every: Any, times: Any, events: Any) -> _Course:
        are_equal = self.method[0] != "density" and not self.term.has_pace
        return _course(until, 1 if every is None else every, times, events, self.step if are_equal else None)

    def _made(self, start: _Start, course: _Course, names: list[str]) -> Run:
        reach(self.term._signals(), course.until)
        made = self._native.run(self.step, self.method, start, course)
        run = _finished(self.term, self.step, made, names, self._about(), _Estimate(self, start, course.until))
        run._origin = Origin(self, start)
        return run

    def _about(self) -> str:
        kind, scheme, compensated, substeps = self.method
        rest = (", compensated" if compensated else "") + (f", or {substeps} parts" if substeps > 1 else "")
        return f"steps of {self.step:g} s{_by(kind, scheme)}{rest}"

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self.term, self.step, self.method)

    def __repr__(self) -> str:
        return f"<Stepper of {self.term.name}: {self._about()}>"


def _again(term: Sum, step: float, method: tuple[str, str, bool, int]) -> Stepper:
    kind, scheme, compensated, substeps = method
    given: dict[str, Any] = {} if kind == "step" else {kind: {"turn": float(scheme)} if kind == "density" else scheme}
    return Stepper(term, step, **given, compensated=compensated, substeps=substeps)


@dataclass
class _Estimate:
    """How far the end of a run is off: runs of other steps say it, where they agree as those of a method do."""

    stepper: Stepper
    start: _Start
    until: float
    ends: dict[int, Run] = field(default_factory=dict)

    def __call__(self, run: Run) -> float | None:
        steps = run.steps
        if run.ended_by is not None or self.stepper.method[0] == "density" or self.stepper.term.has_pace or steps == 0:
            return None
        try:
            if steps % 4 == 0 and steps >= 16 and (error := self.left(steps)) < SURE:
                return max(error, steps * 2.0**-52)
        except Error:
            pass
        try:
            error = self.left(4 * steps)
            away = self._apart(steps, 4 * steps)
        except Error:
            return None
        return max(away + error, steps * 2.0**-52) if error < max(away, ROUNDED) else None

    def left(self, count: int) -> float:
        """The error of a run of so many steps, by those of half and of a quarter as many."""
        far, near = self._apart(count // 4, count // 2), self._apart(count // 2, count)
        # The error falls by this where the steps are halved: by no more than the order of the method promises.
        falls = min(far / near, 2.0 ** _native.order(self.stepper.method)) if near > 0 else inf
        return near if near < ROUNDED else near / (falls - 1) if falls > LEAST_FALL else inf

    def _apart(self, count: int, more: int) -> float:
        """The error of the end by so many steps, as an accuracy measures it, if that by more steps were exact."""
        states = [list(zip(run._attitudes().tolist(), run.velocity.tolist())) for run in (self._last(count), self._last(more))]
        return self.stepper._native.error(states[0][-1], states[1], self.until)

    def _last(self, count: int) -> Run:
        if count not in self.ends:
            # In between are times by which an accuracy knows the size of the motion.
            times = [self.until * part for part in (0, 8**-3, 8**-2, 8**-1, 1)]
            course, step = _Course(self.until, 0, times, []), self.until / count
            made = self.stepper._native.run(step, self.stepper.method, self.start, course)
            self.ends[count] = _finished(self.stepper.term, step, made, [], "")
        return self.ends[count]


#: Where an error falls by less with half the step, the runs don't agree.
LEAST_FALL = 1.6
#: A larger one by longer steps may be chance, and is measured by shorter ones.
SURE = 0.02
#: Below it differences are those of rounding.
ROUNDED = 1e-10


def _finished(
    term: Sum, step: float, made: dict[str, Any], names: list[str], about: str, estimate: _Estimate | None = None
) -> Run:
    run = Run(term.name, about, step, made, names, estimate)
    failure = made["failure"]
    if failure is not None:
        run._estimate = None
        failure.run = run
        raise failure
    return run


#: More steps take minutes.
MOST = 10**7
#: Of a run whose steps nobody has chosen.
ROWS = 1001


class _Search(Stepper):
    """A stepper whose method and step are found by trial runs, for the motion that it is to make."""

    def __init__(self, term: Sum, tolerance: float) -> None:
        if term.has_pace:
            raise SetupError("a pace is that of the declared step, whose length is given: take `stepper(h)`")
        self.term, self.tolerance = term, number("tolerance", tolerance)

    def _course(self, until: Any, every: Any, times: Any, events: Any) -> _Course:
        import numpy as np

        course = _course(until, 1 if every is None else every, times, events, None)
        if course.until < 0:
            raise SetupError("a run back has a step that is given, below zero, as `term.stepper(-0.01).run(until=-3, …)`")
        if every is None and times is None and isfinite(course.until):
            course.every, course.times = 0, np.linspace(0.0, course.until, ROWS).tolist()
        return course

    def _made(self, start: _Start, course: _Course, names: list[str]) -> Run:
        scene = self.term._scene()
        if not scene.is_self_adjoint or start.is_by_momentum:
            return self._by_own_steps(start, course, names)
        made = scene.ask(self.tolerance, start, course)
        kind, name = made["method"]
        count = round(course.until / made["step"])
        if made["failure"] is None and (more := _enough(count, course)) > count:
            shorter = Stepper(self.term, course.until / more, **_method(kind, name))
            again = self.term._scene().run(shorter.step, shorter.method, start, course)
            made = {**made, **again, "step": shorter.step}
        about = f"steps of {made['step']:.4g} s{_by(kind, name)}"
        run = _finished(self.term, made["step"], made, names, about)
        run.method = _method(kind, name)
        run._origin = Origin(Stepper(self.term, made["step"], **run.method), start)
        return run

    def _by_own_steps(self, start: _Start, course: _Course, names: list[str]) -> Run:
        """Ever more of the declared steps, until their error is small enough."""
        if not 0 < self.tolerance < 1:
            raise SetupError(f"an accuracy is between zero and one, not {self.tolerance:g}")
        count, until = 16, course.until
        while isfinite(until) and count <= MOST:
            stepper = Stepper(self.term, until / count)
            try:
                error = _Estimate(stepper, start, until).left(count)
            except StepError:
                error = inf
            if error < self.tolerance:
                if (more := _enough(count, course)) > count:
                    stepper = Stepper(self.term, until / more)
                run = stepper._made(start, course, names)
                run._error, run._estimate, run.method = error, None, {}
                return run
            # The next number is that of order 2, but no farther than these runs can say.
            count *= min(8, max(2, int((2 * error / self.tolerance) ** 0.5))) if error < SURE else 2
        found = f"the step of {self.term.name} doesn't come to {self.tolerance:g} in {MOST} steps"
        raise SetupError(f"{found}: take a larger tolerance, or a step, `stepper(h)`")


def _enough(count: int, course: _Course) -> int:
    """A multiple of a number of steps, so that events aren't lost: of two crossings within one step neither is found."""
    return count * ceil((ROWS - 1) / count) if course.events and 0 < count < ROWS - 1 else count


def accurate(term: Sum, tolerance: float, **run: Any) -> Run:
    """As `Stepper.run`, by the method and the step that trial runs have found; `Run.choice` has them all."""
    return _Search(term, tolerance).run(**run)


def _by(kind: str, scheme: object) -> str:
    """The method in the text of a stepper or a run; names of processed schemes begin with their kind."""
    known = {
        "step": "", "exact": " by the exact motion", "collocation": f" by {scheme} stages",
        "density": f" at first, of a density by the turn from {scheme} rad/s on",
    }
    return known.get(kind, f" by the {kind} {str(scheme).removeprefix(f'{kind} ')}")


def _method(kind: str, name: str) -> dict[str, Any]:
    """The arguments of `Stepper` for a scheme."""
    if kind == "exact":
        # Without kicks any splitting is the exact motion.
        return {"splitting": "Strang"}
    return {} if kind == "step" else {kind: int(name) if kind == "collocation" else name}


def schemes() -> dict[str, list[str]]:
    """The names of all schemes, by the argument of `Stepper` that takes them.

    Examples
    --------
    >>> import liestep as ls
    >>> "Suzuki 4" in ls.schemes()["composition"]
    True
    """
    return {kind: list(names) for kind, names in _native.schemes()}
