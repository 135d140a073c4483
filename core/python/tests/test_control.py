"""Plans with known answers, and tasks that have none."""

from __future__ import annotations

import pickle
import signal
import threading

import numpy as np
import pytest
from conftest import heavy_top

import liestep as ls

BODY = [1, 2, 2.5]


def half_turn(steps, **more):
    """Beside the way about the axis itself, where the gradient vanishes: by a torque that goes round once meanwhile."""
    share = np.arange(steps) / steps
    spin = np.where(share < 0.5, 0.9, -0.9)
    guess = np.stack([0.5 * np.cos(2 * np.pi * (share - lag)) for lag in (0.1, 0.4)] + [spin], axis=1)
    return ls.body([1, 1, 1]).control(step=3.5 / steps, steps=steps, goal=ls.euler(np.pi, 0), bound=1, minimum_time=True,
                                      guess=guess, **more)


def test_the_shortest_half_turn_of_a_sphere():
    # Bilimoria and Wie 1993: 3.243; about the axis itself it takes 2 sqrt(pi) = 3.545.
    plan = half_turn(200).solve()
    assert plan.converged and 3.2425 < plan.duration <= 3.2435
    assert abs(plan.torque).max() <= 1
    assert plan.time[-1] == pytest.approx(plan.duration, abs=1e-13) and plan.cost == plan.duration
    assert abs(plan.matrix[-1] - np.diag([-1, -1, 1])).max() < 1e-9 and abs(plan.velocity[-1]).max() < 1e-9


def test_the_numbers_are_those_of_rust():
    # `core/control/tests/plans`: a_text_is_planned_as_what_is_compiled.
    top = heavy_top(J_d=ls.nonstandard([1, 1.4, 2]), m=0.5, g=2, rho=[0.1, 0, 0.3])
    plan = top.control(step=0.1, steps=20, start=ls.euler(0, 0.4), goal=ls.euler(0.3, 1.5, 0.2), bound=4).solve()
    assert plan.converged and plan.cost == pytest.approx(1.473_736_859_111_866, rel=1e-12)


def test_the_least_effort_of_a_turn_about_one_axis():
    # ½∫u² = 6 J² θ²/T³, to second order in the step.
    exact = 6 * 9 * 1.2**2 / 8
    errors = [ls.body([3, 3, 4]).control(step=2 / n, steps=n, goal=ls.euler(0, 1.2)).solve().cost / exact - 1 for n in (25, 50, 100)]
    assert abs(errors[2]) < 4e-4
    assert errors[0] / errors[1] == pytest.approx(4, abs=0.02) and errors[1] / errors[2] == pytest.approx(4, abs=0.02)


def test_the_motion_is_that_of_its_torques():
    # The same torques as the library's effect, step by step: half of the impulse before a step and half behind it.
    task = ls.body(BODY).control(step=0.1, steps=20, goal=ls.euler(0.4, 0.9), goal_velocity=[0.1, 0.2, -0.1])
    plan = task.solve()
    assert plan.converged and abs(plan.velocity[-1] - [0.1, 0.2, -0.1]).max() < 1e-9
    momentum = plan.momentum[0] + 0.05 * plan.torque[0]
    free = ls.body(BODY).stepper(0.1).run(velocity=momentum / BODY, until=0.1)
    assert abs(free.matrix[-1] - plan.matrix[1]).max() < 1e-14
    assert abs(free.momentum[-1] + 0.05 * plan.torque[0] - plan.momentum[1]).max() < 1e-14


def test_what_coasts_keeps_its_momentum():
    bound = np.full((120, 1), 4.0)
    bound[30:90] = 0
    plan = ls.body(BODY).control(step=0.02, steps=120, goal=ls.euler(0.5, 0.9), bound=bound).solve()
    assert plan.converged and (plan.torque[30:90] == 0).all()
    kept = plan.spatial_momentum[30:91]
    assert np.linalg.norm(kept[0]) > 0.1 and abs(kept - kept[0]).max() < 1e-13


def test_an_instrument_goes_round_the_sun():
    sun = np.array([np.cos(0.75), np.sin(0.75), 0.1])
    turn = {"step": 0.02, "steps": 100, "goal": ls.euler(1.5, 0)}
    free = ls.body(BODY).control(**turn).solve()
    plan = ls.body(BODY).control(**turn, keep_out=[([2, 0, 0], 3 * sun, 0.3)]).solve()
    assert plan.converged and plan.cost > 1.01 * free.cost
    nearest = np.arccos((plan.matrix[:, :, 0] @ sun / np.linalg.norm(sun)).max())
    assert nearest == pytest.approx(0.3, abs=1e-6)


