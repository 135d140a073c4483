"""Cases of papers and of public reports: each beside its own numbers or an integration that shares no code, and in C."""

from __future__ import annotations

import re
import shutil
import subprocess

import numpy as np
import pytest

import liestep as ls

TRACE = "((F - I) * J_d * (F - I).transpose()).trace() / (2 * h)"


def unit(n, *entries):
    matrix = np.zeros((n, n))
    for row, column, value in entries:
        matrix[row, column] = value
    return matrix


TURNS = [unit(3, (a, b, -1), (b, a, 1)) for a, b in ((1, 2), (2, 0), (0, 1))]
MOVES = [np.pad(turn, (0, 1)) for turn in TURNS] + [unit(4, (k, 3, 1)) for k in range(3)]
#: The bases that the library has.
BASES = {
    "SO3": TURNS,
    "SE3": MOVES,
    "SE2": [unit(3, (0, 1, -1), (1, 0, 1)), unit(3, (0, 2, 1)), unit(3, (1, 2, 1))],
    "SL2": [unit(2, (0, 0, 0.5), (1, 1, -0.5)), unit(2, (0, 1, 0.5), (1, 0, 0.5)), unit(2, (0, 1, -0.5), (1, 0, 0.5))],
    "Heisenberg": [unit(3, (0, 1, 1)), unit(3, (1, 2, 1)), unit(3, (0, 2, 1))],
}


def metric(n):
    """A symmetric positive matrix without a pattern."""
    mixed = np.sin(np.arange(1.0, n * n + 1)).reshape(n, n)
    return np.eye(n) * (1 + np.arange(n) / n) + 0.1 * (mixed + mixed.T) / 2


def by_runge_kutta(rates, now, steps=400):
    """The numbers after a second by classical Runge–Kutta steps."""
    h = 1 / steps
    for _ in range(steps):
        a = rates(now)
        b = rates(now + a * h / 2)
        c = rates(now + b * h / 2)
        now = now + (a + 2 * b + 2 * c + rates(now + c * h)) * h / 6
    return now


def free_motion(basis, kinetic, velocity, bias=0.0, steps=400):
    """The velocity after a second by the Euler–Poincaré equations ``μ' = ad*_ξ μ``, ``μ = K ξ + b``."""
    basis = np.array(basis)
    dual = np.linalg.pinv(basis.reshape(len(basis), -1).T)
    inverse = np.linalg.inv(kinetic)

    def rates(mu):
        hat = np.tensordot(inverse @ (mu - bias), basis, 1)
        return np.array([dual @ (hat @ e - e @ hat).ravel() for e in basis]) @ mu

    return inverse @ (by_runge_kutta(rates, kinetic @ np.asarray(velocity, float) + bias, steps) - bias)


def orders(term, velocity, exact, *, coarse=100, fine=16):
    """The orders of the term's own step and of a composition, by the velocity after a second."""
    def error(steps, **method):
        return np.linalg.norm(term.stepper(1 / steps, **method).run(velocity=velocity, until=1).velocity[-1] - exact)

    assert np.log2(error(coarse) / error(2 * coarse)) == pytest.approx(2, abs=0.01)
    one, two = (error(steps, composition="Suzuki 4") for steps in (fine, 2 * fine))
    assert two < 1e-11 or np.log2(one / two) == pytest.approx(4, abs=0.12)


def matrices(run):
    """The matrices of a run, a row for each row, those of translations one after the other."""
    if "q_w" in run.names:
        return run.matrix
    if "x_1" in run.names:
        ones = np.ones_like(run.attitude)
        return np.stack([ones, run.attitude, 0 * ones, ones], axis=2)
    n = int(run.attitude.shape[1] ** 0.5)
    return run.attitude.reshape(-1, n, n)


