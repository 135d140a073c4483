"""Motions as functions of JAX and of PyTorch: derivatives in both modes by all that is given, for declarations on six groups."""

import numpy as np
import pytest
from test_gradients import begin, others, tops

import liestep as ls

CASES = [*tops(), *others()]


def case(name):
    """A term, the velocity at the start, and the parameters to differentiate by."""
    if name in tops():
        term = tops()[name]
        given = {key: np.array(value) for key, value in term.parameters.items() if key not in ("up", "direction")}
        return term, np.array([0.3, 1, -0.5]), given
    term, velocity, some = others()[name]
    return term, np.array(velocity, dtype=float), {key: np.array(term.parameters[key], dtype=float) for key, _ in some}


def rows(name):
    return {"times": [0.1, 0.17, 0.2], "attitude": begin(name)}


@pytest.mark.parametrize("name", CASES)
def test_jax(name):
    jax = pytest.importorskip("jax", reason="JAX isn't installed: core/python/run --all installs it")
    from jax.test_util import check_grads

    jax.config.update("jax_enable_x64", True)
    term, velocity, given = case(name)
    motion = ls.jax(term, 0.05, **rows(name))
    turn = jax.numpy.full(len(velocity), 0.1)
    check_grads(lambda v, t, p: motion(v, turn=t, **p), (velocity, turn, given), order=1, modes=("fwd", "rev"), atol=1e-6, rtol=1e-6)


def test_jax_compiles_and_maps():
    jax = pytest.importorskip("jax", reason="JAX isn't installed: core/python/run --all installs it")
    jax.config.update("jax_enable_x64", True)
    top = ls.body([3, 3, 4]) + ls.gravity(m=1.0, rho=[0, 0, 1])
    motion = ls.jax(top, 0.02, until=0.4, composition="Suzuki 4")
    velocity = jax.numpy.array([0.5, 2, 12])
    run = top.stepper(0.02, composition="Suzuki 4").run(velocity=velocity, until=0.4)
    made = jax.jit(motion)(velocity)
    assert np.array_equal(made["attitude"], run.matrix) and np.array_equal(made["time"], run.time)
    last = lambda m: motion(velocity, m=m)["energy"][-1]
    masses = jax.numpy.array([0.5, 1.0, 2.0])
    expected = [jax.grad(last)(m) for m in masses]
    assert np.array_equal(jax.jit(jax.vmap(jax.grad(last)))(masses), expected)
    end = lambda v: motion(v)["velocity"][-1]
    assert np.allclose(jax.jacfwd(end)(velocity), jax.jacrev(end)(velocity), rtol=0, atol=1e-13)
    # The gradients of the run.
    by = np.zeros(len(run))
    by[-1] = 1
    assert jax.grad(last)(1.0) == run.gradient(energy=by)["m"]


@pytest.mark.parametrize("name", CASES)
def test_torch(name):
    torch = pytest.importorskip("torch", reason="PyTorch isn't installed: pip install torch")
    term, velocity, given = case(name)
    motion = ls.torch(term, 0.05, **rows(name))
    tensor = lambda value: torch.tensor(value, dtype=torch.float64, requires_grad=True)
    all = [tensor(velocity), tensor([0.1] * len(velocity)), *map(tensor, given.values())]

    def read(velocity, turn, *values):
        return tuple(motion(velocity, turn=turn, **dict(zip(given, values, strict=True))).values())

    assert torch.autograd.gradcheck(read, all, atol=1e-6, rtol=1e-6, check_forward_ad=True)


def test_what_has_no_function():
    missing = [name for name in ("jax", "torch") if not has(name)]
    for name in missing:
        with pytest.raises(ls.SetupError, match=f"pip install {name}"):
            getattr(ls, name)(ls.body([1, 2, 3]), 0.1, until=1)
    if missing:
        return
    drives = ls.body([1, 2, 3]) + ls.torque(ls.signal([0, 1], [[0, 0, 1], [0, 0, 0]], between="lines"))
    for function in (ls.jax, ls.torch):
        with pytest.raises(ls.SetupError, match="signal"):
            function(drives, 0.1, until=1)
        with pytest.raises(ls.SetupError, match="until"):
            function(ls.body([1, 2, 3]), 0.1)
        with pytest.raises(ls.Error, match="composition"):
            function(ls.body([1, 2, 3]), 0.1, until=1, splitting="Strang")


def has(name):
    try:
        __import__(name)
    except ImportError:
        return False
    return True
