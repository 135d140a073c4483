"""Groups that the library has no type of, by a basis of their Lie algebra: order, momentum, and the group's relation."""

import numpy as np
import pytest

import liestep as ls


def unit(n, *entries):
    matrix = np.zeros((n, n))
    for row, column, value in entries:
        matrix[row, column] = value
    return matrix


def special_linear(n):
    apart = [unit(n, (i, j, 1)) for i in range(n) for j in range(n) if i != j]
    return apart + [unit(n, (k, k, 1), (k + 1, k + 1, -1)) for k in range(n - 1)]


def symplectic():
    basis = [unit(4, (i, j, 1), (2 + j, 2 + i, -1)) for i in range(2) for j in range(2)]
    for row, column in ((0, 2), (2, 0)):
        basis += [unit(4, (row, column, 1)), unit(4, (row + 1, column + 1, 1))]
        basis += [unit(4, (row, column + 1, 1), (row + 1, column, 1))]
    return basis


def affine(n):
    return [unit(n + 1, (i, j, 1)) for i in range(n) for j in range(n + 1)]


def orthogonal(n):
    return [unit(n, (i, j, -1), (j, i, 1)) for i in range(n) for j in range(i + 1, n)]


def poses():
    turns = [unit(4, (i, j, -1), (j, i, 1)) for i, j in ((1, 2), (2, 0), (0, 1))]
    return turns + [unit(4, (k, 3, 1)) for k in range(3)]


def block_diag(*blocks):
    """A matrix of these blocks."""
    n, at = sum(len(block) for block in blocks), 0
    matrix = np.zeros((n, n))
    for block in blocks:
        matrix[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    return matrix


FORM = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.eye(2), np.zeros((2, 2))]])
GROUPS = {
    "SL3": (special_linear(3), lambda g: np.linalg.det(g) - 1),
    "Sp4": (symplectic(), lambda g: g.T @ FORM @ g - FORM),
    "SO4": (orthogonal(4), lambda g: g.T @ g - np.eye(4)),
    "Affine2": (affine(2), lambda g: g[-1] - np.eye(3)[-1]),
}


def body(name):
    basis, relation = GROUPS[name]
    n = len(basis[0])
    text = "(((F - I) * K * (F - I).transpose()).trace() + ((I - inverse(F)) * K * (I - inverse(F)).transpose()).trace()) / (4 * h)"
    return ls.lagrangian(name, generators=basis, K=np.diag(np.arange(1.0, n + 1)), l_d=text), basis, relation


@pytest.mark.parametrize("name", GROUPS)
def test_order_momentum_and_relation(name):
    term, basis, relation = body(name)
    velocity = 0.3 * np.cos(np.arange(1, len(basis) + 1))

    def end(steps, **method):
        run = term.stepper(1 / steps, **method).run(velocity=velocity, until=1)
        attitudes = run.attitude.reshape(-1, *basis[0].shape)
        assert max(abs(relation(g)).max() for g in attitudes) < 1e-13
        # Ad*_{g⁻¹} μ: ⟨μ, Ad_{g⁻¹} E_k⟩.
        dual = np.linalg.pinv(np.array([e.ravel() for e in basis]).T)

        def spatial(g, momentum):
            back = np.linalg.inv(g)
            return np.array([momentum @ (dual @ (back @ e @ g).ravel()) for e in basis])

        first, last = (spatial(attitudes[at], run.momentum[at]) for at in (0, -1))
        scale = max(1, abs(first).max())
        assert abs(last - first).max() < 1e-12 * scale
        for at, own in ((0, first), (-1, last)):
            assert abs(run.spatial_momentum[at] - own).max() < 1e-13 * scale
        # A start by the momentum, at another attitude.
        again = term.stepper(1 / steps, **method).run(momentum=run.momentum[-1], attitude=run.attitude[-1], until=1 / steps)
        assert (again.momentum[0] == run.momentum[-1]).all() and abs(again.velocity[0] - run.velocity[-1]).max() < 1e-12
        return run.attitude[-1]

    for method, order, coarsest in (({}, 2, 40), ({"composition": "Suzuki 4"}, 4, 10)):
        exact = end(400, composition="Kahan-Li 8")
        errors = [np.linalg.norm(end(steps, **method) - exact) for steps in (coarsest, 2 * coarsest)]
        assert abs(np.log2(errors[0] / errors[1]) - order) < 0.1, errors


def test_a_product_of_any_groups():
    weight, spin = [0.3, -0.2, 0.4, 3], [0.9, 0.4, -2]
    numbers = {"J_d": np.diag([0.3, 0.4, 0.5]), "c": 0.4, "up": [0, 0, 1]}
    wheel = "((Q - I) * J_d * (Q - I).transpose()).trace() / (2 * h)"
    weighed = "- h / 2 * (({}) * (1 + c * u.z) + ({}) * (1 + c * (Q.transpose() * u).z))"
    body = ls.lagrangian(
        {"Q": "SO3", "F": "SE3"},
        advected={"w": "height.seen_from(F)", "u": "up.seen_from(Q)"},
        l_d="((F - I) * K * (F - I).transpose()).trace() / (2 * h) + "
        + wheel
        + weighed.format("w.dot(weight)", "(F.transpose() * w).dot(weight)"),
        K=np.diag([2, 1.5, 1.1, 1.3]),
        weight=weight,
        height=[0, 0, 1, 0],
        **numbers,
    )
    # By a turn and a place the step is another's, and the motion the same.
    apart = ls.lagrangian(
        {"Q": "SO3", "F": "SO3", "d": "R3"},
        advected={"v": "up.seen_from(F)", "x": "d.seen_from(space)", "u": "up.seen_from(Q)"},
        l_d="((F - I) * K * (F - I).transpose()).trace() / (2 * h) + m * d.norm_squared() / (2 * h) + "
        + wheel
        + weighed.format("v.dot(s) + W * x[2]", "(F.transpose() * v).dot(s) + W * (x + d)[2]"),
        K=np.diag([2, 1.5, 1.1]),
        m=1.3,
        s=weight[:3],
        W=weight[3],
        **numbers,
    )
    ends = [
        term.stepper(0.01).run(velocity=[*spin, 0.3, -0.7, 1.1, 0.2, 0.5, -0.4], until=2) for term in (body, apart)
    ]
    assert abs(ends[0].velocity[-1][:6] - ends[1].velocity[-1][:6]).max() < 1e-12
    assert abs(ends[0]["energy"] - ends[1]["energy"]).max() < 1e-12