MAIN = """
#include <stdio.h>
int main(void) {{
    static const double p[] = {{{parameters}}}, r[] = {{{attitude}}}, m[] = {{{momentum}}}, v[] = {{{velocity}}};
    {of}_stepper stepper;
    {of}_state state;
    if (!{of}_make(&stepper, p, {h})) return 1;
    {of}_start(&stepper, &state, r, m, v);
    for (int i = 0; i < {steps}; i++)
        if (!{of}_step(&stepper, &state)) return 2;
    for (int i = 0; i < (int)(sizeof m / sizeof *m); i++) printf("%.17g ", state.momentum[i]);
    for (int i = 0; i < (int)(sizeof r / sizeof *r); i++) printf("%.17g ", state.attitude[i]);
    return 0;
}}
"""


@pytest.fixture
def in_c(tmp_path):
    """A comparison of a term's steps with those of its text in C, to the last bit."""
    def compared(term, velocity, h, steps=1000, compensated=False, **start):
        if shutil.which("cc") is None:
            print("not in C: there is no `cc`")
            return
        run = term.stepper(h, compensated=compensated).run(velocity=velocity, until=h * steps, every=steps, **start)

        def written(numbers):
            return ", ".join(f"{number:.17g}" for number in np.ravel(numbers))

        first, last = (np.ravel(matrices(run)[at]) for at in (0, -1))
        c = term.c(compensated=compensated)
        assert ("Sums are compensated" in c) == compensated
        text = c + MAIN.format(
            parameters=written(term.numbers), attitude=written(first), momentum=written(run.momentum[0]),
            velocity=written(run.velocity[0]), h=repr(h), steps=steps, of=re.search(r"(\w+)_make\(", c)[1],
        )
        (tmp_path / "step.c").write_text(text)
        flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off"]
        subprocess.run(["cc", *flags, "step.c", "-o", "step", "-lm"], cwd=tmp_path, check=True)
        made = subprocess.run([tmp_path / "step"], check=True, capture_output=True, text=True).stdout
        found, momentum = np.array(made.split(), float), run.momentum[-1]
        assert np.array_equal(found[: len(momentum)], momentum)
        # On SO(3) a row has the quaternion of the attitude, which is as near as rounding.
        assert abs(found[len(momentum) :] - last).max() < (1e-13 if term.group == "SO3" else 1e-300)

    return compared


def test_a_pendulum_in_space(in_c):
    """The bounds of the energy over 1000 s by (3.13), as in Lee, Leok and McClamroch (2005), and the vertical momentum."""
    pendulum = ls.lagrangian("SO3", advected={"w": "down"}, l_d=f"{TRACE} + h * m * g * (w.dot(rho) + w.dot(F * rho)) / 2",
                             J_d=ls.nonstandard([0.13, 0.28, 0.17]), m=1, g=9.81, rho=[0, 0, 0.3], down=[0, 0, 1])
    run = pendulum.stepper(0.05).run(velocity=[4.14] * 3, until=1000)
    change = run.energy - run.energy[0]
    assert run.energy[0] == pytest.approx(2.027, abs=5e-4)
    assert (change.min(), change.max()) == pytest.approx((-4.46e-2, 7.60e-2), abs=1e-4)
    assert abs(run.spatial_momentum[:, 2] - run.spatial_momentum[0, 2]).max() < 1e-13
    in_c(pendulum, [4.14] * 3, 0.05, 20_000)


def test_a_fast_heavy_top(in_c):
    """150 rad/s, the benchmark of integrators of Lie groups (Brüls, Cardona, Arnold): the error of R(1 s) by the kinetic term."""
    gravity = ls.gravity(m=15, g=9.81, rho=[0, 1, 0])
    inertia, velocity = np.diag([15.234375, 0.46875, 15.234375]), [0, 150, -4.61538]
    exact = (ls.body(inertia) + gravity).for_accuracy(1e-9, velocity=velocity, until=1).matrix[-1]
    for kinetic, steps, known in (("rigid", 1024, 7.6e-1), ("geodesic", 1024, 2.0e-2), ("geodesic", 2048, 4.9e-3)):
        top = ls.body(inertia, kinetic=kinetic) + gravity
        end = top.stepper(1 / steps).run(velocity=velocity, until=1).matrix[-1]
        assert np.linalg.norm(end - exact) == pytest.approx(known, rel=0.05)
    in_c(ls.body(inertia) + gravity, velocity, 1 / 2048)


