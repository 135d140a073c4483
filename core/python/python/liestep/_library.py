"""The library's bodies and effects on SO(3), by their names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import floats, shown, text
from ._declared import Summand, _value
from ._orbit import Orbit
from ._signal import Signal, diagonal
from ._term import Term
from .errors import DeclarationError

if TYPE_CHECKING:
    from ._arrays import Array


def _term(name: str, *directions: str, **parameters: Any) -> Term:
    declaration = _native.library(name)
    if declaration is None:
        raise DeclarationError(f"the library has no `{name}`")
    numbers = {field: _value(field, value) for field, value in parameters.items()}
    return Term.of(*Summand.of(declaration, numbers, name, directions))


def nonstandard(J: Any) -> Any:
    """The nonstandard inertia ``tr(J)/2 I − J`` of an inertia, kg m², by its matrix or its three moments.

    Examples
    --------
    >>> import liestep as ls
    >>> ls.nonstandard([3, 3, 4]).diagonal().tolist()
    [2.0, 2.0, 1.0]
    """
    inertia = J if isinstance(J, Signal) else floats("J", J, DeclarationError)
    if inertia.shape not in ((3,), (3, 3)):
        raise DeclarationError(f"an inertia has three moments or a matrix of three rows, not the shape {inertia.shape}")
    return inertia.mapped(_nonstandard) if isinstance(inertia, Signal) else _nonstandard(inertia[None])[0]


def _nonstandard(values: Array) -> Array:
    import numpy as np

    matrices = diagonal(values) if values.ndim == 2 else values
    traces: Array = np.trace(matrices, axis1=1, axis2=2)[:, None, None]
    return traces / 2 * np.eye(3) - matrices


def _check_body(J: Any) -> None:
    """Refuses an inertia whose principal moments no rigid body has."""
    import numpy as np

    if isinstance(J, Signal):
        return
    matrix = floats("J", J, DeclarationError)
    matrix = diagonal(matrix[None])[0] if matrix.ndim == 1 else matrix
    if matrix.shape != (3, 3) or abs(matrix - matrix.T).max() > 1e-12 * abs(matrix).max():
        return
    least, middle, largest = np.linalg.eigvalsh(matrix)
    if least > 0 and largest > (middle + least) * (1 + 1e-12):
        raise DeclarationError(
            f"no body has this inertia: {largest:g} > {middle:g} + {least:g}, and a principal moment is at most the sum of the "
            "others; if it is meant, as with rotors or in a fluid, write `effective=True`"
        )


def body(J: Any, *, kinetic: str = "rigid", effective: bool = False) -> Term:
    """A rigid body about its fixed point or its centre of mass.

    Parameters
    ----------
    J : array_like
        Inertia, kg m²: three principal moments, or the matrix ``∫ (|x|² I − x xᵀ) dm`` in the axes of the body. Off the
        diagonal it has products of inertia with a minus: ``J_xy = −∫ x y dm``.
    kinetic : {"rigid", "cayley", "geodesic", "fourth_order", "sixth_order"}
        How its energy is discretised: (3.13) of the thesis, or as the library's body of that name.
    effective : bool
        Whether `J` may be what no rigid body has, as with rotors or in a fluid: any that is positive definite.

    Raises
    ------
    DeclarationError
        If a principal moment is above the sum of the others, and `effective` isn't said.

    Examples
    --------
    >>> import liestep as ls
    >>> ls.body([3, 3, 4]).name
    'rigid_body'
    """
    import numpy as np

    if not isinstance(effective, (bool, np.bool_)):
        raise DeclarationError(f"`effective` is true or false, not {shown(effective)}")
    if not effective:
        _check_body(J)
    if text("kinetic", kinetic) == "rigid":
        return _term("rigid_body", J_d=nonstandard(J))
    if not _native.library(f"{kinetic}_body"):
        known = '"rigid", "cayley", "geodesic", "fourth_order", "sixth_order"'
        raise DeclarationError(f"`kinetic` is one of {known}, not {shown(kinetic)}")
    return _term(f"{kinetic}_body", J=J)


def gravity(*, m: float, rho: Any, g: float = 9.81, up: Any = (0, 0, 1)) -> Term:
    """The weight of a body that turns about a fixed point: mass, kg, and centre of mass, m, in the body.

    ``up`` is a direction of space, of length one.
    """
    return _term("gravity", "up", m=m, g=g, rho=rho, up=up)


def gravity_gradient(*, J: Any, GM: Any = None, r: Any = None, direction: Any = None, orbit: Orbit | None = None) -> Term:
    """The torque of a far mass ``GM``, m³/s², at the distance `r`, m, on a body of inertia `J`.

    ``direction`` is one of space, of length one. Along a `liestep.orbit` all three are those of the orbit.
    """
    if orbit is not None:
        if not isinstance(orbit, Orbit) or (GM, r, direction) != (None, None, None):
            raise DeclarationError("an orbit is one of `ls.orbit(…)`, and has `GM`, `r` and `direction`: leave these out")
        # Lengths are in semi-major axes.
        GM, r, direction = orbit.rate**2, orbit.distance, orbit.nadir
    elif GM is None or r is None or direction is None:
        raise DeclarationError("a gravity gradient has an `orbit`, or `GM`, `r` and `direction`")
    return _term("gravity_gradient", "direction", GM=GM, r=r, J=J, direction=direction)


def dipole(*, moment: Any, field: Any) -> Term:
    """A magnetic moment of the body, A m², in a field of space, T."""
    return _term("dipole", moment=moment, field=field)


def spring(*, k: float, length: float, at: Any, anchor: Any) -> Term:
    """A spring of stiffness `k`, N/m, from a point of the body to one of space, m."""
    return _term("spring", k=k, length=length, at=at, anchor=anchor)


def rotor(*, spin: Any) -> Term:
    """A rotor whose momentum about its axis stays the same in the body, kg m²/s."""
    return _term("rotor", spin=spin)


def drag(*, c: float, J: Any) -> Term:
    """A torque against the velocity: coefficient, N m s, and the inertia of the body, kg m²."""
    return _term("drag", c=c, J=J)


def air_drag(*, c: Any, air: Any, J: Any) -> Term:
    """Drag in air that turns: coefficient, N m s, the angular velocity of the air in space, rad/s, and the inertia of the body, kg m².

    Along an orbit the air turns with the satellite's place by ``air=orbit.turning``.
    """
    return _term("air_drag", c=c, air=air, J=J)


def magnetic_damping(*, k: float, field: Any, J: Any) -> Term:
    """Damping across a magnetic field of space, T, with the gain `k`, A m² s/T."""
    return _term("magnetic_damping", k=k, field=field, J=J)


def torque(torque: Any) -> Term:
    """A torque in the axes of the body, N m: constant, or a signal over time, `liestep.signal`."""
    return _term("torque", torque=torque)


def thrust(*, at: Any, thrust: Any) -> Term:
    """An engine at a point of the body, m, with its force, N."""
    return _term("thrust", at=at, thrust=thrust)
