"""Gradients of runs beside differences, on several groups; signals; transitions and exponents; what has none."""

import pickle

import numpy as np
import pytest

import liestep as ls

up = {"w": "up"}
SE3 = "((F - I) * K * (F - I).transpose()).trace() / (2 * h)"


def turned(vector):
    """The rotation about a vector by its length."""
    angle = np.linalg.norm(vector)
    x, y, z = vector
    hat = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    near = angle < 1e-12
    return np.eye(3) + hat * (1 if near else np.sin(angle) / angle) + hat @ hat * (0.5 if near else (1 - np.cos(angle)) / angle**2)


def difference(scalar, step=2e-4):
    """The derivative at zero, to the sixth order of the step."""
    return sum(share * (scalar(k * step) - scalar(-k * step)) / (2 * k * step) for k, share in ((1, 1.5), (2, -0.6), (3, 0.1)))


def tops():
    """Sums on SO(3): each has a body, gravity and one more."""
    body, gravity = ls.body([1.1, 2, 2.5]), ls.gravity(m=1.3, rho=[0.1, 0.2, 0.4])
    J = [[1.2, 0.1, 0], [0.1, 2, 0.2], [0, 0.2, 2.5]]
    return {
        "drag": body + gravity + ls.drag(J=[1.1, 2, 2.5], c=0.3),
        "springs": body + ls.spring(k=3, length=1, at=[0, 0, 1], anchor=[0, 1, 3]) + ls.spring(k=3, length=1, at=[1, 0, 0], anchor=[0, 0, 3]),
        "magnet": body + ls.dipole(moment=[0.1, 0, 1], field=[0.3, 0, 0.5]) + ls.rotor(spin=[0, 0.3, 0.2]),
        "satellite": ls.body(J, kinetic="geodesic") + ls.gravity_gradient(GM=3.0, r=1.5, J=J, direction=[0, 0.6, 0.8]),
        "torque": ls.body([1, 2, 2.5], kinetic="cayley") + ls.torque([0.1, 0.2, -0.3]) + ls.thrust(at=[0, 1, 0], thrust=[1, 0, 2]),
        "own": ls.lagrangian("SO3", advected=up, discretise="trapezoid(Cayley)", J=[3, 3, 4], m=1.5, rho=[0, 0.1, 1], up=[0, 0, 1],
                             l="1/2 * Omega.dot(J * Omega) - m * (w.dot(rho) + w.dot(rho).powi(2).sqrt() / 3)"),
    }


def names(term):
    """Each entry of each parameter that can be changed alone."""
    for name, value in term.parameters.items():
        if name in ("up", "direction"):
            continue
        for at in np.ndindex(np.shape(value)):
            # Inertias are symmetric.
            if name.startswith("J") and at[0] > at[1]:
                continue
            yield name, at


def changed(term, name, at, by):
    value = np.array(term.parameters[name], dtype=float)
    value[at] += by
    if name.startswith("J") and at[0] != at[1]:
        value[at[::-1]] += by
    return term.with_(**{name: value})


def weights(run, **shapes):
    random = np.random.default_rng(7)
    return {name: random.uniform(-1, 1, shape) for name, shape in shapes.items()}


@pytest.mark.parametrize("name", tops())
@pytest.mark.parametrize("method", [{}, {"composition": "Suzuki 4"}])
def test_gradients_on_so3(name, method):
    term = tops()[name]
    if method and not term.stepper(0.05)._native.is_self_adjoint:
        pytest.skip(f"{name} isn't the same backwards: no composition")
    times = [0.1, 0.37, 0.5]

    def run(term, velocity=(0.3, 1.0, -0.5), turn=(0, 0, 0)):
        attitude = turned(np.array([0.3, -0.2, 0.4])) @ turned(np.array(turn, dtype=float))
        return term.stepper(0.05, **method).run(velocity=velocity, attitude=attitude, times=times)

    by = weights(run(term), velocity=(3, 3), momentum=(3, 3), matrix=(3, 3, 3), attitude=(3, 4), energy=3, spatial_momentum=(3, 3))

    def scalar(made):
        columns = {"attitude": made.quaternion} | {name: getattr(made, name) for name in by if name != "attitude"}
        return sum(np.sum(by[name] * columns[name]) for name in by)

    gradient = run(term).gradient(**by)
    for k, axis in enumerate(np.eye(3)):
        assert gradient.velocity[k] == pytest.approx(difference(lambda s, a=axis: scalar(run(term, np.add([0.3, 1, -0.5], s * a)))), rel=1e-7, abs=1e-7)
        assert gradient.attitude[k] == pytest.approx(difference(lambda s, a=axis: scalar(run(term, turn=s * a))), rel=1e-7, abs=1e-7)
    for parameter, at in names(term):
        expected = difference(lambda s, p=parameter, at=at: scalar(run(changed(term, p, at, s))))
        found = np.asarray(gradient[parameter])
        own = found[at] + (found[at[::-1]] if parameter.startswith("J") and at[0] != at[1] else 0)
        assert own == pytest.approx(expected, rel=1e-7, abs=1e-7), (parameter, at)


