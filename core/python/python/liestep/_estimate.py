"""Estimates: the start of a motion, parameters and inputs, from readings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import by_names, floats, listed, number, shown, whole
from ._control import _components, chosen
from ._declared import Sum, _shaped
from ._run import Run, rotations
from ._stepper import Stepper, _start, _Start
from .errors import SetupError

if TYPE_CHECKING:
    from ._arrays import Array

_SENTENCES = {
    "converged": "the squares are the least, to the tolerance",
    "unseen": "the squares are the least, and the readings say nothing about one direction, which is in `direction`",
    "exhausted": "the iterations were too few: give more `iterations`, or a nearer guess",
    "stalled": "no step of the search is better, however short: give a nearer guess",
}


@dataclass
class _Readings:
    quantity: str
    values: list[float]
    deviations: list[float]


@dataclass
class _Task:
    step: float
    steps: int
    first: int
    start: _Start
    readings: list[_Readings]
    unknowns: list[list[int]]
    guesses: list[float]
    scales: list[float]
    axes: list[int]
    are_parameters: bool
    deviations: list[float]
    known: list[float]
    tolerance: float
    most: int


class Fit:
    """The motion that suits readings best; made by `Term.estimate`.

    Attributes
    ----------
    term : Term
        The term with the fitted parameters.
    parameters : dict
        The fitted parameters by their names.
    velocity, attitude : array
        Of the start; an attitude as the entries of its matrices, on SO(3) as a matrix.
    inputs : array
        The unknown inputs of each step, a row for each; none without any.
    covariance : array
        Of a displacement of the start, rad on SO(3), its momentum, and the unknown numbers, in this order; zero along what the
        readings don't determine.
    squares : float
        The sum of all squares, in variances: about the number of readings where these have the given deviations.
    verdict : str
        ``"converged"``, ``"unseen"``, ``"exhausted"`` or ``"stalled"``; `why` says what it means.
    direction : list of float or None
        In the order of the covariance, what the readings say nothing about.
    iterations : int
        Of the search.
    """

    def __init__(self, term: Sum, task: _Task, names: list[str], made: dict[str, Any], places: list[tuple[str, Any, list[list[int]]]]) -> None:
        import numpy as np

        self.verdict: str = made["verdict"]
        self.iterations: int = made["iterations"]
        self.squares: float = made["squares"]
        self.direction: list[float] | None = made["direction"]
        self.velocity: Array = np.array(made["velocity"])
        entries = np.array(made["attitude"])
        self.attitude: Array = entries.reshape(3, 3) if term.group == "SO3" else entries
        count = 2 * len(self.velocity) + len(task.unknowns)
        self.covariance: Array = np.array(made["covariance"]).reshape(count, count)
        # A force has all components.
        inputs = np.array(made["inputs"]).reshape(task.steps if task.axes else 0, -1 if task.axes else 0)
        self.inputs: Array = inputs if task.are_parameters else inputs[:, task.axes]
        self._step, self._steps, self._names = task.step, task.steps, names
        changed, first, values = {}, 0, made["constants"]
        for name, value, own in places:
            numbers = np.array(value.numbers)
            begin = term._first_number(term._found(name)[0])
            for one, number_ in zip(own, values[first : first + len(own)], strict=True):
                for place in one:
                    if begin <= place < begin + len(numbers):
                        numbers[place - begin] = number_
            first += len(own)
            changed[name] = _shaped(value.kind, tuple(numbers.tolist()))
        self.parameters: dict[str, Any] = changed
        self.term = term.with_(**changed)

    @property
    def converged(self) -> bool:
        """Whether the squares are the least, also where the readings don't determine all."""
        return self.verdict in ("converged", "unseen")

    @property
    def why(self) -> str:
        """Why the search stopped, as a sentence."""
        return _SENTENCES[self.verdict]

    @property
    def deviations(self) -> dict[str, float]:
        """The standard deviations of the unknown numbers, by a name for each: ``J_1`` is the first moment."""
        import numpy as np

        first = len(self.covariance) - len(self._names)
        return dict(zip(self._names, np.sqrt(np.diag(self.covariance)[first:]).tolist(), strict=True))

    def run(self, **run: Any) -> Run:
        """The fitted motion; with ``until`` or ``times`` as of `Stepper.run`, by default to the last reading. Without unknown
        inputs."""
        if "until" not in run and "times" not in run:
            run["until"] = self._step * self._steps
        start = {"velocity": self.velocity, "attitude": self.attitude} | run
        return Stepper(self.term, self._step).run(**start)

    def __repr__(self) -> str:
        found = ", ".join(f"{name} ± {deviation:.2g}" for name, deviation in self.deviations.items())
        return f"<Fit of {self.term.name}: {self.verdict} after {self.iterations} iterations, {found or 'its start'}>"


