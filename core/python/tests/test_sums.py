"""Sums: any terms in any order and bracketing are one motion, whatever their parameters are called."""

from __future__ import annotations

import pickle
from functools import reduce
from operator import add

import numpy as np
import pytest

import liestep as ls

J = [1, 2, 2.5]
KINETIC = "((F - I) * J_d * (F - I).transpose()).trace() / (2 * h)"
J_D = ls.nonstandard(J)


def own(text, **numbers):
    """A potential of a direction that its text calls `w`."""
    return ls.lagrangian("SO3", advected={"w": "up"}, l_d=text, up=[0, 0.6, 0.8], **numbers)


def pool():
    """Terms whose names collide: of parameters, of what is advected, of `let`s and of arguments of closures."""
    weight = "-h * m * w.dot(rho)"
    return [
        ls.gravity(m=0.5, rho=[0.1, 0.2, 0.3]),
        ls.gravity(m=0.7, rho=[0.3, 0, 0.1], up=[0, 0.6, 0.8]),
        ls.gravity_gradient(GM=30, r=3, J=J, direction=[0.8, 0.6, 0]),
        ls.dipole(moment=[0.1, 0.4, 0], field=[2, 1, 0]),
        ls.spring(k=3, length=0.5, at=[0.1, 0, 0.3], anchor=[1, 0.5, 1]),
        ls.spring(k=4, length=0.5, at=[0, 0.2, 0.3], anchor=[-1, 0.5, 1]),
        ls.rotor(spin=[0.3, 0, 0.1]),
        ls.torque([0.3, 0, 0]),
        ls.torque([0, 0.2, 0.1]),
        ls.thrust(at=[0.2, 0, 0], thrust=[0, 0.4, 0.1]),
        ls.drag(c=0.3, J=J),
        ls.magnetic_damping(k=0.2, field=[0.5, 0, 1], J=J),
        own(weight, m=0.7, rho=[0, 0.2, 0.3]),
        own("{ let m_2 = 2; -h * m * m_2 * w.dot(rho) }", m=0.4, rho=[0.1, 0, 0.2]),
        own("{ let m_2 = 2; -h * m * m_2 * w.dot(rho) } - h * m * w.dot(rho)", m=0.4, rho=[0.1, 0, 0.2]),
        own("{ let U = |m_2: Vector3<f64>| m * m_2.dot(rho); -h * U(w) }", m=0.3, rho=[0.2, 0, 0]),
        own("{ let rho_2 = 3 * rho; -h * m_2 * w.dot(rho_2) }", m_2=0.2, rho=[0.2, 0.1, 0]),
        ls.lagrangian("SO3", advected={"w": "d1", "w_2": "d2"}, l_d="-h * m * w.dot(a) * w_2.dot(a)", m=0.6, a=[0.3, 0, 1],
                      d1=[1, 0, 0.2], d2=[0, 1, 0.3]),
        ls.force("SO3", work="{ let c_2 = 2; -c * c_2 * vee(F - F.transpose()).dot(eta) / 2 }", c=0.1),
        ls.lagrangian("SO3", l="-m * w.dot(rho) + 0 * Omega.dot(Omega)", discretise="trapezoid(Cayley)", advected={"w": "m_2"},
                      m=0.3, rho=[0, 1, 0], m_2=[0, 0, 1]),
    ]


def ends(term, steps=3):
    run = term.stepper(0.02).run(velocity=[0.3, 1, 2], attitude=ls.euler(0.2, 0.7), until=0.02 * steps, every=steps)
    return np.concatenate([run.energy, run.momentum.ravel(), run.velocity.ravel(), run.matrix.ravel()])


def bracketed(terms, random):
    """Their sum with any brackets."""
    terms = list(terms)
    while len(terms) > 1:
        at = random.integers(len(terms) - 1)
        terms[at:at + 2] = [terms[at] + terms[at + 1]]
    return terms[0]