def others():
    """Declarations off SO(3): a term, the velocity at the start, and a parameter with the place of an entry."""
    K = np.diag([1.0, 2, 3, 1.5]) + 0.1
    unit = lambda i, j: np.eye(3)[[i]].T @ np.eye(3)[[j]]
    sl3 = [unit(i, j) for i in range(3) for j in range(3) if i != j] + [unit(k, k) - unit(2, 2) for k in range(2)]
    flow = "(((F - I) * K * (F - I).transpose()).trace() + ((I - inverse(F)) * K * (I - inverse(F)).transpose()).trace()) / (4 * h)"
    return {
        "SE3": (ls.lagrangian("SE3", l_d=SE3 + " - h * k * (p - q).norm_squared() / 2", advected={"p": "home"}, K=(K + K.T) / 2, k=3.0,
                              q=[0.1, 0, 0, 1], home=ls.point([0.3, 0.2, 1])), [0.3, 0.2, -0.4, 0.1, 0.5, 0.2], [("k", ()), ("home", (1,)), ("q", (0,))]),
        "SE2": (ls.lagrangian("SE2", l_d="((F - I) * K * (F - I).transpose()).trace() / (2 * h)", K=np.diag([1.0, 2, 1.5])), [0.5, 0.2, 0.1],
                [("K", (0, 0)), ("K", (2, 2))]),
        "R3": (ls.lagrangian("R3", velocity="v", advected={"x": "place"}, discretise="trapezoid(Cayley)",
                             l="m * v.norm_squared() / 2 - GM * m / x.norm_squared().sqrt()", m=1.2, GM=0.8, place=ls.point([0, 0, 0])),
               [0.1, 0.9, 0], [("m", ()), ("GM", ()), ("place", (0,))]),
        "SL3": (ls.lagrangian("SL3", generators=sl3, K=np.diag([1, 2, 3.0]), l_d=flow), np.full(8, 0.2), [("K", (0, 0)), ("K", (1, 1))]),
        "product": (ls.lagrangian({"F": "SO3", "d": "R1"}, velocity="Omega, v", discretise="trapezoid(Cayley)", J=[1, 2, 2.5], m=0.7, k=2.0,
                                  l="1/2 * Omega.dot(J * Omega) + m * v.powi(2) / 2 - k * p.powi(2) / 2", advected={"p": "d.seen_from(space)"}),
                    [0.3, 1, -0.4, 0.5], [("m", ()), ("k", ())]),
    }


