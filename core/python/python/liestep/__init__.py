"""liestep: integrators that keep what the motion keeps, from a declared Lagrangian.

>>> import liestep as ls
>>> top = ls.lagrangian("SO3", advected={"w": "up"},
...     l_d="((F - I) * J_d * (F - I).transpose()).trace() / (2 * h) - h * m * g * w.dot(rho + F * rho) / 2",
...     J_d=[2, 2, 1], m=1, g=9.81, rho=[0, 0, 1], up=[0, 0, 1])
>>> run = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=100)
>>> bool(abs(run.spatial_momentum[:, 2] - 48).max() < 1e-11)
True
"""

from . import _calls, errors
from ._control import Control, Plan
from ._declared import contravariant, covariant, mixed, point
from ._ensemble import Ensemble, Many, Spread, normal, rotation, uniform
from ._estimate import Fit
from ._event import Moment
from ._gradient import Gradient
from ._jax import jax
from ._library import (
    air_drag, body, dipole, drag, gravity, gravity_gradient, magnetic_damping, nonstandard, rotor, spring, thrust, torque,
)
from ._orbit import Orbit, orbit
from ._run import Columns, Happenings, Run, Scene, SceneRun, scene
from ._signal import Signal, signal
from ._state import State
from ._stepper import Stepper, euler, schemes, translation
from ._term import Term, force, hamiltonian, lagrangian, nonholonomic
from ._torch import torch
from .errors import CallError, ColumnError, DeclarationError, Error, SceneError, SetupError, StepError, StoreError

__version__ = "0.1.0"
__all__ = [
    "CallError", "ColumnError", "Columns", "Control", "DeclarationError", "Ensemble", "Error", "Fit", "Gradient", "Happenings", "Many", "Moment", "Orbit", "Plan", "Run",
    "Scene", "SceneError", "SceneRun",
    "SetupError", "Signal", "Spread", "State", "StepError", "Stepper", "StoreError", "Term", "air_drag", "body", "contravariant", "covariant",
    "dipole", "drag", "errors", "euler", "force", "gravity", "gravity_gradient", "hamiltonian", "jax", "lagrangian", "magnetic_damping", "mixed",
    "nonholonomic", "nonstandard", "normal", "orbit", "point", "rotation", "rotor", "scene", "schemes", "signal", "spring", "thrust", "torch", "torque", "translation", "uniform",
]

_calls.advise(globals(), __all__)
