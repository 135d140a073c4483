"""Optimal control: a motion from here to there by forces, on any group."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import cos, inf
from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import floats, listed, number, shown, whole
from ._declared import Sum
from ._run import Columns, Run
from ._stepper import _numbers, _Start, _start
from .errors import SetupError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_SENTENCES = {
    "converged": "the conditions of an optimum hold to the tolerance",
    "infeasible": "to first order no torque within the bounds closes the gap",
    "exhausted": "the iterations were too few",
    "stalled": "no step of the search is better, however short: give another `guess`",
    "cancelled": "it was stopped while it was searched",
}


@dataclass
class _Task:
    step: float
    steps: int
    start: _Start
    goal: _Start
    ends_anyhow: bool
    axes: list[int]
    inputs: list[str]
    forces: list[list[float]]
    cones: list[tuple[list[float], list[float], float]]
    is_shortest: bool
    tolerance: float
    most: int
    progress: Callable[[int, float], bool | None] | None


class Plan(Run):
    """A motion with the forces that make it: a run, and the verdict of the search.

    Attributes
    ----------
    inputs : Columns
        The force of each step in the body frame, on SO(3) a torque, N m; as an array `Plan.force`.
    verdict : str
        ``"converged"``, ``"infeasible"``, ``"exhausted"``, ``"stalled"`` or ``"cancelled"``; `Plan.why` says what it means.
    duration, cost : float
        The time from the first state to the last, s; and what was minimised, s or N² m² s.
    residual : float
        How far it is from the conditions of Karush, Kuhn and Tucker.
    iterations : int
        Of the search.
    multipliers : list of float
        Minus the derivatives of the least cost by the goal: along turns of its attitude, and by its momentum.
    certificate : (list of float, float) or None
        Of what has no plan a unit vector of the conditions at the end and of what is kept out of, and the gap along it.
    """

    def __init__(self, title: str, made: dict[str, Any]) -> None:
        super().__init__(title, f"steps of {made['step']:.4g} s", made["step"], {"events": [], "ending": None, **made}, [])
        self.inputs = Columns(made["inputs"])
        self.verdict: str = made["verdict"]
        self.duration: float = made["duration"]
        self.cost: float = made["cost"]
        self.residual: float = made["residual"]
        self.multipliers: list[float] = made["multipliers"]
        self.certificate: tuple[list[float], float] | None = made["certificate"]
        self._why: str | None = made["why"]

    @property
    def converged(self) -> bool:
        """Whether it is an optimum to the tolerance."""
        return self.verdict == "converged"

    @property
    def why(self) -> str:
        """Why the search stopped, as a sentence."""
        gap = f": it is {self.certificate[1]:.2g}" if self.certificate else ""
        return _SENTENCES.get(self.verdict, self.verdict) + gap + (f"; {self._why}" if self._why else "")

    @property
    def torque(self) -> Array:
        """The torque of each step in the body's axes, N m: a row less than there are states."""
        return self.inputs.group("torque_")

    @property
    def force(self) -> Array:
        """The force of each step, along all components of a velocity, or the inputs: a row less than there are states."""
        return self.inputs.group("")

    def __repr__(self) -> str:
        return f"<Plan of {self.title}: {self.steps} {self.about}, {self.verdict} after {self.iterations} iterations>"


def _components(axes: Any, dimension: int, is_body: bool) -> list[int]:
    """The components of a velocity by their numbers, or by the names of a body's axes."""
    if axes is None:
        return list(range(dimension))
    known = f'some of the components 0 to {dimension - 1}' + (' or of "xyz"' if is_body else "")
    try:
        named = ["xyz".index(axis) for axis in axes] if isinstance(axes, str) and is_body else [operator.index(k) for k in axes]
    except (TypeError, ValueError) as error:
        raise SetupError(f"`axes` are {known}, not {shown(axes)}") from error
    if not named or any(not 0 <= k < dimension for k in named):
        raise SetupError(f"`axes` are {known}, not {shown(axes)}")
    return named