def begin(name):
    place = {"R3": [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}
    return place.get(name)


@pytest.mark.parametrize("name", others())
@pytest.mark.parametrize("method", [{}, {"composition": "Kahan-Li 6"}])
def test_gradients_off_so3(name, method):
    term, velocity, some = others()[name]
    if method and not term.stepper(0.05)._native.is_self_adjoint:
        pytest.skip(f"{name} isn't the same backwards: no composition")

    def run(term, velocity):
        return term.stepper(0.05, **method).run(velocity=velocity, attitude=begin(name), times=[0.1, 0.32, 0.5])

    made = run(term, velocity)
    shown = made.group("q_").shape[1] + 1 if name == "product" else made.attitude.shape[1]
    n = len(velocity)
    by = weights(made, velocity=(3, n), momentum=(3, n), attitude=(3, shown), energy=3, spatial_momentum=(3, n))

    def scalar(made):
        return sum(np.sum(by[name] * getattr(made, name)) for name in by)

    gradient = made.gradient(**by)
    for k, axis in enumerate(np.eye(n)):
        expected = difference(lambda s, a=axis: scalar(run(term, np.add(velocity, s * a))))
        assert gradient.velocity[k] == pytest.approx(expected, rel=1e-7, abs=1e-7)
    for parameter, at in some:
        expected = difference(lambda s, p=parameter, at=at: scalar(run(with_entry(term, p, at, s), velocity)))
        assert np.asarray(gradient[parameter])[at] == pytest.approx(expected, rel=1e-7, abs=1e-7), (parameter, at)


def with_entry(term, name, at, by):
    value = np.array(term.parameters[name], dtype=float)
    value[at] += by
    is_point = name in ("home", "place")
    return term.with_(**{name: ls.point(value) if is_point else value})


def test_gradients_by_signals():
    times, values = [0, 0.33, 0.47, 1.0], np.array([[0, 0, 1], [0, 2, 0], [1, 0, 0], [0, 0.5, 0.5]], dtype=float)
    body = ls.body([1, 2, 2.5])
    steps = lambda values: ls.signal(times, values, between="lines")

    def end(signal):
        run = (body + ls.torque(signal)).stepper(0.05).run(velocity=[0.1, 1, 0.2], until=1)
        return run, run.velocity[-1, 0]

    run, _ = end(steps(values))
    by = np.zeros((len(run), 3))
    by[-1, 0] = 1
    gradient = run.gradient(velocity=by)
    found = gradient.signals["torque"]
    assert found.shape == values.shape
    for at in np.ndindex(values.shape):
        change = np.zeros_like(values)
        change[at] = 1
        assert found[at] == pytest.approx(difference(lambda s, c=change: end(steps(values + s * c))[1]), abs=1e-8)
    # A function has a value over each step.
    run, _ = end(ls.signal(lambda t: np.stack([np.sin(t), 0 * t, 0 * t], axis=1)))
    found = run.gradient(velocity=by).signals["torque"]
    assert found.shape == (20, 3)
    bump = lambda s: ls.signal(lambda t: np.stack([np.sin(t) + s * ((t > 0.3) & (t < 0.35)), 0 * t, 0 * t], axis=1))
    assert found[6, 0] == pytest.approx(difference(lambda s: end(bump(s))[1]), abs=1e-8)


def test_a_start_by_momentum_has_its_own_derivative():
    term = tops()["own"]
    run = lambda momentum: term.stepper(0.05).run(momentum=momentum, until=1)
    made = run([1, 2, -1])
    by = np.zeros(len(made))
    by[10] = 1
    gradient = made.gradient(energy=by)
    assert gradient.velocity is None
    for k, axis in enumerate(np.eye(3)):
        expected = difference(lambda s, a=axis: run(np.add([1, 2, -1], s * a)).energy[10])
        assert gradient.momentum[k] == pytest.approx(expected, abs=1e-8)


def test_transitions_and_exponents():
    term = tops()["own"]
    run = lambda momentum: term.stepper(0.05).run(momentum=momentum, until=1)
    matrix = run([1, 2, -1]).transition()
    for k, axis in enumerate(np.eye(3)):
        expected = difference(lambda s, a=axis: run(np.add([1, 2, -1], s * a)).momentum[-1])
        assert matrix[3:, 3 + k] == pytest.approx(expected, abs=1e-8)
    assert abs(np.linalg.det(matrix) - 1) < 1e-12
    # In pairs, as without forces.
    exponents = ls.body([1, 2, 2.5]).stepper(0.01).run(velocity=[0, 2, 0], until=60).lyapunov()
    assert exponents[0] == pytest.approx((1 * 0.5 / 2.5) ** 0.5 * 2, rel=0.02)
    assert abs(exponents.sum()) < 1e-10


def test_a_run_keeps_its_derivatives_where_it_pickles():
    run = tops()["magnet"].stepper(0.05).run(velocity=[0, 1, 0], until=1)
    by = np.ones(len(run))
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.gradient(energy=by).velocity, run.gradient(energy=by).velocity)
    lost = (ls.body([1, 2, 3]) + ls.torque(ls.signal(lambda t: np.zeros((len(t), 3))))).stepper(0.1).run(velocity=[0, 1, 0], until=1)
    with pytest.raises(ls.SetupError, match="isn't known"):
        pickle.loads(pickle.dumps(lost)).transition()


def test_what_has_no_gradient():
    run = ls.body([1, 2, 2.5]).stepper(0.05).run(velocity=[0, 1, 0], until=1)
    with pytest.raises(ls.SetupError, match=r"\(21, 3\)"):
        run.gradient(velocity=[1, 2, 3])
    with pytest.raises(ls.SetupError, match="real"):
        run.gradient(energy=np.ones(21) * 1j)
    with pytest.raises(ls.Error, match="no parameter"):
        run.gradient(energy=np.ones(21))["mass"]
    exact = ls.body([1, 2, 2.5]).stepper(0.05, splitting="Strang").run(velocity=[0, 1, 0], until=1)
    with pytest.raises(ls.SetupError, match="composition"):
        exact.gradient(energy=np.ones(21))
    with pytest.raises(ls.SetupError, match="between"):
        run.lyapunov(between=0)
    with pytest.raises(ls.StepError, match="finite"):
        run.gradient(energy=np.full(21, 1e308))
