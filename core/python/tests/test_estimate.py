"""Estimates on several groups, with unknown forces and inputs of one's own; plans whose inputs are parameters."""

import numpy as np
import pytest

import liestep as ls


def noisy(values, deviation, seed=3):
    return values + deviation * np.random.default_rng(seed).standard_normal(values.shape)


def test_the_moments_of_a_top_and_its_drag():
    """Gravity's known arm gives the moments their scale."""
    top = lambda J, c: ls.body(J, kinetic="cayley") + ls.gravity(m=1.3, rho=[0.05, 0, 0.3]) + ls.drag(J=[1, 1, 1], c=c)
    run = top([1, 1.5, 2], 0.1).stepper(0.02).run(velocity=[0.5, 1, 2], until=4, every=4)
    fit = top([1.2, 1.2, 2.2], 0.05).with_(J_2=[1, 1, 1]).estimate(
        step=0.02, every=4, readings={"velocity": (noisy(run.velocity, 1e-3), 1e-3), "attitude": (noisy(run.matrix, 1e-4), 1e-4)},
        unknown=["J_1", "c"],
    )
    assert fit.verdict == "converged", fit.why
    found = [*np.diag(fit.parameters["J_1"]), fit.parameters["c"]]
    # Within four of its own deviations, which are small.
    deviations = list(fit.deviations.values())
    assert list(fit.deviations) == ["J_1_1", "J_1_2", "J_1_3", "c"]
    assert np.all(abs(np.subtract(found, [1, 1.5, 2, 0.1])) < 4 * np.array(deviations)) and max(deviations) < 0.02
    assert fit.squares == pytest.approx(51 * 12, rel=0.2)
    assert abs(fit.run().velocity[::4] - run.velocity).max() < 5e-3


def test_what_readings_do_not_determine():
    """A free body's gyroscope has the ratios of the moments, not their scale, and no attitude."""
    run = ls.body([1, 1.5, 2], kinetic="cayley").stepper(0.02).run(velocity=[0.5, 1, 2], until=4)
    fit = ls.body([1.1, 1.4, 2], kinetic="cayley").estimate(
        step=0.02, readings={"velocity": (run.velocity, 1e-3)}, unknown=["J"], known={"attitude": 1e-3}
    )
    J = np.diag(fit.parameters["J"])
    assert fit.verdict == "unseen" and fit.converged
    assert np.allclose(J / J[2], [0.5, 0.75, 1], atol=1e-6)
    assert "nothing" in fit.why


def test_a_scale_on_a_line_and_in_space():
    """Kepler's motion on R3, and a mass on a spring on R1, by their energies and velocities."""
    orbit = lambda GM: ls.lagrangian("R3", velocity="v", advected={"x": "place"}, discretise="trapezoid(Cayley)",
                                     l="v.norm_squared() / 2 - GM / x.norm_squared().sqrt()".replace("- GM", "+ GM"), GM=GM, place=ls.point([0, 0, 0]))
    start = np.eye(4)
    start[0, 3] = 1
    run = orbit(0.9).stepper(0.02).run(velocity=[0.1, 0.9, 0], attitude=start, until=3)
    fit = orbit(1.0).estimate(step=0.02, readings={"velocity": (run.velocity, 1e-3)}, unknown="GM", attitude=start, known={"attitude": 1e-6})
    assert fit.converged and fit.parameters["GM"] == pytest.approx(0.9, abs=1e-7)


def test_an_unknown_torque():
    body = ls.body([1, 1.5, 2])
    push = ls.signal([0, 1, 2], [[0, 0, 0.5], [0, 0, -0.5], [0, 0, 0]], between="steps")
    run = (body + ls.torque(push)).stepper(0.05).run(velocity=[0.5, 1, 2], until=3)
    fit = body.estimate(step=0.05, readings={"velocity": (run.velocity, 1e-5)}, known={"attitude": 1e-3}, force=1.0, axes="z")
    assert fit.converged and fit.inputs.shape == (60, 1)
    assert abs(fit.inputs[2:18, 0] - 0.5).max() < 0.02 and abs(fit.inputs[42:58, 0]).max() < 0.02
    # An input that is a parameter of one's own force.
    own = body + ls.force("SO3", work="h * u * (eta + eta_next).dot(axis) / 2", u=0.0, axis=[0, 0, 1])
    same = own.estimate(step=0.05, readings={"velocity": (run.velocity, 1e-5)}, known={"attitude": 1e-3}, inputs={"u": 1.0})
    assert same.converged and abs(same.inputs - fit.inputs).max() < 1e-6


