"""Optimal control: a motion from here to there by torques."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import cos, inf
from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import floats, number, whole
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
    "stalled": "no step of the search is better, however short",
    "cancelled": "it was stopped while it was searched",
}


@dataclass
class _Task:
    step: float
    steps: int
    start: _Start
    goal: _Start
    axes: list[int]
    torques: list[list[float]]
    cones: list[tuple[list[float], list[float], float]]
    is_shortest: bool
    tolerance: float
    most: int
    progress: Callable[[int, float], bool | None] | None


class Plan(Run):
    """A motion with the torques that make it: a run, and what the search says of it.

    Attributes
    ----------
    inputs : Columns
        The torque of each step in the body's axes, N m; as an array `Plan.torque`.
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

    def __repr__(self) -> str:
        return f"<Plan of {self.title}: {self.steps} {self.about}, {self.verdict} after {self.iterations} iterations>"


class Control:
    """A task of optimal control on SO(3); made by `Term.control`.

    It is data, and pickles.

    Parameters
    ----------
    term : Term
        What moves, with its forces; the torque is beside them.
    step : float
        The length of a step, s; where the time is minimised that of the first guess.
    steps : int
        How many.
    start, velocity : array_like
        Attitude and body velocity, rad/s, as `Stepper.run` has them; the identity at rest.
    goal, goal_velocity : array_like or None
        Where the motion ends, at rest if nothing else is said. With ``None`` any attitude, or any velocity, will do.
    bound : array_like, optional
        The largest torque, N m: a number, one for each axis, or a row of these for each step; zero where the body coasts.
    axes : str
        The axes of the body that a torque acts about: ``"xyz"``, ``"z"``.
    minimum_time : bool
        Whether the time is minimised; else it is the effort ``½ ∫ |u|² dt``.
    guess : array_like, optional
        The torque that the search begins with, of the shapes of `bound`. A search goes downhill from there.
    keep_out : iterable of (array_like, array_like, float)
        An axis of the body, a direction of space, and the angle that is to be between them at least, rad, in each state.

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
    """

    def __init__(
        self,
        term: Sum,
        *,
        step: float,
        steps: int,
        start: Any = None,
        velocity: Any = (0, 0, 0),
        goal: Any = None,
        goal_velocity: Any = (0, 0, 0),
        bound: Any = None,
        axes: str = "xyz",
        minimum_time: bool = False,
        guess: Any = None,
        keep_out: Iterable[tuple[Any, Any, float]] = (),
    ) -> None:
        import numpy as np

        if term.group != "SO3" or term.role != "lagrangian" or term.has_pace:
            raise SetupError(f"a plan is one of a Lagrangian on SO3 without a pace, and not of {term!r:.80}")
        whole("steps", steps, 1, 10**6)
        if not isinstance(axes, str) or not axes or any(axis not in "xyz" for axis in axes):
            raise SetupError(f'`axes` are some of "xyz", not {axes!r:.80}')

        def spread(name: str, value: Any) -> Array:
            try:
                return np.broadcast_to(floats(name, value, SetupError), (steps, len(axes)))
            except ValueError as error:
                shape = f"a number, {len(axes)} of them, or {steps} rows of {len(axes)}"
                raise SetupError(f"`{name}` is {shape}, not of the shape {np.shape(value)}") from error

        largest = spread("bound", inf if bound is None else bound)
        first = spread("guess", 0.0 if guess is None else guess)
        torques = np.stack([-largest, largest, first], axis=2).reshape(-1, 3)
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
            raise SetupError(f"`step` is a length above zero, s, not {step!r:.80}")
        self.term, self.steps, self.step = term, steps, length
        end = _start(goal, (0, 0, 0) if goal_velocity is None else goal_velocity)
        if goal_velocity is None:
            end.velocity = []
        self._task = _Task(self.step, steps, _start(start, velocity), end, ["xyz".index(axis) for axis in axes],
                           torques.tolist(), cones, bool(minimum_time), 0.0, 0, None)

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
        made = _native.plan(self.term._terms(gradients=True), task)
        plan = Plan(self.term.name, made)
        if made["failure"] is not None:
            made["failure"].run = plan
            raise made["failure"]
        return plan

    def __repr__(self) -> str:
        return f"<Control of {self.term.name}: {self.steps} steps of {self.step:g} s>"