def test_any_end_and_one_axis():
    # From rest to a spin J ω by one torque: it is constant, and takes ½ (J ω)²/T.
    plan = ls.body([2, 3, 4]).control(step=0.1, steps=20, axes="z", goal_velocity=[0, 0, 1.5]).solve()
    assert plan.converged and plan.cost == pytest.approx(0.5 * 6**2 / 2, abs=1e-9)
    assert abs(plan.torque - [0, 0, 3]).max() < 1e-9
    plan = ls.body(BODY).control(step=0.1, steps=20, goal=ls.euler(0, 1), goal_velocity=None).solve()
    assert plan.converged and plan.velocity[-1, 0] > 0.1 and len(plan.multipliers) == 3


def test_forces_act_beside_the_torque():
    # Damping takes more effort; and a torque that stays, turned against the motion.
    effort = {}
    for name, forces in {"none": None, "drag": ls.drag(c=0.5, J=BODY), "torque": ls.torque([-0.2, 0, 0])}.items():
        term = ls.body(BODY) if forces is None else ls.body(BODY) + forces
        plan = term.control(step=0.05, steps=40, goal=ls.euler(0, 1.5)).solve()
        assert plan.converged, name
        effort[name] = plan
    assert effort["drag"].cost > 1.01 * effort["none"].cost
    # The effect is what the plan adds to the torque about the first axis.
    added = effort["torque"].torque - effort["none"].torque
    assert abs(added[:, 0] - 0.2).max() < 1e-8 and abs(added[:, 1:]).max() < 1e-8


def test_bounds_that_are_too_tight_have_a_certificate():
    # Rest to rest a torque u turns a body by u T²/4J at most: 4.8 for 0.6 rad in a second.
    turn = {"step": 0.02, "steps": 50, "goal": ls.euler(0, 0.6)}
    plan = ls.body([2, 2, 2]).control(**turn, bound=4).solve()
    assert plan.verdict == "infeasible" and not plan.converged and "gap" in plan.why
    direction, gap = plan.certificate
    assert gap > 0.01 and np.linalg.norm(direction) == pytest.approx(1, abs=1e-12)
    assert ls.body([2, 2, 2]).control(**turn, bound=4.9).solve().converged


def test_progress_and_the_end_of_a_search():
    told = []
    plan = half_turn(40).solve(progress=lambda iteration, residual: told.append((iteration, residual)))
    assert plan.converged and [one[0] for one in told] == list(range(plan.iterations + 1)) and told[-1][1] <= 1e-10
    assert half_turn(40).solve(progress=lambda iteration, _: iteration < 2).verdict == "cancelled"
    assert half_turn(40).solve(iterations=3).verdict == "exhausted"
    with pytest.raises(ZeroDivisionError):
        half_turn(40).solve(progress=lambda iteration, _: 1 / 0)


def test_ctrl_c_leaves_the_plan_until_then():
    # It comes while the search is in Rust, from a thread that only then has the interpreter.
    timer = threading.Timer(0.2, lambda: signal.raise_signal(signal.SIGINT))
    with pytest.raises(KeyboardInterrupt) as stopped:
        half_turn(4000).solve(tolerance=0, progress=lambda iteration, _: timer.start() if iteration == 0 else None)
    timer.join()
    assert stopped.value.run.verdict == "cancelled" and len(stopped.value.run) == 4001


def test_a_plan_is_a_run():
    task = pickle.loads(pickle.dumps(half_turn(40)))
    plan = task.solve()
    assert plan.svg().startswith("<svg") and "<html" in plan.html() and "converged after" in repr(plan)
    assert plan.names[:5] == ["t", "q_w", "q_x", "q_y", "q_z"] and plan.inputs.units["torque_x"] == "N m"
    assert "40 steps" in repr(task)


@pytest.mark.parametrize("wrong", [
    {"steps": 0}, {"steps": 2.5}, {"axes": "xw"}, {"axes": "xx"}, {"axes": ""}, {"bound": [1, 2]}, {"bound": -1}, {"bound": "a"},
    {"bound": float("nan")}, {"guess": float("nan")}, {"goal": [1, 0]}, {"goal": [0, 0, 0, 0]}, {"velocity": [0, 0]},
    {"goal_velocity": [float("nan"), 0, 0]}, {"step": 0}, {"step": float("nan")},
    {"keep_out": [([0, 0, 0], [1, 0, 0], 0.3)]}, {"keep_out": [([1, 0, 0], [1, 0, 0], 0.3)]},
])
def test_hostile_tasks(wrong):
    with pytest.raises(ls.Error):
        ls.body(BODY).control(**{"step": 0.1, "steps": 3, "goal": ls.euler(0, 0.1), **wrong}).solve()


