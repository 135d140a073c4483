"""Constraints on velocities: closed solutions, gradients of a run's end, and mistakes at their places."""

import math

import liestep as ls
import numpy as np
import pytest

J = [[2, 0, 0], [0, 1.5, 0.4], [0, 0.4, 1]]
START = [-1.2, 0.7, 0]


def suslov() -> ls.Term:
    return ls.body(J) + ls.nonholonomic("SO3", zero="a.dot(Omega)", a=[0, 0, 2])


def test_suslovs_body_has_its_closed_solution() -> None:
    x, y = math.sqrt(2) * START[0], math.sqrt(1.5) * START[1]
    size = math.hypot(x, y)
    u = math.atanh(x / size) - 0.4 * size / (1.5 * math.sqrt(2)) * 3
    exact = [size * math.tanh(u) / math.sqrt(2), size / math.cosh(u) / math.sqrt(1.5), 0]

    def error(step: float, **how: str) -> float:
        run = suslov().stepper(step, **how).run(velocity=START, until=3)
        assert abs(run.velocity[:, 2]).max() < 1e-14
        return float(np.linalg.norm(run.velocity[-1] - exact))

    errors = [error(0.05), error(0.025)]
    assert abs(math.log2(errors[0] / errors[1]) - 2) < 0.02, errors
    assert error(0.05, composition="Suzuki 4") < errors[1] / 50


def test_a_disk_rolls_in_a_circle_and_keeps_its_energy() -> None:
    m, radius, g, theta, precession = 1.2, 0.5, 9.81, 1.1, -1.7
    across, along = m * radius**2 / 4, m * radius**2 / 2
    sin, cos = math.sin(theta), math.cos(theta)
    spin = (across * precession**2 * sin * cos - m * g * radius * cos) / (precession * (along + m * radius**2) * sin)
    disk = ls.lagrangian(
        "SE3", advected={"w": "height"}, velocity="Omega, v", discretise="trapezoid(Cayley)",
        l="Omega.dot(J * Omega) / 2 + m * v.norm_squared() / 2 - m * g * w[3]",
        J=[across, across, along], m=m, g=g, height=[0, 0, 1, 0])
    rolling = sum(
        ls.nonholonomic(
            "SE3", advected={"w": "height"}, velocity="Omega, v",
            zero="{ let n = Vector3::new(w[0], w[1], 0.0); e.dot(v + Omega.cross(n * (-radius / n.norm()))) }",
            e=axis, radius=radius, height=[0, 0, 1, 0])
        for axis in np.eye(3))
    attitude = np.eye(4)
    attitude[1:3, 1:3] = [[cos, -sin], [sin, cos]]
    attitude[:3, 3] = [0, radius * spin / precession, radius * sin]
    run = (disk + rolling).stepper(0.01).run(
        attitude=attitude, velocity=[0, precession * sin, spin, -radius * spin, 0, 0], until=10)
    places = run.attitude.reshape(-1, 4, 4)[:, :3, 3]
    assert abs(np.hypot(places[:, 0], places[:, 1]) - radius * abs(spin / precession)).max() < 5e-3
    assert abs(places[:, 2] - radius * sin).max() < 2e-3
    energy = run["energy"]
    assert abs(energy - energy[0]).max() < 1e-4 * abs(energy[0])


def test_mistakes_have_their_places() -> None:
    with pytest.raises(ls.DeclarationError, match="linear in them, as `a.dot.Omega.` is"):
        ls.nonholonomic("SO3", zero="a.dot(Omega) + 1", a=[0, 0, 1])
    with pytest.raises(ls.SetupError, match="violates the constraint 0"):
        suslov().stepper(0.1).run(velocity=[1, 0, 1], until=1)
    again = suslov() + ls.nonholonomic("SO3", zero="b.dot(Omega)", b=[0, 0, 1])
    with pytest.raises(ls.SetupError, match="constraint 1 .* demands nothing that those before it don't"):
        again.stepper(0.1).run(velocity=START, until=1)
    three = ls.body(J) + sum(ls.nonholonomic("SO3", zero="a.dot(Omega)", a=axis) for axis in np.eye(3))
    with pytest.raises(ls.Error, match="leave no motion on a group of dimension 3"):
        three.stepper(0.1).run(velocity=[0, 0, 0], until=1)
    with pytest.raises(ls.SetupError, match="constraints on velocities"):
        suslov().stepper(0.1, collocation=4).run(velocity=START, until=1)