def test_any_order_and_any_brackets_are_one_motion():
    random, all_terms, body = np.random.default_rng(7), pool(), ls.body(J)
    for number in range(500):
        chosen = random.choice(len(all_terms), size=random.integers(2, 5), replace=number % 3 == 0)
        terms = [body, *(all_terms[at] for at in chosen)]
        # Every second sum has another order, too.
        order = random.permutation(len(terms)) if number % 2 else range(len(terms))
        one, other = ends(reduce(add, terms)), ends(bracketed([terms[at] for at in order], random))
        assert abs(one - other).max() < 1e-12 * (1 + abs(one).max()), [term.name for term in terms]


# Each by one text, with names of its own for what the terms call alike.
BY_HAND = [
    ([0, 4, 10], "- h * m * g * w.dot(rho + F * rho) / 2 - h * k / 4 * (((at - a).norm() - length).powi(2)"
     " + ((at - F.transpose() * a).norm() - length).powi(2))",
     {"w": "up", "a": "anchor"}, {"m": 0.5, "g": 9.81, "rho": [0.1, 0.2, 0.3], "up": [0, 0, 1], "k": 3, "length": 0.5,
                                  "at": [0.1, 0, 0.3], "anchor": [1, 0.5, 1]}, [10]),
    ([12, 14, 16], "- h * m_1 * w.dot(r_1) - 3 * h * m_2 * w.dot(r_2) - 3 * h * m_3 * w.dot(r_3)", {"w": "up"},
     {"m_1": 0.7, "r_1": [0, 0.2, 0.3], "m_2": 0.4, "r_2": [0.1, 0, 0.2], "m_3": 0.2, "r_3": [0.2, 0.1, 0],
      "up": [0, 0.6, 0.8]}, []),
    ([13, 17], "- 2 * h * m_1 * w.dot(rho) - h * m_2 * u.dot(a) * v.dot(a)", {"w": "up", "u": "d1", "v": "d2"},
     {"m_1": 0.4, "rho": [0.1, 0, 0.2], "up": [0, 0.6, 0.8], "m_2": 0.6, "a": [0.3, 0, 1], "d1": [1, 0, 0.2],
      "d2": [0, 1, 0.3]}, []),
]


@pytest.mark.parametrize(("chosen", "text", "advected", "numbers", "rest"), BY_HAND)
def test_a_sum_is_its_terms_typed_as_one_text(chosen, text, advected, numbers, rest):
    all_terms = pool()
    typed = ls.lagrangian("SO3", l_d=f"{KINETIC} {text}", advected=advected, J_d=J_D, **numbers)
    by_hand = reduce(add, [typed, *(all_terms[at] for at in rest)])
    summed = reduce(add, [ls.body(J), *(all_terms[at] for at in chosen)])
    assert abs(ends(by_hand, 50) - ends(summed, 50)).max() < 1e-11


def test_a_sum_of_forces_is_all_of_them():
    # The second torque was dropped: 0.980 became 0.
    body, one, other = ls.body([1, 2, 2.5]), ls.torque([1, 0, 0]), ls.torque([0, 1, 0])
    sums = [body + one + other, body + (one + other), one + other + body, one + (body + other)]
    runs = [term.stepper(0.01).run(velocity=[0, 0, 0], until=1) for term in sums]
    assert abs(runs[0].momentum[-1, 1] - 0.980) < 1e-3
    assert all(abs(run.momentum - runs[0].momentum).max() < 1e-12 for run in runs)
    plans = [term.control(step=0.1, steps=10, goal=ls.euler(0, 0.5)).solve().cost for term in sums[:2]]
    assert plans[0] == pytest.approx(plans[1], rel=1e-9)


def test_a_let_and_an_advected_vector_have_their_names_for_themselves():
    first = own("-h * m * w.dot(rho)", m=3, rho=[0, 0, 1])
    second = own("{ let m_2 = 2; -h * m * m_2 * w.dot(rho) } - h * m * w.dot(rho)", m=1, rho=[0.5, 0, 1])
    once = own("-3 * h * m * w.dot(rho)", m=1, rho=[0.5, 0, 1])
    assert abs(ends(ls.body(J) + first + second, 20) - ends(ls.body(J) + once + first, 20)).max() < 1e-12
    two = ls.lagrangian("SO3", advected={"w": "d1", "w_2": "d2"}, l_d="-h * w.dot(a) * w_2.dot(a)", a=[0.3, 0, 1],
                        d1=[1, 0, 0.2], d2=[0, 1, 0.3])
    assert abs(ends(ls.body(J) + first + two, 20) - ends(ls.body(J) + two + first, 20)).max() < 1e-12