def test_what_has_no_plan_here():
    with pytest.raises(ls.SetupError, match="first factor"):
        ls.lagrangian("R1", l_d="m * (F - I).norm_squared() / (2 * h)", m=1).control(
            step=0.1, steps=3, keep_out=[([1, 0, 0], [0, 0, 1], 0.3)]).solve()
    with pytest.raises(ls.SetupError, match="components 0 to 0"):
        ls.lagrangian("R1", l_d="m * (F - I).norm_squared() / (2 * h)", m=1).control(step=0.1, steps=3, axes="x")
    with pytest.raises(ls.StepError):
        ls.body(BODY).control(step=0.5, steps=10, goal=ls.euler(0, 1), guess=100).solve()


def metric(generators, J, goal, steps):
    """The least effort from the identity to a goal in two seconds, on the group of these generators."""
    text = "((F - I) * J * (F - I).transpose()).trace() / (2 * h)"
    body = ls.lagrangian("Own", l_d=text, generators=generators, J=J)
    plan = body.control(step=2 / steps, steps=steps, goal=goal).solve()
    assert plan.converged and plan.force.shape == (steps, len(generators))
    return plan.cost


def test_the_least_effort_on_groups_of_ones_own():
    """From rest to rest along a one-parameter group with the inertia J it is ``6 J² θ²/T³``."""
    import scipy.linalg

    turns = [np.zeros((4, 4)) for _ in range(6)]
    for turn, (i, j) in zip(turns, [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]):
        turn[i, j], turn[j, i] = -1, 1
    exact = 6 * 2**2 * 0.8**2 / 8
    coarse, fine = (metric(turns, np.eye(4), scipy.linalg.expm(0.8 * turns[0]), n) / exact - 1 for n in (20, 40))
    assert abs(fine) < 2e-3 and coarse / fine == pytest.approx(4, abs=0.05)


def test_a_wheel_turns_a_body():
    """A torque on a wheel alone turns body and wheel against each other: momentum in space stays zero."""
    text = "((F - I) * J_d * (F - I).transpose()).trace() / (2 * h) + J_w * (t + vee(F).x).powi(2) / (2 * h)"
    satellite = ls.lagrangian({"F": "SO3", "t": "R1"}, l_d=text, J_d=np.diag([1.5, 1.0, 0.5]), J_w=0.3)
    plan = satellite.control(step=0.05, steps=40, axes=[3], goal_velocity=[0.5, 0, 0, -0.5 * (1.5 + 0.3) / 0.3]).solve()
    assert plan.converged, plan.why
    assert plan["momentum_x_1"] == pytest.approx(0, abs=1e-12)
    assert plan["velocity_x_1"][-1] == pytest.approx(0.5, abs=1e-9)
    # The angular impulse of the wheel is its own momentum at the end.
    assert plan.force[:, 3].sum() * 0.05 == pytest.approx(0.3 * (0.5 - 0.5 * 1.8 / 0.3), abs=1e-9)


@pytest.mark.parametrize("axis", "xyz")
@pytest.mark.parametrize("angle", [0.7, 1.5707963])
def test_the_shortest_time_needs_no_guess(axis, angle):
    """A turn about one axis with a bounded torque takes ``2 √(J θ/u)``."""
    turn = [np.cos(angle / 2), *(np.sin(angle / 2) * (np.array(list("xyz")) == axis))]
    task = ls.body([1, 1, 1]).control(step=0.03, steps=100, goal=turn, bound=1, axes=axis, minimum_time=True)
    plan = task.solve()
    assert plan.converged and plan.duration == pytest.approx(2 * angle**0.5, rel=1e-3)
    stalled = ls.body([1, 1, 1]).control(step=0.03, steps=100, goal=turn, bound=1, axes=axis, minimum_time=True, guess=0.0).solve()
    assert stalled.converged or "guess" in stalled.why


@pytest.mark.parametrize("tolerance", [0.0, -1.0, -np.inf, np.nan])
def test_a_tolerance_that_no_residual_reaches_ends_the_search(tolerance):
    plan = ls.body([1, 2, 2.5]).control(step=0.1, steps=3, goal=[1, 0, 0, 0]).solve(tolerance=tolerance, iterations=3)
    assert plan.iterations <= 3 and not abs(plan.velocity).any()