def test_a_plan_by_thrusts_of_ones_own():
    """Two thrusters that tilt a body, each with a bound: the same turn as by a torque about that axis."""
    body = ls.body([2, 1, 1])
    pair = ls.force("SO3", work="h * u * (eta + eta_next).dot(arm) / 2", u=0.0, arm=[0.5, 0, 0])
    plan = (body + pair).control(step=0.02, steps=50, goal=ls.euler(0, 0.4), inputs="u").solve()
    beside = body.control(step=0.02, steps=50, goal=ls.euler(0, 0.4), axes="x").solve()
    assert plan.converged and plan.inputs.names == ["u"]
    # A thrust of `u` is a torque of `u/2`, so that its effort is four times as large.
    assert plan.cost == pytest.approx(4 * beside.cost, rel=1e-8)
    assert np.allclose(plan.inputs["u"] / 2, beside.torque[:, 0], atol=1e-7)
    bounded = (body + pair).control(step=0.02, steps=50, goal=ls.euler(0, 0.4), inputs=["u"], bound=10.5).solve()
    assert bounded.converged and abs(bounded.inputs["u"]).max() <= 10.5


def test_a_plan_by_the_length_of_a_pendulum():
    """A parameter of the Lagrangian itself, on a line: a spring whose rest length is moved."""
    cart = ls.lagrangian("R1", velocity="v", advected={"x": "wall"}, discretise="trapezoid(Cayley)", m=1.0, k=4.0, rest=0.0,
                         l="m * v[0].powi(2) / 2 - k * (x[0] + rest).powi(2) / 2", wall=ls.point([0.0]))
    plan = cart.control(step=0.02, steps=100, goal=[[1, 0.3], [0, 1]], inputs="rest").solve()
    assert plan.converged and plan["x"][-1] == pytest.approx(0.3, abs=1e-8)
    assert abs(plan.momentum[-1, 0]) < 1e-8


def test_what_is_no_estimate():
    body = ls.body([1, 1.5, 2]) + ls.gravity(m=1, rho=[0, 0, 1])
    readings = {"velocity": (np.ones((11, 3)), 0.1)}
    for message, given in {
        "values and their": {"readings": {"velocity": np.ones((11, 3))}},
        "readings are of": {"readings": {"tilt": (np.ones(11), 0.1)}},
        "as many": {"readings": readings | {"energy": (np.ones(5), 0.1)}},
        "above zero": {"readings": {"velocity": (np.ones((11, 3)), 0)}},
        "no parameter": {"unknown": ["mass"]},
        "direction": {"unknown": ["up"]},
        "what is known": {"known": {"m": 0.1}},
        "guess": {"readings": {"energy": (np.ones(11), 0.1)}},
        "`every`": {"every": 0},
        "or `inputs`": {"force": 1, "inputs": {"m": 1}},
    }.items():
        with pytest.raises(ls.Error, match=message):
            body.estimate(**({"step": 0.1, "readings": readings} | given))
    with pytest.raises(ls.SetupError, match="`axes`"):
        body.control(step=0.1, steps=10, inputs="m", axes="x")


def test_a_bound_beyond_all_numbers_ends():
    """A barrier that overflows was lowered for ever."""
    plan = ls.body([1, 2, 3]).control(step=0.1, steps=10, goal=ls.euler(0, 0.3), bound=1e160).solve()
    assert plan.verdict in ("stalled", "exhausted", "converged")


def test_a_long_motion_is_fitted_from_its_beginning():
    """Over ten seconds a guess that is 30 % off is turns apart from the motion: all readings at once lead far away."""
    body = lambda J: ls.body(J, kinetic="cayley") + ls.gravity(m=1.3, rho=[0.05, 0, 0.3])
    run = body([1, 1.5, 2]).stepper(0.02).run(velocity=[0.5, 1, 2], until=10)
    given = {"step": 0.02, "readings": {"velocity": (noisy(run.velocity, 1e-3), 1e-3)}, "unknown": ["J"], "known": {"attitude": 1e-4}}
    fit = body([1.3, 1.2, 2.4]).estimate(**given, first=51)
    assert fit.verdict == "converged" and fit.squares == pytest.approx(501 * 3, rel=0.05)
    assert abs(np.diag(fit.parameters["J"]) - [1, 1.5, 2]).max() < 4 * max(fit.deviations.values())
    at_once = body([1.3, 1.2, 2.4]).estimate(**given, iterations=5)
    assert not at_once.converged and at_once.squares > 1000 * fit.squares
    # A prior is about the guess, and not about where a part of the readings led.
    known = {**given, "known": {"attitude": 1e-4, "J": 1e-9}}
    assert np.diag(body([1.001, 1.5, 2]).estimate(**known, first=51).parameters["J"]) == pytest.approx([1.001, 1.5, 2], abs=1e-6)
    with pytest.raises(ls.Error, match="first"):
        body([1, 1.5, 2]).estimate(**given, first=1)