@pytest.mark.parametrize("name", BASES)
def test_geodesics_of_a_dense_metric(name, in_c):
    """Left-invariant metrics, as asked for in geomstats and Manifolds.jl, against structure constants."""
    basis = BASES[name]
    K, velocity = metric(len(basis)), 0.9 * np.cos(np.arange(1.0, len(basis) + 1))
    term = ls.lagrangian(name, velocity="xi", discretise="trapezoid(Cayley)", l="xi.dot(K * xi) / 2", K=K)
    orders(term, velocity, free_motion(basis, K, velocity))
    in_c(term, velocity, 0.01)


def test_collocation_of_a_dense_metric():
    """Collocation takes the continuous limit, on a group where no motion of a free body is known."""
    K, velocity = metric(6), 0.9 * np.cos(np.arange(1.0, 7))
    term = ls.lagrangian("SE3", velocity="xi", discretise="trapezoid(Cayley)", l="xi.dot(K * xi) / 2", K=K)
    exact = free_motion(BASES["SE3"], K, velocity, steps=2000)
    run = term.stepper(0.05, collocation=4).run(velocity=velocity, until=1)
    assert np.linalg.norm(run.velocity[-1] - exact) < 1e-11


def test_a_hamiltonian_has_compositions():
    """A free body by its Hamiltonian: fourth order, the length of the momentum to rounding."""
    body = ls.hamiltonian("SO3", h="mu.dot(K * mu) / 2", K=np.diag([1, 1 / 2, 1 / 2.5]))
    exact = ls.body([1, 2, 2.5]).for_accuracy(1e-11, velocity=[0.3, 0.5, 0.4], until=2).momentum[-1]
    runs = [body.stepper(2 / n, composition="Suzuki 4").run(momentum=[0.3, 1, 1], until=2).momentum for n in (20, 40)]
    errors = [np.linalg.norm(run[-1] - exact) for run in runs]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.1)
    assert abs(np.linalg.norm(runs[0], axis=1) - np.linalg.norm([0.3, 1, 1])).max() < 1e-14
    with pytest.raises(ls.SetupError, match="composition of it"):
        body.stepper(0.1, collocation=4)
    with pytest.raises(ls.SetupError, match="give a `momentum`"):
        body.stepper(0.1).run(velocity=[1, 0, 0], until=1)


@pytest.mark.parametrize("thin", [1.0, 1e-6])
def test_near_sub_riemannian_geodesics(thin, in_c):
    """On the Heisenberg group the third direction is all but forbidden."""
    K, velocity = np.diag([1.0, 1.0, 1 / thin]), [0.8, -0.6, 0.7 * thin]
    term = ls.lagrangian("Heisenberg", velocity="xi", discretise="trapezoid(Cayley)", l="xi.dot(K * xi) / 2", K=K)
    exact = free_motion(BASES["Heisenberg"], K, velocity)
    orders(term, velocity, exact)
    by_eight = term.stepper(0.1, composition="Kahan-Li 8").run(velocity=velocity, until=1)
    assert np.linalg.norm(by_eight.velocity[-1] - exact) < 1e-10
    in_c(term, velocity, 0.01)


def test_a_charged_body_in_a_field(in_c):
    """A term that is linear in the velocity, as in Larmor's theorem."""
    J, field = np.array([1.0, 1.0, 1.5]), np.array([0, 0.6, 0.8])
    term = ls.lagrangian("SO3", advected={"w": "field"}, discretise="trapezoid(Cayley)",
                         l="Omega.dot(J * Omega) / 2 + k * w.dot(J * Omega)", J=J, k=0.7, field=field)
    velocity = np.array([0.5, 1.0, 2.0])

    def rates(now):
        mu, w = now
        omega = mu / J - 0.7 * w
        return np.array([np.cross(mu, omega) + 0.7 * np.cross(J * omega, w), np.cross(w, omega)])

    now = by_runge_kutta(rates, np.array([J * (velocity + 0.7 * field), field]), 1000)
    orders(term, velocity, now[0] / J - 0.7 * now[1])
    run = term.stepper(0.01).run(velocity=velocity, until=10)
    assert abs(run.spatial_momentum @ field - run.spatial_momentum[0] @ field).max() < 2e-14
    in_c(term, velocity, 0.01)


