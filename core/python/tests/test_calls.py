"""Hostile calls of every public function and method: each returns, or raises an error of the family or a ``TypeError``.

All of 2,000, some minutes: ``LIESTEP_CALLS=2000 pytest tests/test_calls.py -s``; ``LIESTEP_SEED`` is another seed.
"""

from __future__ import annotations

import collections
import datetime
import decimal
import faulthandler
import fractions
import inspect
import os
import random
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import liestep as ls

#: Longer than any of the calls takes, on a machine shared with others, s: the test ends with the place of a call that hangs.
PATIENCE = 120
COUNT, SEED = int(os.environ.get("LIESTEP_CALLS", "150")), int(os.environ.get("LIESTEP_SEED", "1"))


class Raising:
    """An object of which nothing can be had."""

    def _raise(self, *_: object, **__: object) -> Any:
        raise RuntimeError("nothing can be had of this")

    __float__ = __int__ = __index__ = __len__ = __iter__ = __array__ = __getitem__ = __bool__ = __eq__ = __complex__ = _raise
    __fspath__ = keys = items = _raise
    __hash__ = object.__hash__

    def __repr__(self) -> str:
        return self._raise()


class Endless(list):  # type: ignore[type-arg]
    """A list of which the length isn't that of its items."""

    def __len__(self) -> int:
        return 2**40


cyclic: list[Any] = []
cyclic.append(cyclic)
TURN = {"velocity": [0.1, 0.2, 1]}
BODY = ls.body([1, 2, 2.5])
STEPPER = BODY.stepper(0.1)
RUN = STEPPER.run(**TURN, until=1, events={"fast": "velocity_z > 0.9"})
SATELLITE = ls.orbit(period=6000, normal=[0, 0, 1])
SIGNAL = ls.signal([0, 1, 2], [[0, 0, 1], [0, 1, 0], [1, 0, 0]], between="lines")
TABLES = {"title": "a", "body": {"moments": [1, 2, 2.5]}, "start": {"euler": [0, 0, 0], "velocity": [0, 1, 2]}, "run": {"step": 0.1, "duration": 1}}
SCENE = ls.scene(TABLES)
PUSHED = BODY + ls.torque([0.1, 0, 0])
KINETIC = "1/2 * Omega.dot(J * Omega)"

HOSTILE: list[Any] = [
    float("nan"), float("inf"), -float("inf"), -1, 0, -0.0, 1e308, -1e308, 5e-324, 1e-300, 2**70, -(2**70), 10**400, 1j, True, None, "", "a",
    "\x00", "\ud800", "1 m", "nan", b"x", [], [[]], {}, (), [1], [1, 2], [float("nan")] * 3, [float("inf")] * 3, [1e308] * 3, [5e-324] * 3,
    [0, 0, 0], [[1, 2], [3]], [None] * 3, ["a", "b", "c"], [1j, 0, 0], [[0, 0, 1]], object(), object, Raising(), [Raising()] * 3, Endless([1, 2, 3]),
    cyclic, {"a": 1}, {1: 2}, {"": ""}, {"velocity": Raising()}, set(), {1, 2, 3}, lambda: 1, lambda *_: float("nan"), np, ls, BODY, RUN, SIGNAL,
    SATELLITE, Ellipsis, NotImplemented, slice(3), range(3), iter([1, 2, 3]), fractions.Fraction(1, 3), decimal.Decimal("NaN"),
    datetime.timedelta(seconds=1), np.ma.masked, np.ma.masked_array([1.0, 2, 3], [0, 1, 0]), np.array([1j, 2, 3]), np.zeros((0, 3)),
    np.zeros((3, 0)), np.array(["a"]), np.array(None), np.array([1, 2, 3], dtype=object), np.float32("nan"), np.zeros((3, 3)), np.ones((3, 3)),
    np.eye(4), np.full((3, 3), np.nan), np.datetime64("now"), np.zeros(3, dtype=[("x", float)]), np.arange(1000.0), np.zeros((2, 3, 4)), "x" * 10_000,
    "(" * 3000, "Omega.dot(Omega)", "F", "h", "Cayley", -0.1, 1e-9, 0.1, 3, 7,
]

