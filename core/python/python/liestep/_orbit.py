"""Orbits: Kepler's motion about a far mass, and what changes along it."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import floats, number, vector
from ._signal import Signal
from ._tables import written
from .errors import SetupError

if TYPE_CHECKING:
    from ._arrays import Array


class Orbit:
    """A closed orbit about a far mass, made by `liestep.orbit`. What changes along it are signals: parameters of terms.

    Attributes
    ----------
    period : float
        s.
    rate : float
        The mean motion, rad/s.
    """

    def __init__(self, text: str) -> None:
        self._text, self._native = text, _native.Orbit(text)
        self.period = self._native.period
        self.rate = 2 * pi / self.period

    @property
    def nadir(self) -> Signal:
        """The direction of the mass, in space."""
        return Signal(self, ("nadir", None), "orbit")

    @property
    def distance(self) -> Signal:
        """The distance from the mass, in semi-major axes."""
        return Signal(self, ("distance", None), "orbit")

    @property
    def turning(self) -> Signal:
        """The angular velocity of the direction of the mass, in space, rad/s."""
        return Signal(self, ("turning", None), "orbit")

    def field(self, equator: Any) -> Signal:
        """The field of a dipole in the mass, fixed in space, T, from its value above the dipole's equator, a semi-major axis away."""
        numbers = vector("equator", equator)
        if len(numbers) != 3:
            raise SetupError(f"`equator` is a vector of three numbers, not of {len(numbers)}")
        return Signal(self, ("field", tuple(numbers)), "orbit")

    def place(self, times: Any) -> Array:
        """The places relative to the mass at times, s, in space, in semi-major axes, a row for each."""
        asked = floats("times", times, SetupError)
        return floats("places", self._native.places(asked.ravel().tolist()), SetupError).reshape((*asked.shape, 3))

    def local_vertical(self, time: float = 0.0) -> Array:
        """The axes of the local vertical in space as columns: x ahead, y against the normal of the orbit, z to the mass.

        An attitude relative to it starts a body: ``attitude=orbit.local_vertical() @ relative``, a matrix, as of five degrees of pitch
        ``Rotation.from_euler("y", 5, degrees=True).as_matrix()`` by SciPy. A body that starts at rest relative to these axes turns with
        them: its velocity is ``turn.T @ orbit.turning.at([0])[0]`` with its attitude ``turn``.
        """
        rows = self._native.local_vertical(number("time", time))
        return floats("axes", rows, SetupError).reshape(3, 3)

    def __eq__(self, other: object) -> bool:
        return self._text == other._text if isinstance(other, Orbit) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._text)

    def __reduce__(self) -> tuple[Any, ...]:
        return Orbit, (self._text,)

    def __repr__(self) -> str:
        return f"<Orbit of {self.period:g} s>"


def orbit(**keys: Any) -> Orbit:
    """An orbit by Kepler's laws.

    Parameters
    ----------
    **keys
        Those of the table ``orbit`` of a scene's file, numbers in SI or texts with a unit: ``period``, or ``semi_major_axis`` with
        ``GM``; ``eccentricity``; ``normal``, or ``inclination`` and ``ascending_node`` with ``argument_of_periapsis``; ``phase`` or
        ``true_anomaly``. Or ``position``, ``velocity`` and ``GM``; or ``tle``, two lines.

    Returns
    -------
    Orbit

    Raises
    ------
    SceneError
        Keys that make no closed orbit.

    Examples
    --------
    A satellite in the gradient of gravity, from rest relative to the local vertical:

    >>> import liestep as ls
    >>> orbit = ls.orbit(semi_major_axis="7000 km", GM="398600.4418 km³/s²", inclination="51.6 deg", ascending_node=0)
    >>> J = [90, 100, 20]
    >>> satellite = ls.body(J, kinetic="cayley") + ls.gravity_gradient(J=J, orbit=orbit)
    >>> stepper = satellite.stepper(orbit.period / 500)
    >>> run = stepper.run(attitude=orbit.local_vertical(), velocity=[0, -orbit.rate, 0], until=orbit.period)
    >>> bool(abs((run.axis * orbit.nadir.at(run.time)).sum(axis=1) - 1).max() < 1e-9)
    True
    """
    return Orbit(written(keys))