def test_a_rod_with_a_curvature(in_c):
    """Kirchhoff's rod, whose time is its arc length: ``l = (ξ − ξ₀)·K (ξ − ξ₀)/2`` on SE(3)."""
    K, own = metric(6), np.array([0.3, -0.2, 0.5, 0, 0, 1])
    velocity = [0.5, 0.1, 0.8, 0.1, -0.1, 1.2]
    term = ls.lagrangian("SE3", velocity="xi", discretise="trapezoid(Cayley)", l="(xi - u).dot(K * (xi - u)) / 2", K=K, u=own)
    orders(term, velocity, free_motion(MOVES, K, velocity, -K @ own))
    in_c(term, velocity, 0.01)
    in_c(term, velocity, 0.01, compensated=True)


def test_a_cubic():
    """Riemannian cubics on SO(3) (Noakes): the least ``½ ∫ |u|² dt`` is one of a shooting, and is met with second order."""
    integrate = pytest.importorskip("scipy.integrate", reason="SciPy isn't there")
    optimize = pytest.importorskip("scipy.optimize", reason="SciPy isn't there")
    goal = ls.euler(0.4, 0.9, 0.3)
    of_goal = ls.body([1, 1, 1]).stepper(1.0).run(velocity=[0, 0, 0], attitude=goal, until=1).matrix[0]

    # R' = R Ω̂, Ω' = u, u' = v, v' = v × Ω: the cubics of a sphere (Noakes, Heinzinger, Paden 1989), and their effort.
    def rates(_, now):
        R, omega, u, v = now[:9].reshape(3, 3), now[9:12], now[12:15], now[15:18]
        x, y, z = omega
        turned = R @ [[0, -z, y], [z, 0, -x], [-y, x, 0]]
        return np.concatenate([turned.ravel(), u, v, np.cross(v, omega), [u @ u / 2]])

    def end(unknown):
        begin = np.concatenate([np.eye(3).ravel(), np.zeros(3), unknown, [0]])
        return integrate.solve_ivp(rates, (0, 1), begin, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]

    def missed(unknown):
        last = end(unknown)
        twist = of_goal.T @ last[:9].reshape(3, 3)
        return np.concatenate([[twist[2, 1] - twist[1, 2], twist[0, 2] - twist[2, 0], twist[1, 0] - twist[0, 1]], last[9:12]])

    first = ls.body([1, 1, 1]).control(step=0.02, steps=50, goal=goal).solve()
    begin = np.concatenate([first.torque[0], (first.torque[1] - first.torque[0]) / 0.02])
    found = optimize.root(missed, begin, tol=1e-13)
    exact = end(found.x)[18]
    assert found.success and abs(missed(found.x)).max() < 1e-10
    costs = [ls.body([1, 1, 1]).control(step=1 / n, steps=n, goal=goal).solve().cost - exact for n in (50, 100, 200)]
    assert np.log2(costs[0] / costs[1]) == pytest.approx(2, abs=0.05) and np.log2(costs[1] / costs[2]) == pytest.approx(2, abs=0.05)


def test_a_boat_that_is_pushed_forwards():
    """On SE(2) with surge and turning alone (Kobilarov, Marsden 2011): straight ahead the effort is ``6 m² x²/T³``, and
    sideways, where it has to turn, it is more."""
    boat = ls.lagrangian("SE2", velocity="xi", discretise="trapezoid(Cayley)", l="xi.dot(K * xi) / 2", K=np.diag([0.5, 2, 2]))

    def plan(goal, steps, **guess):
        where = [[1, 0, goal[0]], [0, 1, goal[1]], [0, 0, 1]]
        return boat.control(step=5 / steps, steps=steps, goal=where, axes=[0, 1], **guess).solve()

    ahead, aside = plan([1, 0], 100), plan([0.5, 0.3], 20, guess=0.01)
    assert ahead.converged and ahead.cost == pytest.approx(6 * 2**2 / 5**3, rel=2e-4)
    assert aside.converged and aside.cost > 6 * 2**2 * 0.5**2 / 5**3