#: Each public function and method, with arguments that are right.
CALLS: list[tuple[Callable[..., Any], dict[str, Any]]] = [
    (ls.air_drag, {"c": 0.1, "air": [0, 0, 1], "J": [1, 2, 2.5]}), (ls.body, {"J": [1, 2, 2.5], "kinetic": "rigid", "effective": False}),
    (ls.contravariant, {"value": [1, 2, 3]}), (ls.covariant, {"value": np.eye(3)}), (ls.mixed, {"value": np.eye(3)}), (ls.point, {"coordinates": [1, 2, 3]}),
    (ls.dipole, {"moment": [1, 0, 0], "field": [0, 0, 1]}), (ls.drag, {"c": 0.1, "J": [1, 2, 2.5]}),
    (ls.euler, {"precession": 1.0, "nutation": 0.5, "spin": 0.1, "degrees": False}), (ls.rotor, {"spin": [0, 0, 1]}),
    (ls.gravity, {"m": 1, "rho": [0, 0, 1], "g": 9.81, "up": [0, 0, 1]}), (ls.magnetic_damping, {"k": 0.1, "field": [0, 0, 1], "J": [1, 2, 2.5]}),
    (ls.gravity_gradient, {"J": [1, 2, 2.5], "GM": 4e14, "r": 7e6, "direction": [1, 0, 0]}), (ls.gravity_gradient, {"J": [1, 2, 2.5], "orbit": SATELLITE}),
    (ls.spring, {"k": 10, "length": 0.5, "at": [1, 0, 0], "anchor": [2, 0, 0]}), (ls.thrust, {"at": [1, 0, 0], "thrust": [0, 1, 0]}),
    (ls.torque, {"torque": [0, 0, 1]}), (ls.nonstandard, {"J": [1, 2, 2.5]}), (ls.normal, {"mean": 1.0, "deviation": 0.1}),
    (ls.uniform, {"least": 0.0, "end": 1.0}), (ls.rotation, {}), (ls.schemes, {}), (ls.translation, {"shift": [1, 2, 3]}),
    (ls.force, {"group": "SO3", "work": "h * t.dot(eta)", "advected": None, "displacement": None, "generators": None, "t": [0, 0, 1]}),
    (ls.lagrangian, {"group": "SO3", "l": KINETIC, "discretise": "trapezoid(Cayley)", "velocity": "Omega", "advected": None, "generators": None, "J": [1, 2, 2.5]}),
    (ls.lagrangian, {"group": "SO3", "l_d": "((F - I) * J * (F - I).transpose()).trace() / (2 * h) - h * w.dot(a)", "advected": {"w": "up"}, "pace": None,
                     "J": [1, 2, 2.5], "a": [0, 0, 1], "up": [0, 0, 1]}),
    (ls.lagrangian, {"group": {"F": "SO3", "d": "R3"}, "velocity": "Omega, v", "l": "1/2 * Omega.dot(J * Omega) + v.norm_squared()",
                     "discretise": "trapezoid(Cayley)", "J": [1, 2, 2.5]}),
    (ls.hamiltonian, {"group": "SO3", "h": "1/2 * mu.dot(K * mu)", "momentum": "mu", "advected": None, "generators": None, "K": np.eye(3)}),
    (ls.nonholonomic, {"group": "SO3", "zero": "a.dot(Omega)", "velocity": "Omega", "discretise": "trapezoid(Cayley)", "advected": None, "a": [0, 0, 1]}),
    (ls.orbit, {"period": 6000, "normal": [0, 0, 1], "eccentricity": 0.1, "phase": 0.2, "periapsis": [1, 0, 0]}),
    (ls.orbit, {"semi_major_axis": 7e6, "GM": 4e14, "inclination": 1, "ascending_node": 0.3, "true_anomaly": 0.1}),
    (ls.scene, {"path": TABLES, "text": None}), (ls.scene, {"path": "x.toml", "text": SCENE.text}),
    (ls.signal, {"times": [0, 1], "values": [0, 1], "between": "lines"}), (ls.signal, {"times": np.sin}),
    (ls.jax, {"term": BODY, "step": 0.1, "until": 1, "every": 1, "times": None, "attitude": None}),
    (ls.torch, {"term": BODY, "step": 0.1, "until": 1, "every": 1, "times": None, "attitude": None}),
    (BODY.stepper, {"step": 0.1, "composition": "Suzuki 4", "substeps": 2}), (BODY.stepper, {"step": 0.1, "splitting": "Strang"}),
    (BODY.stepper, {"step": 0.1, "collocation": 4}), (BODY.stepper, {"step": 0.1, "density": {"turn": 1.0}}), (BODY.stepper, {"step": 0.1, "processed": "processed 3-6 a"}),
    (BODY.run, {**TURN, "until": 1, "attitude": None}), (BODY.for_accuracy, {"tolerance": 1e-4, **TURN, "until": 1}), (PUSHED.with_, {"torque": [0, 0, 1]}),
    (BODY.ensemble, {"members": 3, "step": 0.1, **TURN, "seed": 1, "attitude": ls.rotation()}),
    (BODY.control, {"step": 0.1, "steps": 3, "goal": [1, 0, 0, 0], "bound": 1.0, "axes": "xyz", "keep_out": None}),
    (BODY.estimate, {"step": 0.1, "readings": {"velocity": (RUN.velocity, 1e-3)}, "unknown": ["J_d"], "every": 1, "first": None, "known": None}),
    (STEPPER.run, {**TURN, "until": 1, "every": 1, "attitude": [1, 0, 0, 0], "events": None}), (STEPPER.run, {"momentum": [1, 2, 3], "times": [0, 0.5]}),
    (STEPPER.run, {**TURN, "until": 1, "events": {"a": "tilt > 1 deg"}}), (STEPPER.start, {**TURN, "attitude": None}), (STEPPER.start, {"momentum": [1, 2, 3]}),
    (lambda **given: STEPPER.start(**TURN).step(**given), {"steps": 2, "torque": [0, 0, 1], "force": None, "given": None}),
    (lambda **given: PUSHED.stepper(0.1).start(**TURN).step(**given), {"steps": 1, "given": {"torque": [0, 0, 1]}}),
    (lambda **given: SCENE.start().step(**given), {"steps": 2, "torque": [0, 0, 1], "force": None}),
    (RUN.gradient, {"velocity": [0, 0, 1], "momentum": None, "attitude": None, "matrix": None, "energy": None, "spatial_momentum": None}),
    (RUN.group, {"start": "velocity_"}), (RUN.lyapunov, {"between": 3}), (RUN.transition, {}), (RUN.to_pandas, {}), (RUN.svg, {}), (RUN.__getitem__, {"name": "energy"}),
    (RUN.events["fast"].group, {"start": "velocity_"}), (RUN.events.__getitem__, {"name": "fast"}),
    (SATELLITE.field, {"equator": [0, 0, 1]}), (SATELLITE.local_vertical, {"time": 1.0}), (SATELLITE.place, {"times": [0, 1]}),
    (SIGNAL.at, {"times": [0, 1]}), (SIGNAL.mapped, {"function": lambda x: 2 * x}), (SIGNAL.key, {}), (SIGNAL.table, {}),
    (BODY.control(step=0.1, steps=3, goal=[1, 0, 0, 0]).solve, {"progress": None, "tolerance": 1e-6, "iterations": 3}),
    (BODY.ensemble(3, step=0.1, **TURN).run, {"folder": "kept", "until": 0.2, "every": None, "threads": 1, "share": "0/1", "chunk": None, "progress": False}),
    (BODY.__add__, {"other": PUSHED}), (BODY.c, {"compensated": True}), (SCENE.run, {}), (SCENE.start, {}), (SCENE.run().group, {"start": "velocity_"}), (SCENE.run().html, {}), (RUN.html, {}),
]

