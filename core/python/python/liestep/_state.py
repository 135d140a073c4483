"""States: motions that are stepped one by one, with torques in between."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from . import _native
from ._arrays import floats, shown, text, whole
from .errors import SetupError

if TYPE_CHECKING:
    from ._arrays import Array


#: Largest number of steps at once.
MOST = 2**52


class Origin(Protocol):
    """The source of a state: a stepper, or a scene's file."""

    def _resumed(self, numbers: list[float]) -> _native.State: ...

    def _seen(self, numbers: list[float]) -> dict[str, Any]: ...

    def _given(self, parameters: Mapping[str, Any]) -> list[float]: ...


class BodyState(NamedTuple):
    """One of several bodies.

    Attributes
    ----------
    attitude : array
        A matrix, body to space.
    position, moving : array
        The centre of mass in space, m, and its velocity, m/s.
    velocity : array
        The angular velocity in the axes of the body, rad/s.
    """

    attitude: Array
    position: Array
    velocity: Array
    moving: Array


class State:
    """The state of a motion, which `step` moves on; `liestep.Stepper.start` makes it.

    A state compares with others of the same stepper, is copied by `copy`, and pickles: it goes on to the same bits. After an
    error it is as it was. Threads step copies: while one makes many steps, another that reads is refused.

    Examples
    --------
    A body is braked by a torque against its velocity.

    >>> import liestep as ls
    >>> state = ls.body([2, 3, 4.5]).stepper(0.01).start(velocity=[0.5, -1, 2])
    >>> for _ in range(1000):
    ...     state.step(torque=-2 * state.velocity)
    >>> bool(abs(state.velocity).max() < 0.1), round(state.time, 9)
    (True, 10.0)
    """

    __slots__ = ("_native", "_of")

    def __init__(self, of: Origin, native: _native.State) -> None:
        self._of, self._native = of, native

    def step(
        self, steps: int = 1, *, torque: Any = None, force: Mapping[str, Any] | None = None,
        given: Mapping[str, Any] | None = None,
    ) -> None:
        """Makes a step, or several.

        Parameters
        ----------
        steps : int
            How many: all of them, or none if one has no solution.
        torque : array_like or mapping, optional
            What acts during these steps, in the axes of the body: on SO(3) a torque, N m; on any group a component for each
            of the velocity's. Half of its impulse ``h f`` is added to the momentum before each step and half behind it, so
            that what is evaluated in the middle of a step leaves the method of second order. Of several bodies by names: of
            joints a number, N m about the axis or N along the rail of a slider, and of bodies three, N m in their axes. Of wheels
            of a file's scene by their names, too: a number, N m, that is added to the torque of the motor within its limits.
        force : mapping, optional
            Of several bodies what acts on the centres of mass, N, in space, by the names of bodies.

        given : mapping, optional
            Other values of parameters during these steps, by the names of `liestep.Term.with_`: the input of a force of your
            own, a field that turns. Momentum and attitude go on; what is advected, the energy and the velocity between steps
            are those of the parameters themselves.

        Raises
        ------
        SetupError
            The torque is no such vector.
        DeclarationError
            There is no such parameter.
        StepError
            A step has no solution.

        Examples
        --------
        A spring is cut for a second.

        >>> import liestep as ls
        >>> top = ls.body([3, 3, 4]) + ls.spring(k=100, length=1, at=[0, 0, 1], anchor=[0, 0, 3])
        >>> state = top.stepper(0.01).start(velocity=[0.1, 0, 2])
        >>> state.step(100, given={"k": 0})
        """
        numbers = None if given is None else self._of._given(given)
        if steps.__class__ is not int or not 0 < steps < MOST:
            whole("steps", steps, 1, MOST)
        motors: list[tuple[str, float]] = []
        if force is not None or isinstance(torque, Mapping):
            torque, motors = self._native.inputs(_named("torque", torque), _named("force", force))
        self._native.step(steps, torque, numbers, motors)

    @property
    def time(self) -> float:
        """The time since the start, s."""
        return self._native.time

    @property
    def steps(self) -> int:
        """The number of steps since the start."""
        return self._native.steps

    @property
    def velocity(self) -> Array:
        """The body velocity, on SO(3) in the axes of the body in rad/s."""
        return _array(self._native.velocity)

    @property
    def momentum(self) -> Array:
        """The body momentum, on SO(3) in the axes of the body in kg m²/s."""
        return _array(self._native.momentum)

    @property
    def spatial_momentum(self) -> Array:
        """The momentum in space, ``Ad*`` of the attitude's inverse; on SO(3) the angular momentum, kg m²/s."""
        return _array(self._native.spatial_momentum)

    @property
    def energy(self) -> float:
        """The energy, J."""
        return self._native.energy

    @property
    def attitude(self) -> Any:
        """The attitude, as `liestep.Stepper.start` takes it: a matrix, body to space; on a product a list of matrices."""
        return matrices(self._native.attitude, self._native.factors)

    @property
    def bodies(self) -> dict[str, BodyState]:
        """The bodies by their names; none of one body."""
        attitude, velocity = self.attitude, self.velocity
        return {
            name: BodyState(
                attitude[2 * at], attitude[2 * at + 1][:3, 3], velocity[6 * at : 6 * at + 3], velocity[6 * at + 3 : 6 * at + 6]
            )
            for at, name in enumerate(self._native.bodies)
        }

    @property
    def joints(self) -> dict[str, tuple[float, float]]:
        """The joints of several bodies that have a name and one coordinate: angle, rad, or shift, m, and its rate.

        They are those of a pin, a plane or a slider: of the second body relative to the first, an angle between −π and π.
        """
        return {name: (coordinate, rate) for name, coordinate, rate in self._native.joints}

    @property
    def wheels(self) -> dict[str, float]:
        """The speeds of the wheels of a file's scene relative to their bodies, rad/s, by their names.

        Examples
        --------
        A wheel takes the momentum of a body that turns about its axis.

        >>> import liestep as ls
        >>> scene = ls.scene({
        ...     "body": {"moments": [0.2, 0.25, 0.3]}, "start": {"velocity": [0, 0, 0.1]}, "run": {"step": 0.01, "duration": 1},
        ...     "wheel": [{"name": "yaw", "axis": [0, 0, 1], "inertia": 1e-3, "largest_torque": 0.02}],
        ... })
        >>> state = scene.start()
        >>> for _ in range(1000):
        ...     state.step(torque={"yaw": 0.1 * state.velocity[2]})
        >>> bool(abs(state.velocity[2]) < 4e-3), 28 < state.wheels["yaw"] < 30
        (True, True)
        """
        return dict(self._native.wheels)

    @property
    def advected(self) -> dict[str, Any]:
        """The advected values as the body sees them, by the names of their values in space.

        Examples
        --------
        >>> import liestep as ls
        >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1])
        >>> state = top.stepper(0.01).start(attitude=ls.euler(0, 90, degrees=True), velocity=[0, 0, 12])
        >>> state.advected["up"].round(12).tolist()
        [0.0, 1.0, 0.0]
        """
        return self._of._seen(self._native.advected)

    def copy(self) -> State:
        """Another state, which goes on from here."""
        return State(self._of, self._native.copy())

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> State:
        return self.copy()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, State):
            return NotImplemented
        return self._native.numbers == other._native.numbers and self._of.__reduce__() == other._of.__reduce__()

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _resumed, (self._of, self._native.numbers)

    def __repr__(self) -> str:
        return f"<State of {self._of!r} at {self.time:g} s>"


def _named(name: str, values: Any) -> _native.Named:
    """Vectors by names; a number is a vector of one."""
    if not isinstance(values, Mapping):
        if values is None:
            return []
        raise SetupError(f'`{name}` of several bodies is by names, as {{"elbow": 0.3}}, not {shown(values)}')
    return [(text(name, key), floats(name, value, SetupError).ravel().tolist()) for key, value in values.items()]


def matrices(numbers: list[float], rows: list[int]) -> Any:
    """The matrices of an attitude, or the one that there is."""
    entries, found, first = _array(numbers), [], 0
    for row in rows:
        found.append(entries[first : first + row * row].reshape(row, row))
        first += row * row
    return found if len(found) > 1 else found[0]


def _array(numbers: list[float]) -> Array:
    import numpy as np

    return np.array(numbers)


def _resumed(of: Origin, numbers: list[float]) -> State:
    return State(of, of._resumed(numbers))