def chosen(term: Sum, inputs: str | Iterable[str]) -> tuple[list[int], list[str]]:
    """The places of the numbers of some parameters among all, and a name for each."""
    places: list[int] = []
    names: list[str] = []
    for name in listed("inputs", inputs):
        found = term._found(name)
        if len(found) > 1:
            raise SetupError(f"`{name}` is a parameter of several terms: write the one, as `{name}_1`")
        first, count = term._first_number(found[0]), len(term._value(found[0]).numbers)
        places += range(first, first + count)
        names += [name] if count == 1 else [f"{name}_{number}" for number in range(1, count + 1)]
    if not places:
        raise SetupError("`inputs` are names of parameters, one at least")
    return places, names


class Control:
    """A task of optimal control on any group; made by `Term.control`.

    It is data, and pickles.

    Parameters
    ----------
    term : Term
        The Lagrangian, with its forces; the control force is beside them.
    step : float
        The length of a step, s; where the time is minimised that of the first guess.
    steps : int
        How many.
    start, velocity : array_like
        Attitude and body velocity, on SO(3) in rad/s, as `Stepper.run` has them; the identity at rest.
    goal, goal_velocity : array_like or None
        Where the motion ends, at rest if nothing else is said. With ``None`` any attitude, or any velocity, will do.
    bound : array_like, optional
        The largest force, on SO(3) a torque, N m: a number, one for each axis, or a row of these for each step; zero where the
        motion is free.
    axes : str or list of int, optional
        The components of the velocity along which the force acts, from zero, all by default; on SO(3) also as a text, ``"z"``.
    inputs : str or list of str, optional
        Parameters of the term whose values are what is chosen in each step, instead of a force beside it: thrusts of a force of
        your own, the length of a pendulum, a field. `bound` and `guess` are then those of these numbers, and the effort is that of
        their squares.
    minimum_time : bool
        Whether the time is minimised; else it is the effort ``½ ∫ |u|² dt``.
    guess : array_like, optional
        The force that the search begins with, of the shapes of `bound`: none by default, or a thousandth of `bound` where the time
        is minimised. A search goes downhill from there.
    keep_out : iterable of (array_like, array_like, float)
        An axis of the body, a direction of space, and the least angle between them, rad, in each state; the first factor of the
        group is SO(3).

    Examples
    --------
    A turn by 1.5 rad about one axis in a second takes the effort ``6 J² θ²/T³``.

    >>> import liestep as ls
    >>> turn = ls.body([4, 3, 2]).control(step=0.01, steps=100, goal=ls.euler(0, 1.5))
    >>> plan = turn.solve()
    >>> plan.verdict, round(plan.cost, 1), 6 * 4**2 * 1.5**2
    ('converged', 216.0, 216.0)
    >>> plan.torque.shape, plan.velocity.shape
    ((100, 3), (101, 3))

    A cart that is pushed along a line, on the group of translations; its effort is ``6 m² x²/T³``.

    >>> cart = ls.lagrangian("R1", l_d="m * (F - I).norm_squared() / (2 * h)", m=2.0)
    >>> push = cart.control(step=0.01, steps=100, goal=[[1, 0.5], [0, 1]]).solve()
    >>> push.verdict, round(push.cost, 2), push.force.shape
    ('converged', 6.0, (100, 1))

    The same by a force of one's own, whose parameter ``u`` is chosen:

    >>> own = ls.force("R1", work="h * u * (eta[0] + eta_next[0]) / 2", u=0.0)
    >>> push = (cart + own).control(step=0.01, steps=100, goal=[[1, 0.5], [0, 1]], inputs="u").solve()
    >>> push.verdict, round(push.cost, 2), push.inputs.names
    ('converged', 6.0, ['u'])
    """

    def __init__(
        self,
        term: Sum,
        *,
        step: float,
        steps: int,
        start: Any = None,
        velocity: Any = (),
        goal: Any = None,
        goal_velocity: Any = (),
        bound: Any = None,
        axes: str | Iterable[int] | None = None,
        inputs: str | Iterable[str] | None = None,
        minimum_time: bool = False,
        guess: Any = None,
        keep_out: Iterable[tuple[Any, Any, float]] = (),
    ) -> None:
        import numpy as np

        if term.role != "lagrangian" or term.has_pace or term._signals():
            raise SetupError(f"a plan is one of a Lagrangian without a pace or a signal, and not of {shown(term)}")
        whole("steps", steps, 1, 10**6)
        named: list[str] = []
        if inputs is None:
            along = _components(axes, term._terms()[0][0].dimension, term.group == "SO3")
        elif axes is not None:
            raise SetupError("a plan has `axes` of a force beside the term, or `inputs` that are its parameters")
        else:
            along, named = chosen(term, inputs)

        def spread(name: str, value: Any) -> Array:
            try:
                return np.broadcast_to(floats(name, value, SetupError), (steps, len(along)))
            except ValueError as error:
                shape = f"a number, {len(along)} of them, or {steps} rows of {len(along)}"
                raise SetupError(f"`{name}` is {shape}, not of the shape {np.shape(value)}") from error

        largest = spread("bound", inf if bound is None else bound)
        # Without any force a motion in the shortest time may be a saddle, from which no direction leads down.
        small = 1e-3 * np.where(np.isfinite(largest), largest, 1.0) if minimum_time else 0.0
        first = spread("guess", small if guess is None else guess)
        forces = np.stack([-largest, largest, first], axis=2).reshape(-1, 3)
        cones = []
        try:
            kept_out = [(axis, direction, number("keep_out", angle)) for axis, direction, angle in keep_out]
        except (TypeError, ValueError) as error:
            if isinstance(error, SetupError):
                raise
            raise SetupError("`keep_out` is a list of axes, directions and angles: `[(axis, direction, angle)]`") from error
        for axis, direction, angle in kept_out:
            units = [np.array(_numbers("keep_out", vector, ((3,),))) for vector in (axis, direction)]
            if min(np.linalg.norm(vector) for vector in units) == 0:
                raise SetupError("an axis and a direction that are kept apart aren't zero")
            one, other = ((vector / np.linalg.norm(vector)).tolist() for vector in units)
            cones.append((one, other, cos(angle)))
        length = number("step", step)
        if not 0 < length < inf:
            raise SetupError(f"`step` is a length above zero, s, not {shown(step)}")
        self.term, self.steps, self.step = term, steps, length
        end = _start(goal, () if goal_velocity is None else goal_velocity)
        self._task = _Task(self.step, steps, _start(start, velocity), end, goal_velocity is None, along, named, forces.tolist(), cones,
                           bool(minimum_time), 0.0, 0, None)

    def solve(
        self,
        progress: Callable[[int, float], bool | None] | None = None,
        *,
        tolerance: float = 1e-10,
        iterations: int = 200,
    ) -> Plan:
        """Searches an optimum, from the first guess downhill; whether there is one the verdict says.

        Parameters
        ----------
        progress : callable, optional
            What each iteration is told to, by its number and residual; the search is cancelled where it returns ``False``.
        tolerance : float
            The largest residual of a plan that has converged.
        iterations : int
            The most.

        Returns
        -------
        Plan

        Raises
        ------
        SetupError
            A task that can't be begun.
        StepError
            A step of the first guess that has no solution.
        KeyboardInterrupt
            Between two iterations; its ``run`` is the plan until then.
        """
        from dataclasses import replace

        whole("iterations", iterations, 0, 2**31 - 1)
        task = replace(self._task, tolerance=number("tolerance", tolerance), most=iterations, progress=progress)
        made = _native.plan(self.term._terms(), task)
        plan = Plan(self.term.name, made)
        if made["failure"] is not None:
            made["failure"].run = plan
            raise made["failure"]
        return plan

    def __repr__(self) -> str:
        return f"<Control of {self.term.name}: {self.steps} steps of {self.step:g} s>"
