"""Derivatives of runs: by the start, by all parameters, and by signals."""

from __future__ import annotations

import pickle
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ._arrays import floats, whole
from ._declared import Sum, _shaped
from .errors import DeclarationError, SetupError

if TYPE_CHECKING:
    from ._arrays import Array


@dataclass
class Motion:
    """The start of a run, and the times of its rows."""

    start: Any
    times: list[float]


@dataclass
class Covectors:
    """Derivatives of a scalar by a run's columns, a row after the other; empty lists stand for zeros."""

    velocity: list[float] = field(default_factory=list)
    momentum: list[float] = field(default_factory=list)
    attitude: list[float] = field(default_factory=list)
    shown: list[float] = field(default_factory=list)
    matrix: list[float] = field(default_factory=list)
    energy: list[float] = field(default_factory=list)
    spatial_momentum: list[float] = field(default_factory=list)


class Gradient:
    """The derivatives of a scalar of a run; made by `Run.gradient`.

    ``gradient["m"]`` is the derivative by a parameter, by any of its names in a sum.

    Attributes
    ----------
    attitude : array
        By a small turn of the attitude at the start about the axes of the body, rad⁻¹; off SO(3) by the coordinates ``ζ`` of
        ``g exp ζ̂``.
    velocity, momentum : array or None
        By that of both which the run's start has, in the axes of the body. The other one isn't held.
    signals : dict of array
        By the parameters that are a `liestep.signal`: by its values, a row for each of its times; by that of a function, a row for
        each step, as if the function had another value over this step.
    """

    def __init__(self, term: Sum, made: dict[str, Any], is_by_momentum: bool) -> None:
        self._term, self._numbers = term, floats("gradient", made["parameters"], SetupError)
        self.attitude: Array = floats("gradient", made["attitude"], SetupError)
        self.momentum: Array | None = floats("gradient", made["momentum"], SetupError) if is_by_momentum else None
        self.velocity: Array | None = None if is_by_momentum else floats("gradient", made["velocity"], SetupError)
        places = [
            (at, which) for at, summand in enumerate(term.summands) for which, (_, value) in enumerate(summand.numbers)
            if value.signal is not None
        ]
        by_place = dict(zip(places, made["signals"], strict=True))
        self.signals: dict[str, Array] = {}
        for name, own in term._shown().items():
            if own[0] in by_place:
                one = term._value(own[0])
                shape: tuple[int, ...] = getattr(_shaped(one.kind, one.numbers), "shape", ())
                lists = [floats("gradient", by_place[place], SetupError) for place in own]
                self.signals[name] = sum(lists[1:], lists[0]).reshape(-1, *shape)

    def __getitem__(self, name: str) -> Any:
        places = self._term._places()
        if name not in places:
            raise DeclarationError(f"there is no parameter `{name}`: there are {', '.join(self._term.parameters)}")
        return self._by(places[name])

    def _by(self, places: list[tuple[int, int]]) -> Any:
        value = self._term._value(places[0])
        begins = map(self._term._first_number, places)
        lists = [self._numbers[first : first + len(value.numbers)] for first in begins]
        return _shaped(value.kind, tuple(sum(lists[1:], lists[0]).tolist()))

    @property
    def parameters(self) -> dict[str, Any]:
        """The derivatives by all parameters, of the shapes that `Term.parameters` has them in; by a signal as if it changed by a constant."""
        return {name: self._by(places) for name, places in self._term._shown().items()}

    def __repr__(self) -> str:
        start = "momentum" if self.velocity is None else "velocity"
        return f"<Gradient by attitude, {start}, {', '.join(self.parameters)}>"


@dataclass
class Origin:
    """The stepper and the start of a run."""

    stepper: Any
    start: Any

    def does_pickle(self) -> bool:
        """Whether it can be kept with a run: a signal by a function may not be."""
        try:
            pickle.dumps(self)
        except (pickle.PicklingError, AttributeError, TypeError):
            return False
        return True

    def gradient(self, run: Any, given: dict[str, Any]) -> Gradient:
        """The gradient of a scalar by whose derivatives these columns are given."""
        by = Covectors()
        for name, value in given.items():
            if value is None:
                continue
            shape = _shape(run, name)
            array = floats(name, value, SetupError)
            if array.shape != shape:
                raise SetupError(f"`{name}` has the shape {array.shape}: the derivatives by that of this run have {shape}")
            setattr(by, name, array.ravel().tolist())
        if by.attitude:
            by.shown = _attitudes(run).ravel().tolist()
        motion, stepper = Motion(self.start, run.time.tolist()), self.stepper
        made = stepper._native.gradient(stepper.step, stepper.method, motion, by)
        return Gradient(stepper.term, made, self.start.is_by_momentum)

    def transition(self, steps: int, between: int | None) -> Array:
        """The state transition matrix, or the exponents."""
        stepper = self.stepper
        made = stepper._native.transition(stepper.step, stepper.method, self.start, steps, between)
        numbers = floats("derivatives", made, SetupError)
        if between is not None:
            return numbers
        count = round(len(numbers) ** 0.5)
        return numbers.reshape(count, count).T