def test_a_rigid_body_in_four_dimensions(in_c):
    """Manakov's top on SO(4): order, spatial momentum, energy of Moser and Veselov's step."""
    basis = [unit(4, (i, j, -1), (j, i, 1)) for i in range(4) for j in range(i + 1, 4)]
    J = np.diag([1.0, 2.0, 3.0, 4.5])
    kinetic = np.array([[np.trace(a @ J @ b.T) for b in basis] for a in basis])
    velocity = 0.5 * np.cos(np.arange(1.0, 7))
    term = ls.lagrangian("SO4", generators=basis, J=J, l_d="((F - I) * J * (F - I).transpose()).trace() / (2 * h)")
    orders(term, velocity, free_motion(basis, kinetic, velocity))
    run = term.stepper(0.01).run(velocity=velocity, until=10)
    first, last = (
        matrices(run)[at] @ np.tensordot(run.momentum[at], basis, 1) @ matrices(run)[at].T for at in (0, -1)
    )
    assert abs(last - first).max() < 2e-14 and abs(run.energy - run.energy[0]).max() < 1e-4
    in_c(term, velocity, 0.01)


AFFINE_LD = ("(B * (F - I) * K * (F - I).transpose()).trace() / (2 * h) - h * k * (((B - I) * (B - I)).trace()"
             " + ((F.transpose() * B * F - I) * (F.transpose() * B * F - I)).trace()) / 2")


def test_an_affine_body(in_c):
    """A body of a graphics engine on GL(3) with the energy ``k |AᵀA − I|²``: steps of Störmer and Verlet for A."""
    basis = [unit(3, (i, j, 1)) for i in range(3) for j in range(3)]
    J, k, h = np.diag([1.0, 1.5, 2.0]), 5.0, 0.01
    velocity = [0.1, -1.0, 0.3, 1.0, 0.2, 0.0, -0.3, 0.1, -0.1]
    term = ls.lagrangian("GL3", generators=basis, advected={"B": "metric"}, l_d=AFFINE_LD, K=J, k=k,
                         metric=ls.covariant(np.eye(3)))
    run = term.stepper(h).run(velocity=velocity, until=1)
    A, momentum = np.eye(3), np.reshape(velocity, (3, 3)) @ J

    def force(A):
        return -4 * k * A @ (A.T @ A - np.eye(3))

    for _ in range(100):
        momentum = momentum + force(A) * h / 2
        A = A + momentum @ np.linalg.inv(J) * h
        momentum = momentum + force(A) * h / 2
    assert np.linalg.norm(matrices(run)[-1] - A) < 1e-11
    in_c(term, velocity, h)


def test_an_affine_body_that_falls(in_c):
    """Twelve generators, and the weight of the homogeneous coordinates."""
    basis = [unit(4, (i, j, 1)) for i in range(3) for j in range(4)]
    term = ls.lagrangian("Affine", generators=basis, advected={"w": "up", "B": "metric"}, K=np.diag([1, 1.5, 2, 1]), g=9.81,
                         l_d="(B * (F - I) * K * (F - I).transpose()).trace() / (2 * h) - h * g * (w.dot(e) + w.dot(F * e)) / 2",
                         e=[0, 0, 0, 1], up=[0, 0, 1, 0], metric=ls.covariant(np.eye(4)))
    velocity = [0, 0.1, 0, 0, -0.1, 0, 0, 0, 0, 0, 0, 0]
    run = term.stepper(0.01).run(velocity=velocity, until=1)
    assert matrices(run)[-1][2, 3] == pytest.approx(-4.9050, abs=1e-10)
    in_c(term, velocity, 0.01)


