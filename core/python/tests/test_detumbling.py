"""A satellite detumbled by its magnetic torquers along an orbit, beside Euler's equations by scipy."""

from __future__ import annotations

import numpy as np
import pytest

import liestep as ls

integrate = pytest.importorskip("scipy.integrate")

MOMENTS = np.array([0.0108, 0.0108, 0.0043])
GAIN, END = 1e4, 5800
# A circle 600 km above the equator's radius, almost over the poles; node and argument of the start, rad.
RADIUS, GM = 6.978137e6, 3.986004418e14
NODE, INCLINATION, ARGUMENT = np.radians([59.4276, 97.787, 144.8873])
# T, of 31.2 µT at the planet's mean radius.
EQUATOR = 3.12e-5 * (6.3712e6 / RADIUS) ** 3


def run(step: float, terms: dict[str, object]) -> ls.SceneRun:
    tables = {
        "title": "A small satellite",
        "body": {"moments": MOMENTS, "kinetic": "geodesic"},
        "start": {"euler": [0, 0, 0], "velocity": ["20 deg/s"] * 3},
        "orbit": {
            "semi_major_axis": RADIUS, "GM": GM, "inclination": INCLINATION, "ascending_node": NODE, "argument_of_periapsis": ARGUMENT},
        "run": {"duration": END, "step": step},
        "output": {"columns": ["velocity"], "every": round(500 / step)},
    }
    return ls.scene(tables | terms).run()


def speeds(ended: ls.SceneRun) -> np.ndarray:
    """The speeds after 500 s and at the end, deg/s."""
    speed = np.linalg.norm([ended[f"velocity_{axis}"] for axis in "xyz"], axis=0)
    return np.degrees(speed[[1, -1]])


def expected(has_change_of_the_orbit: bool) -> np.ndarray:
    """The same speeds with the moment -k db/dt, whose rate has the field's own change along the orbit or not."""
    turn_of_node = np.array([np.cos(NODE), np.sin(NODE), 0])
    across = np.array([-np.sin(NODE) * np.cos(INCLINATION), np.cos(NODE) * np.cos(INCLINATION), np.sin(INCLINATION)])
    rate = np.sqrt(GM / RADIUS**3)

    def field(t: float) -> tuple[np.ndarray, np.ndarray]:
        cos, sin = np.cos(ARGUMENT + rate * t), np.sin(ARGUMENT + rate * t)
        place, moving = turn_of_node * cos + across * sin, rate * (across * cos - turn_of_node * sin)
        axis = np.array([0, 0, 1])
        return EQUATOR * (axis - 3 * place * place[2]), -3 * EQUATOR * (moving * place[2] + place * moving[2])

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        w, x = y[0] / np.linalg.norm(y[:4]), y[1:4] / np.linalg.norm(y[:4])
        turn = y[4:]

        def to_body(v: np.ndarray) -> np.ndarray:
            return v - 2 * w * np.cross(x, v) + 2 * np.cross(x, np.cross(x, v))

        b, change = map(to_body, field(t))
        moment = -GAIN * (np.cross(b, turn) + has_change_of_the_orbit * change)
        spun = (np.cross(moment, b) - np.cross(turn, MOMENTS * turn)) / MOMENTS
        return np.concatenate([[-x @ turn / 2], (w * turn + np.cross(x, turn)) / 2, spun])

    start = np.concatenate([[1, 0, 0, 0], np.radians([20, 20, 20])])
    ends = integrate.solve_ivp(rates, (0, END), start, method="DOP853", rtol=1e-9, atol=1e-11, t_eval=(500, END))
    return np.degrees(np.linalg.norm(ends.y[4:], axis=0))


def test_the_effect_leaves_the_change_along_the_orbit_out():
    right = expected(False)
    assert right == pytest.approx([28.9649, 1.09345], abs=5.1e-5)
    terms = {"magnetic_damping": {"k": GAIN, "field": {"equator": [0, 0, EQUATOR]}}}
    coarse, fine = (speeds(run(step, terms)) for step in (0.1, 0.05))
    # The step is of second order.
    assert (4 * fine - coarse) / 3 == pytest.approx(right, rel=2e-5)
    assert fine == pytest.approx(right, rel=1e-4)


def test_readings_have_it():
    right = expected(True)
    assert right[1] == pytest.approx(1.1097, abs=5e-5)
    law = "(-k / every * (b - b_before)).cross(b)"
    terms = {"control": [{"torque": law, "k": GAIN, "B": {"equator": [0, 0, EQUATOR]}, "advected": {"b": "B"}}]}
    # A difference of readings is late by half the time between them, and the torque is held.
    coarse, middle, fine = (speeds(run(step, terms))[1] for step in (0.2, 0.1, 0.05))
    assert (8 * fine - 6 * middle + coarse) / 3 == pytest.approx(right[1], rel=1e-4)
    assert fine == pytest.approx(1.1110, abs=1e-4)