def test_vectors_are_as_many_as_the_terms_have():
    # Eight springs, each with an anchor of its own; the velocity at 2 s is that of DOP853.
    springs = [ls.spring(k=10, length=0.5, at=[np.cos(t), np.sin(t), 0.1 * t], anchor=[2 * np.sin(t), 2 * np.cos(t), 1])
               for t in range(1, 9)]
    term = sum(springs) + ls.body([1, 2, 2.5])
    run = term.for_accuracy(1e-7, velocity=[0.1, 0.2, 0.3], until=2)
    assert abs(run.velocity[-1] - [-1.74747, -5.98525, -2.85234]).max() < 1e-5
    plan = term.control(step=0.05, steps=10, goal=ls.euler(0, 0.3)).solve()
    assert plan.converged and abs(plan.matrix[-1][2, 2] - np.cos(0.3)) < 1e-8


def test_sums_on_other_groups():
    weight, spring = (
        ls.lagrangian("R2", advected={"w": "up"}, l_d="-h/2 * m * w.dot(r + F * r)", m=m, r=[0, 0, 1], up=up)
        for m, up in ((9.81, [0, 1, 0]), (2, [1, 0, 0]))
    )
    particle = ls.lagrangian("R2", l_d="m * (F - I).norm_squared() / (2 * h)", m=1)
    run = (spring + particle + weight).stepper(0.1).run(velocity=[3, 4], until=1)
    assert abs(run["x"][-1] - (3 - 1)) < 1e-13 and abs(run["y"][-1] - (4 - 9.81 / 2)) < 1e-13


def test_sums_on_products():
    # Two bodies that know nothing of each other move as each does alone.
    pair = {"F_1": "SO3", "F_2": "SO3"}
    kinetic = " + ".join(f"((F_{k} - I) * J_{k}_d * (F_{k} - I).transpose()).trace() / (2 * h)" for k in (1, 2))
    both = ls.lagrangian(pair, l_d=kinetic, J_1_d=J_D, J_2_d=2 * J_D)
    alone = [ls.body(J), ls.body(2 * np.array(J))]
    for up, m in (([0, 0, 1], 1), ([0, 1, 0], 2), ([1, 0, 0], 3)):
        text = "-h/2 * m * (u.dot(rho + F_1 * rho) + 2 * v.dot(rho + F_2 * rho))"
        seen = {"u": "up.seen_from(F_1)", "v": "up.seen_from(F_2)"}
        both = ls.lagrangian(pair, advected=seen, l_d=text, m=m, rho=[0.1, 0, 1], up=up) + both
        alone = [one + ls.gravity(m=k * m, g=1, rho=[0.1, 0, 1], up=up) for k, one in enumerate(alone, 1)]
    run = both.stepper(0.01).run(velocity=[0.3, 1, 2, 1, 0.2, 0.3], until=1)
    ends_of = [term.stepper(0.01).run(velocity=v, until=1) for term, v in zip(alone, ([0.3, 1, 2], [1, 0.2, 0.3]), strict=True)]
    assert abs(run.velocity - np.hstack([one.velocity for one in ends_of])).max() < 1e-11
    # A body and its place: a weight of the place, and two of the body.
    free = {"F": "SO3", "d": "R3"}
    body = ls.lagrangian(free, l_d=f"{KINETIC} + m * d.norm_squared() / (2 * h)", J_d=J_D, m=2)
    turned = [
        ls.lagrangian(free, advected={"w": "up.seen_from(F)", "x": "d.seen_from(space)"}, m=m, rho=[0.1, 0, 1], up=up, f=1.5,
                      l_d="-h/2 * (m * w.dot(rho + F * rho) + f * (x[2] + (x + d)[2]))")
        for m, up in ((1, [0, 0, 1]), (2, [0, 1, 0]))
    ]
    run = (turned[0] + body + turned[1]).stepper(0.01).run(velocity=[0.3, 1, 2, 0, 0, 1], until=1)
    weights = ls.gravity(m=1, g=1, rho=[0.1, 0, 1]) + ls.gravity(m=2, g=1, rho=[0.1, 0, 1], up=[0, 1, 0])
    alone = (ls.body(J) + weights).stepper(0.01).run(velocity=[0.3, 1, 2], until=1)
    assert abs(run.velocity[:, :3] - alone.velocity).max() < 1e-11
    assert abs(run.velocity[-1, 3:] - [0, 0, 1 - 1.5]).max() < 1e-12