def test_an_incompressible_ellipsoid(in_c):
    """Dirichlet's ellipsoid: a free motion on SL(3), whose volume stays."""
    basis = [unit(3, (i, j, 1)) for i in range(3) for j in range(3) if i != j]
    basis += [unit(3, (k, k, 1), (k + 1, k + 1, -1)) for k in range(2)]
    K, velocity = np.diag([1.0, 1.4, 2.0]), 0.3 * np.cos(np.arange(1.0, 9))
    term = ls.lagrangian("SL3", generators=basis, advected={"B": "metric"}, K=K, metric=ls.covariant(np.eye(3)),
                         l_d="(B * (F - I) * K * (F - I).transpose()).trace() / (2 * h)")

    # A'' K = p A⁻ᵀ, with the pressure p that keeps the volume: tr(A⁻¹ A'') = tr (A⁻¹ A')².
    def rates(now):
        (A, V), inverse = now, np.linalg.inv(K)
        back = np.linalg.inv(A)
        pressure = np.trace(back @ V @ back @ V) / np.trace(back @ back.T @ inverse)
        return np.array([V, pressure * back.T @ inverse])

    A, V = by_runge_kutta(rates, np.array([np.eye(3), np.tensordot(velocity, basis, 1)]))
    assert np.linalg.det(A) == pytest.approx(1, abs=1e-9)
    dual = np.linalg.pinv(np.reshape(basis, (8, 9)).T)
    orders(term, velocity, dual @ (np.linalg.inv(A) @ V).ravel())
    run = term.stepper(0.01).run(velocity=velocity, until=1)
    assert abs(np.linalg.det(matrices(run)) - 1).max() < 1e-13
    in_c(term, velocity, 0.01)


def test_a_body_on_eight_springs(in_c):
    """A platform: eight terms beside a body, whose parameters have one name each."""
    t = np.arange(1, 9)
    body = ls.body([1, 2, 2.5])
    for one in t:
        body += ls.spring(k=10, length=0.5, at=[np.cos(one), np.sin(one), 0.1 * one], anchor=[2 * np.sin(one), 2 * np.cos(one), 1])
    run = body.run(velocity=[0.1, 0.2, 0.3], until=2)
    assert abs(run.velocity[-1] - [-1.74747, -5.98525, -2.85234]).max() < 1e-5 and run.error < 1e-5
    in_c(body, [0.1, 0.2, 0.3], 0.01)
    in_c(body, [0.1, 0.2, 0.3], 0.01, compensated=True)


def test_a_double_pendulum_by_its_angles(in_c):
    """Two coordinates, with ``l(θ, θ')`` as it is in books."""
    term = ls.lagrangian({"a": "R1", "b": "R1"}, velocity="u, v", discretise="trapezoid", g=9.81,
                         advected={"x": "a.seen_from(space)", "y": "b.seen_from(space)"},
                         l="u * u + v * v / 2 + u * v * (x - y).cos() + g * (2 * x.cos() + y.cos())")
    x, y = np.pi / 2, 0.5

    def rates(now):
        x, y, u, v = now
        sine, cosine = np.sin(x - y), np.cos(x - y)
        p, q = -v * v * sine - 2 * 9.81 * np.sin(x), u * u * sine - 9.81 * np.sin(y)
        return np.array([u, v, *np.array([p - cosine * q, 2 * q - cosine * p]) / (2 - cosine**2)])

    now = by_runge_kutta(rates, np.array([x, y, 0.0, 0.0]), 2000)
    start = [[[1, x], [0, 1]], [[1, y], [0, 1]]]

    def error(steps, **method):
        run = term.stepper(1 / steps, **method).run(attitude=start, velocity=[0, 0], until=1)
        return np.linalg.norm(run.velocity[-1] - now[2:])

    assert np.log2(error(200) / error(400)) == pytest.approx(2, abs=0.01) and error(100, composition="Kahan-Li 8") < 1e-9
    in_c(term, [0, 0], 0.01, attitude=start)
