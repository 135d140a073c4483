"""Constraints on velocities: closed solutions, gradients of a run's end, and mistakes at their places."""

import math

import liestep as ls
import numpy as np
import pytest
from test_gradients import changed, difference, names, weights

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


def rolling_disk(m=1.2, radius=0.5, g=9.81):
    """A disk of these moments, and the start of its motion in a circle: attitude and velocity."""
    theta, precession = 1.1, -1.7
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
    return disk + rolling, attitude, np.array([0, precession * sin, spin, -radius * spin, 0, 0]), precession


def test_a_disk_rolls_in_a_circle_and_keeps_its_energy() -> None:
    disk, attitude, velocity, precession = rolling_disk()
    run = disk.stepper(0.01).run(attitude=attitude, velocity=velocity, until=10)
    places = run.attitude.reshape(-1, 4, 4)[:, :3, 3]
    assert abs(np.hypot(places[:, 0], places[:, 1]) - 0.5 * abs(velocity[2] / precession)).max() < 5e-3
    assert abs(places[:, 2] - 0.5 * math.sin(1.1)).max() < 2e-3
    energy = run["energy"]
    assert abs(energy - energy[0]).max() < 1e-4 * abs(energy[0])


def sleigh() -> ls.Term:
    plate = ls.lagrangian("SE2", velocity="xi", discretise="trapezoid(Cayley)", m=1.3, i=0.4, a=0.6,
                          l="m * (xi[1].powi(2) + (xi[2] + a * xi[0]).powi(2)) / 2 + i * xi[0].powi(2) / 2")
    return plate + ls.nonholonomic("SE2", velocity="xi", zero="s * xi[2]", s=1.0)


@pytest.mark.parametrize("method", [{}, {"composition": "Suzuki 4"}])
@pytest.mark.parametrize("case", ["Suslov", "sleigh", "disk"])
def test_gradients_are_those_of_the_constrained_motion(case: str, method: dict[str, str]) -> None:
    """Derivatives by the start, along what the constraints admit, and by all parameters, to 1e-7."""
    attitude, fixed = None, ("a", "e", "height", "radius")
    if case == "Suslov":
        term, velocity, admitted = suslov(), np.array(START), np.eye(3)[:2]
    elif case == "sleigh":
        term, velocity, admitted, fixed = sleigh(), np.array([1.1, -0.8, 0]), np.eye(3)[:2], ()
    else:
        term, attitude, velocity, _ = rolling_disk()
        # Turning about the diameter that points down, spinning, and tilting: the point of contact is at −R e_2.
        admitted = np.array([[0, 1, 0, 0, 0, 0], [0, 0, 1, -0.5, 0, 0], [1, 0, 0, 0, 0, 0.5]])

    def run(term, velocity=velocity, attitude=attitude):
        return term.stepper(0.05, **method).run(velocity=velocity, attitude=attitude, times=[0.1, 0.37, 0.5])

    made = run(term)
    n = len(velocity)
    shown = {"matrix": (3, 3, 3)} if case == "Suslov" else {"attitude": (3, made.attitude.shape[1])}
    by = weights(made, velocity=(3, n), momentum=(3, n), energy=3, spatial_momentum=(3, n), **shown)

    def scalar(made):
        return sum(np.sum(by[name] * getattr(made, name)) for name in by)

    gradient = made.gradient(**by)
    for along in admitted:
        expected = difference(lambda s, a=along: scalar(run(term, velocity + s * a)))
        assert gradient.velocity @ along == pytest.approx(expected, rel=1e-7, abs=1e-7)
    for parameter, at in names(term):
        if parameter.rstrip("_123") in fixed:
            continue
        expected = difference(lambda s, p=parameter, at=at: scalar(run(changed(term, p, at, s))))
        found = np.asarray(gradient[parameter])
        own = found[at] + (found[at[::-1]] if parameter.startswith("J") and at[0] != at[1] else 0)
        assert own == pytest.approx(expected, rel=1e-7, abs=1e-7), (parameter, at)
    if case == "Suslov":
        # The length of the axis means nothing.
        assert abs(gradient["a"][2]) < 1e-12
    if case == "disk":
        # Another radius has another velocity at the same spin; and the plane is the same everywhere.
        along = np.array([0, 0, 0, -velocity[2], 0, 0])
        expected = difference(lambda s: scalar(run(term.with_(radius=0.5 + s), velocity + s * along)))
        assert gradient["radius"] + gradient.velocity @ along == pytest.approx(expected, rel=1e-7, abs=1e-7)
        shift = lambda s, k: attitude @ (np.eye(4) + s * np.eye(4)[:, [k]] @ np.eye(4)[[3]])
        for k in range(3):
            expected = difference(lambda s, k=k: scalar(run(term, attitude=shift(s, k))))
            assert gradient.attitude[3 + k] == pytest.approx(expected, rel=1e-7, abs=1e-7)


def test_an_estimate_of_a_constrained_motion() -> None:
    """The same least squares as SciPy's, by differences of runs."""
    optimize = pytest.importorskip("scipy.optimize", reason="SciPy isn't there")
    body = lambda m: suslov() + ls.gravity(m=m, rho=[0.1, 0.2, 0.4])
    run = body(1.3).stepper(0.02).run(velocity=START, until=2)
    values = run.velocity + 1e-3 * np.random.default_rng(3).standard_normal(run.velocity.shape)

    def missed(x):
        return (np.ravel(body(x[0]).stepper(0.02).run(velocity=[x[1], x[2], 0], until=2).velocity - values)) / 1e-3

    found = optimize.least_squares(missed, [1.2, *START[:2]], x_scale="jac", xtol=1e-12, ftol=1e-12)
    given = {"step": 0.02, "readings": {"velocity": (values, 1e-3)}, "unknown": "m", "velocity": START}
    fit = body(1.2).estimate(**given, known={"attitude": 1e-6})
    assert fit.converged, fit.why
    assert fit.parameters["m"] == pytest.approx(found.x[0], abs=1e-6)
    assert fit.velocity == pytest.approx([*found.x[1:], 0], abs=1e-6)
    assert fit.squares == pytest.approx(2 * found.cost, rel=1e-5)
    # Nothing is seen of what the reaction takes up.
    assert fit.verdict == "unseen" and np.allclose(np.abs(fit.direction), [0, 0, 0, 0, 0, 1, 0])
    with pytest.raises(ls.SetupError, match="leave `momentum` out"):
        body(1.2).estimate(**given, known={"momentum": 1.0})


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
    with pytest.raises(ls.DeclarationError, match="sums aren't compensated beside constraints on velocities"):
        suslov().c(compensated=True)
