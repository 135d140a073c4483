"""Times of this package: python measure.py [BESIDE], where that is the example `beside` of this package, built.

Prints the steps a second of processor time of a loop in Python with a torque each, what an import takes, and gradients by start and
all parameters in plain runs of as many steps; and with BESIDE the seconds of a million steps and of 100,000 members from Python, and
in Rust, in turns, and their ratios.
"""

import subprocess
import sys
import tempfile
import time
from typing import Any

import numpy as np

import liestep as ls

L_D = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho))"
TOP = ls.lagrangian("SO3", advected={"w": "up"}, l_d=L_D, J_d=[2, 2, 1], m=1, g=9.81, rho=[0, 0, 1], up=[0, 0, 1])


def in_rust(*arguments: str) -> float:
    return float(subprocess.run([sys.argv[1], *arguments], check=True, capture_output=True, text=True).stdout)


def steps() -> float:
    begun = time.perf_counter()
    TOP.stepper(0.01).run(velocity=[0.5, 2, 12], until=10_000, every=1000)
    return time.perf_counter() - begun


def members() -> float:
    with tempfile.TemporaryDirectory() as folder:
        begun = time.perf_counter()
        TOP.ensemble(100_000, step=0.01, velocity=ls.normal([0, 0, 12], 0.1), seed=7).run(
            folder, until=1, threads=1, progress=False)
        return time.perf_counter() - begun


def members_in_rust() -> float:
    with tempfile.TemporaryDirectory() as folder:
        return in_rust("members", folder)


def loop(torque: Any, count: int = 200_000) -> float:
    """Seconds of processor time of a step in a loop, with a torque each."""
    state = TOP.stepper(0.01).start(velocity=[0.5, 2, 12])
    begun = time.process_time()
    for _ in range(count):
        state.step(torque=torque)
    return (time.process_time() - begun) / count


def imported() -> float:
    """Seconds of an import, less those of Python itself."""
    def run(code: str) -> float:
        begun = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        return time.perf_counter() - begun

    return min(run("import liestep") for _ in range(7)) - min(run("pass") for _ in range(7))


def gradients() -> dict[str, tuple[ls.Term, list[float]]]:
    """Terms whose gradients are compared with runs, and velocities at the start."""
    J, K = [[1.2, 0.1, 0], [0.1, 2, 0.2], [0, 0.2, 2.5]], np.diag([1.0, 2, 3, 1.5])
    body = ls.body(J, kinetic="cayley")
    return {
        "a top by (3.13)": (TOP, [0.5, 2, 12]),
        "a satellite": (body + ls.gravity_gradient(GM=3.0, r=1.5, J=J, direction=[0, 0.6, 0.8]), [0.3, 1, -0.5]),
        "a body on a spring": (body + ls.spring(k=3, length=1, at=[0, 0, 1], anchor=[0, 1, 3]), [0.3, 1, -0.5]),
        "Suslov's body": (body + ls.nonholonomic("SO3", zero="a.dot(Omega)", a=[0, 0, 1]), [0.3, 1, 0]),
        "a body in space": (
            ls.lagrangian("SE3", l_d="((F - I) * K * (F - I).transpose()).trace() / (2 * h)", K=K), [0.3, 0.2, -0.4, 0.1, 0.5, 0.2]),
    }


def in_plain_runs(term: ls.Term, velocity: list[float], until: float = 100.0) -> float:
    """The time of a gradient by that of a run, both of 10,000 steps and in turns; machine code comes after some of them."""
    stepper, times = term.stepper(0.01), []
    for _ in range(40):
        begun = time.perf_counter()
        run = stepper.run(velocity=velocity, until=until, every=10_000)
        between = time.perf_counter()
        run.gradient(energy=[0.0, 1.0])
        times.append((between - begun, time.perf_counter() - between))
    plain, gradient = np.array(times).min(axis=0)
    return float(gradient / plain)


for name, torque in (("a list", [1e-6, 0.0, -1e-6]), ("an array", np.array([1e-6, 0.0, -1e-6]))):
    print(f"a loop: {1 / min(loop(torque) for _ in range(5)):.3g} steps a second of processor time, each with {name} as its torque")
print(f"an import: {1000 * imported():.0f} ms")
for name, (term, velocity) in gradients().items():
    print(f"a gradient of {name}: {in_plain_runs(term, velocity):.2f} plain runs")
if sys.argv[1:]:
    beside = ("a million steps", steps, lambda: in_rust("steps")), ("100,000 members", members, members_in_rust)
    for name, python, rust in beside:
        pairs = np.array([(python(), rust()) for _ in range(5)])
        best = pairs.min(axis=0)
        print(f"{name}: {best[0]:.2f} s from Python, {best[1]:.2f} s in Rust, ratio {best[0] / best[1]:.3f}")