def _read(name: str, given: Any, every: int, steps: int | None, term: Sum) -> tuple[_Readings, int]:
    """The readings of a quantity for each step, and the number of steps."""
    import numpy as np

    known = ("velocity", "momentum", "spatial_momentum", "attitude", "energy")
    if name not in known:
        raise SetupError(f"readings are of {', '.join(known)}, not of `{name}`")
    if not isinstance(given, tuple) or len(given) != 2:
        raise SetupError(f"`{name}` has values and their standard deviation: write `{{\"{name}\": (values, 0.01)}}`")
    values, deviation = given
    if name == "attitude" and hasattr(values, "as_quat"):
        values = values.as_quat()[:, [3, 0, 1, 2]]
    rows = floats(name, values, SetupError)
    if name == "attitude" and term.group == "SO3" and rows.shape[1:] == (4,):
        rows = rotations(rows)
    rows = rows.reshape(len(rows), -1)
    made = (len(rows) - 1) * every
    if made < 1 or steps not in (None, made):
        raise SetupError(f"`{name}` has {len(rows)} rows: all readings have as many, two at least")
    full = np.full((made + 1, rows.shape[1]), np.nan)
    full[::every] = rows
    try:
        deviations = np.broadcast_to(floats(f"deviation of {name}", deviation, SetupError), rows.shape[1:])
    except ValueError as error:
        raise SetupError(f"the deviation of `{name}` is a number, or {rows.shape[1]} of them") from error
    if not (deviations > 0).all():
        raise SetupError(f"the deviation of `{name}` is above zero")
    return _Readings(name, full.ravel().tolist(), deviations.tolist()), made


def _unknown(term: Sum, name: str) -> tuple[Any, list[list[int]], list[str]]:
    """The value of an unknown parameter, the places of each of its unknown numbers, and their names."""
    places = term._found(name)
    at, which = places[0]
    value = term._value(places[0])
    if term.summands[at].numbers[which][0] in term.summands[at].directions:
        raise SetupError(f"`{name}` is a direction, which isn't estimated: take a vector of your own in its place")
    begins, count = [term._first_number(place) for place in places], len(value.numbers)
    if "Inertia" in value.kind:
        # Three moments where the axes are known, else six numbers.
        is_diagonal = not any(value.numbers[i * 3 + j] for i in range(3) for j in range(3) if i != j)
        pairs = [(i, i) for i in range(3)] if is_diagonal else [(i, j) for i in range(3) for j in range(i, 3)]
        own = [sorted({3 * i + j, 3 * j + i}) for i, j in pairs]
        names = [f"{name}_{i + 1}" if is_diagonal else f"{name}_{i + 1}{j + 1}" for i, j in pairs]
    else:
        own, names = [[k] for k in range(count)], [name] if count == 1 else [f"{name}_{k + 1}" for k in range(count)]
    return value, [[begin + k for begin in begins for k in one] for one in own], names


def estimate(
    term: Sum,
    *,
    step: float,
    readings: Mapping[str, tuple[Any, Any]],
    unknown: Iterable[str] = (),
    every: int = 1,
    first: int | None = None,
    velocity: Any = None,
    attitude: Any = None,
    known: Mapping[str, float] | None = None,
    force: Any = None,
    axes: Any = None,
    inputs: Mapping[str, float] | None = None,
    tolerance: float = 1e-5,
    iterations: int = 100,
) -> Fit:
    """The fit of `Term.estimate`."""
    import numpy as np

    if term.role != "lagrangian" or term.has_pace or term._signals():
        raise SetupError(f"an estimate is one of a Lagrangian without a pace or a signal, and not of {shown(term)}")
    whole("every", every, 1, 10**6)
    whole("iterations", iterations, 0, 2**31 - 1)
    if first is not None:
        whole("first", first, 2, 2**31 - 1)
    if not by_names("readings", readings):
        raise SetupError('an estimate has readings: `{"velocity": (values, deviation)}`')
    lists, steps = [], None
    for name, given in readings.items():
        one, steps = _read(name, given, every, steps, term)
        lists.append(one)
    if velocity is None:
        if "velocity" not in readings:
            raise SetupError("an estimate begins with a `velocity`: give a guess, or readings of it")
        velocity = floats("velocity", readings["velocity"][0], SetupError)[0]
    places, unknowns, guesses, names = [], [], [], []
    for name in listed("unknown", unknown):
        value, own, own_names = _unknown(term, name)
        places.append((name, value, own))
        unknowns += own
        guesses += [float(term.numbers[one[0]]) for one in own]
        names += own_names
    n = term._terms()[0][0].dimension
    information = np.zeros(2 * n + len(unknowns))
    at = {"attitude": range(n), "momentum": range(n, 2 * n)}
    place = 2 * n
    for name, _, own in places:
        at[name] = range(place, place + len(own))
        place += len(own)
    is_constrained = any(summand.derived().role == "nonholonomic" for summand in term.summands)
    for name, deviation in by_names("known", known).items():
        if name == "momentum" and is_constrained:
            raise SetupError("beside constraints on velocities what is `known` is about the attitude and parameters: leave `momentum` out")
        if name not in at:
            raise SetupError(f"what is known is about {', '.join(at)}, not `{name}`")
        if not number(name, deviation) > 0:
            raise SetupError(f"the deviation of `{name}` is above zero")
        information[list(at[name])] = number(name, deviation) ** -2.0
    along: list[int] = []
    spread: list[float] = []
    if force is not None:
        along = _components(axes, n, term.group == "SO3")
        spread = np.broadcast_to(floats("force", force, SetupError), (len(along),)).tolist()
    for name, deviation in by_names("inputs", inputs).items():
        if force is not None:
            raise SetupError("unknown inputs are a `force` beside the term, or `inputs` that are its parameters")
        own_places, _ = chosen(term, name)
        along += own_places
        spread += [number(name, deviation)] * len(own_places)
    task = _Task(
        number("step", step), steps or 0, (first - 1) * every if first else steps or 0, _start(attitude, velocity), lists, unknowns, guesses,
        [abs(guess) or 1.0 for guess in guesses], along, bool(inputs), spread, information.tolist(), number("tolerance", tolerance),
        iterations,
    )
    return Fit(term, task, names, _native.estimate(term._terms(), task), places)