#: Methods that the list has by another way, or that take what Python's own do.
ELSEWHERE = {
    "Columns", "Many", "Fit", "Moment", "Happenings", "Plan", "SceneRun", "Term.of", "State.copy", "State.step", "Run.html", "Run.plot",
}


def test_the_list_has_every_public_function_and_method():
    listed = {getattr(call, "__qualname__", "") for call, _ in CALLS}
    missing = []
    for name in ls.__all__:
        one = getattr(ls, name)
        if inspect.isfunction(one):
            missing += [name] * (name not in listed)
        elif inspect.isclass(one) and not issubclass(one, Exception) and name not in ELSEWHERE:
            methods = [key for key, value in inspect.getmembers(one, inspect.isfunction) if not key.startswith("_")]
            own = {call.rsplit(".", 1)[-1] for call in listed if "." in call}
            missing += [f"{name}.{key}" for key in methods if key not in own and f"{name}.{key}" not in ELSEWHERE]
    assert not missing, missing


def hostile(draw: random.Random) -> tuple[Callable[..., Any], dict[str, Any]]:
    """A call with a wrong argument or two, or one that the function doesn't have."""
    call, right = draw.choice(CALLS)
    given = dict(right)
    for name in draw.sample(list(right), min(len(right), 1 + (draw.random() < 0.2))):
        given[name] = draw.choice(HOSTILE)
    if not right or draw.random() < 0.05:
        given[draw.choice(["unknown", "velocity", "h", "self", ""])] = draw.choice(HOSTILE)
    return call, given


def test_hostile_calls(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    draw, outcome, wrong = random.Random(SEED), collections.Counter[str](), []
    for number in range(COUNT):
        call, given = hostile(draw)
        faulthandler.dump_traceback_later(PATIENCE, exit=True)
        try:
            with warnings.catch_warnings(), np.errstate(all="ignore"):
                warnings.simplefilter("ignore")
                call(**given)
            outcome["returned"] += 1
        except ls.Error as error:
            outcome["Error"] += 1
            if not str(error):
                wrong.append((number, call, "an empty message"))
        except TypeError:
            outcome["TypeError"] += 1
        except BaseException as error:  # noqa: BLE001
            shown = {name: f"{value!r:.60}" if not isinstance(value, Raising) and "Raising" not in f"{type(value)}" else "Raising()"
                     for name, value in given.items() if not _raises(value)}
            wrong.append((number, getattr(call, "__qualname__", call), f"{type(error).__name__}: {error!s:.100}", shown))
        finally:
            faulthandler.cancel_dump_traceback_later()
    print(f"{COUNT} hostile calls by the seed {SEED}: {dict(outcome)}, {len(wrong)} wrong")
    assert not wrong, "\n".join(map(str, wrong))


def _raises(value: Any) -> bool:
    try:
        repr(value)
    except RuntimeError:
        return True
    return False