def test_terms_of_both_forms_add():
    # The potential has no velocity, and is a text of the other form.
    weight = ls.lagrangian("SO3", l="-m * w.dot(rho)", discretise="trapezoid(Cayley)", advected={"w": "up"}, m=2, rho=[0.1, 0, 1],
                           up=[0, 0, 1])
    gravity = ls.gravity(m=2, g=1, rho=[0.1, 0, 1])
    assert abs(ends(ls.body(J) + weight, 20) - ends(gravity + ls.body(J), 20)).max() < 1e-12


def test_names_of_several_parameters():
    one, other = (ls.spring(k=k, length=1, at=[0, 0, 1], anchor=[0, k, 3]) for k in (3, 4))
    term = ls.body(J) + one + (other + ls.drag(c=0.1, J=J))
    assert term.parameters["k_1"] == 3 and term.parameters["k_2"] == 4 and term.parameters["length"] == 1
    assert term.with_(k_2=5).parameters["k_2"] == 5 and term.with_(length=2).parameters["length"] == 2
    assert term.with_(c=2).parameters["c"] == 2 and term.with_(length_2=2).parameters["length_1"] == 1
    assert term.with_(k_2=3).with_(k=7).parameters["k"] == 7
    with pytest.raises(ls.DeclarationError, match="k_1 or k_2"):
        term.with_(k=5)
    assert pickle.loads(pickle.dumps(term)) == term and "k_2=4" in repr(term)
    by_hand = ls.body(J) + one + ls.spring(k=5, length=1, at=[0, 0, 1], anchor=[0, 4, 3]) + ls.drag(c=0.1, J=J)
    assert (ends(term.with_(k_2=5)) == ends(by_hand)).all()
    # A text that calls a parameter so itself.
    named = own("-h * m_1 * w.dot(rho)", m_1=2, rho=[0, 0, 1]) + own("-h * m * w.dot(rho)", m=3, rho=[0, 0, 1])
    named += own("-h * m * w.dot(rho)", m=4, rho=[0, 0, 1])
    assert [named.parameters[name] for name in ("m_1", "m__1", "m__2")] == [2, 3, 4]


def test_draws_are_those_of_the_summand(tmp_path):
    one, other = (ls.spring(k=k, length=1, at=[0, 0, 1], anchor=[0, k, 3]) for k in (3, 4))
    term = ls.body(J) + one + other
    ensemble = term.ensemble(5, velocity=[0, 1, 2], seed=1, k_2=ls.uniform(5, 5 + 1e-12))
    drawn = pickle.loads(pickle.dumps(ensemble)).run(tmp_path, until=0.2, progress=False)
    run = term.with_(k_2=5).stepper(0.01).run(velocity=[0, 1, 2], until=0.2)
    assert abs(drawn["momentum_x"] - run.momentum[-1, 0]).max() < 1e-10
    with pytest.raises(ls.Error, match="k_1 or k_2"):
        term.ensemble(5, velocity=[0, 1, 2], k=ls.uniform(5, 6))
    both = (ls.body(J) + ls.drag(c=0.2, J=J)).ensemble(5, velocity=[0, 1, 2], seed=1, c=ls.uniform(0.3, 0.3 + 1e-12))
    ends_of = both.run(tmp_path / "drag", until=0.2, progress=False)
    dragged = (ls.body(J) + ls.drag(c=0.3, J=J)).stepper(0.01).run(velocity=[0, 1, 2], until=0.2)
    assert abs(ends_of["momentum_y"] - dragged.momentum[-1, 1]).max() < 1e-10