def test_a_product_with_groups_of_ones_own():
    """A drop, a body in space and a map of the plane, beside the same groups as blocks of one matrix."""
    drop, pose, plane = special_linear(3), poses(), affine(2)
    kinetic = "(((F - I) * K * (F - I).transpose()).trace() + ((I - inverse(F)) * K * (I - inverse(F)).transpose()).trace()) / (4 * h)"
    metrics = [np.diag(np.arange(1.0, n + 1)) for n in (3, 4, 3)]
    names = ["A", "B", "C"]
    apart = ls.lagrangian(
        {"A": "SL3", "B": "SE3", "C": "Plane"},
        generators={"Plane": plane, "SL3": drop},
        l_d=" + ".join(kinetic.replace("F", name).replace("K", f"K_{name}") for name in names),
        **{f"K_{name}": metric for name, metric in zip(names, metrics, strict=True)},
    )
    sizes, bases = (3, 4, 3), (drop, pose, plane)
    blocks = [
        block_diag(*(e if at == own else np.zeros((n, n)) for at, n in enumerate(sizes)))
        for own, basis in enumerate(bases)
        for e in basis
    ]
    one = ls.lagrangian("Blocks", generators=blocks, K=block_diag(*metrics), l_d=kinetic)
    velocity = 0.3 * np.cos(np.arange(1, len(blocks) + 1))

    def end(term, steps, **method):
        run = term.stepper(1 / steps, **method).run(velocity=velocity, until=1)
        assert abs(run.spatial_momentum[-1] - run.spatial_momentum[0]).max() < 1e-13
        return run.velocity[-1]

    assert abs(end(apart, 50) - end(one, 50)).max() < 1e-12
    for method, order, coarsest in (({}, 2, 40), ({"composition": "Suzuki 4"}, 4, 10)):
        exact = end(apart, 400, composition="Kahan-Li 8")
        errors = [np.linalg.norm(end(apart, steps, **method) - exact) for steps in (coarsest, 2 * coarsest)]
        assert abs(np.log2(errors[0] / errors[1]) - order) < 0.1, errors


def test_mistakes_of_generators_in_products():
    two = {"F": "SO3", "Q": "Own"}
    for wrong, message in (
        ({}, "isn't known"),
        ({"generators": {"Other": [unit(2, (0, 1, 1))]}}, "no group of your own is called `Other`"),
        ({"generators": {"Own": [1, 2]}}, "square matrices"),
    ):
        with pytest.raises(ls.DeclarationError, match=message):
            ls.lagrangian(two, **wrong, k=1.0, l_d="k * ((F - I).norm_squared() + (Q - I).norm_squared()) / h")
    # One group needs no name.
    ls.lagrangian(two, generators=[unit(2, (0, 1, 1))], k=1.0, l_d="k * ((F - I).norm_squared() + (Q - I).norm_squared()) / h")


def test_an_accuracy_is_reached():
    term, basis, _ = body("SL3")
    velocity = 0.3 * np.cos(np.arange(1, len(basis) + 1))
    run = term.run(velocity=velocity, until=2)
    exact = term.stepper(0.005, composition="Kahan-Li 8").run(velocity=velocity, until=2)
    assert run.error <= 1e-6 and np.linalg.norm(run.attitude[-1] - exact.attitude[-1]) < 1e-5


def test_terms_add_and_forces_act():
    basis = GROUPS["Affine2"][0]
    term, _, _ = body("Affine2")
    force = ls.force("Affine2", generators=basis, work="-0.5 * h * c * (eta + eta_next)[0]", c=0.1)
    run = (term + force).stepper(0.01).run(velocity=np.zeros(6), until=1)
    assert abs(run.momentum[-1][0] + 0.1) < 0.01 and abs(run.momentum[0]).max() == 0


def test_what_is_no_basis_is_refused():
    for generators in ([1, 2], np.zeros((2, 3, 2)), [unit(3, (0, 1, 1)), unit(3, (1, 2, 1))]):
        with pytest.raises(ls.DeclarationError):
            ls.lagrangian("Own", generators=generators, k=1.0, l_d="k * (F - I).trace() / h")
    term, basis, _ = body("SL3")
    with pytest.raises(ls.SetupError, match="composition"):
        term.stepper(0.01, splitting="Strang")
    with pytest.raises(ls.SetupError, match="the group"):
        term.stepper(0.01).run(velocity=np.zeros(8), attitude=2 * np.eye(3), until=1)