class Differentiable:
    """A run with derivatives."""

    _origin: Origin | None = None
    steps: int

    def gradient(
        self,
        *,
        velocity: Any = None,
        momentum: Any = None,
        attitude: Any = None,
        matrix: Any = None,
        energy: Any = None,
        spatial_momentum: Any = None,
    ) -> Gradient:
        """The gradient of a scalar of this run, by its start, all parameters and all signals, in one pass back.

        A scalar ``L`` is given by its derivatives by columns of the run, each of their shape: ``velocity`` is ``∂L/∂run.velocity``.
        The derivatives are those of the discrete motion, at any step, and at the times of the rows. All parameters together
        cost about two further runs, by the declared step or a ``composition`` of it, on any group.

        Parameters
        ----------
        velocity, momentum, spatial_momentum, energy : array_like, optional
            The derivatives by these, of their shapes.
        attitude : array_like, optional
            Those by the columns of the attitude: on SO(3) by the quaternions, ``run.quaternion``.
        matrix : array_like, optional
            On SO(3) those by ``run.matrix`` instead, or beside.

        Returns
        -------
        Gradient

        Raises
        ------
        SetupError
            Another method, a pace or a density, or another shape.
        StepError
            A derivative that overflows, as in chaos.

        Examples
        --------
        A top's height after 2 s, by its mass and by a turn at the start:

        >>> import liestep as ls
        >>> import numpy as np
        >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1.0, rho=[0, 0, 1])
        >>> run = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=2)
        >>> by = np.zeros((len(run), 3, 3))
        >>> by[-1, 2, 2] = 1
        >>> gradient = run.gradient(matrix=by)
        >>> height = lambda m: top.with_(m=m).stepper(0.01).run(velocity=[0.5, 2, 12], until=2).matrix[-1, 2, 2]
        >>> difference = (height(1 + 1e-5) - height(1 - 1e-5)) / 2e-5
        >>> bool(abs(gradient["m"] - difference) < 1e-9), gradient.attitude.shape
        (True, (3,))
        """
        given = {
            "velocity": velocity, "momentum": momentum, "attitude": attitude, "matrix": matrix, "energy": energy,
            "spatial_momentum": spatial_momentum,
        }
        return self._known().gradient(self, given)

    def transition(self) -> Array:
        """The state transition matrix of the run: the derivatives of its end by its start.

        Rows and columns are those of a turn about the axes of the body, rad, and of the body momentum; off SO(3) those of the
        coordinates ``ζ`` of ``g exp ζ̂``, and of the momentum.

        Examples
        --------
        >>> import liestep as ls
        >>> run = ls.body([1, 2, 2.5]).stepper(0.01).run(velocity=[0.01, 2, 0.02], until=3)
        >>> run.transition().shape
        (6, 6)
        """
        return self._known().transition(self.steps, None)

    def lyapunov(self, between: int = 10) -> Array:
        """The Lyapunov exponents over the run, 1/s, in falling order: two for each component of a velocity.

        Parameters
        ----------
        between : int
            The steps from one orthonormalisation to the next: fewer than make a deviation grow a million times.

        Examples
        --------
        A body that turns about its middle axis leaves it by ``√((J₂−J₁)(J₃−J₂)/(J₁J₃)) ω``, here .894 s⁻¹.

        >>> import liestep as ls
        >>> run = ls.body([1, 2, 2.5]).stepper(0.01).run(velocity=[0, 2, 0], until=60)
        >>> round(float(run.lyapunov()[0]), 1)
        0.9
        """
        return self._known().transition(self.steps, whole("between", between, 1, 2**31))

    def _known(self) -> Origin:
        if self._origin is None:
            raise SetupError("the start of this run isn't known: a run of a `Stepper` has derivatives; of bodies in joints take the difference of two runs")
        return self._origin


def _attitudes(run: Any) -> Array:
    """The columns of the attitude, a row for each row."""
    import numpy as np

    end = next(place for place, name in enumerate(run.names) if name.startswith("velocity_"))
    return np.stack([run[name] for name in run.names[1:end]], axis=1)


def _shape(run: Any, name: str) -> tuple[int, ...]:
    """The shape of a quantity of a run."""
    if name == "attitude":
        columns: tuple[int, ...] = _attitudes(run).shape
        return columns
    if name == "matrix" and "q_w" not in run.names:
        raise SetupError("`matrix` is one of SO3: give the derivatives by the columns of the `attitude`")
    shape: tuple[int, ...] = getattr(run, name).shape
    return shape

