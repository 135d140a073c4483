"""What the Taylor integrator heyoka takes for the scenes of the example accuracy-cost, for whoever has it.

    python -m pip install heyoka
    python examples/accuracy-cost/with_heyoka.py [--out out/accuracy-cost] [--scene looping]

Variables, references, error and columns are those of the example; the times are of one processor, the fastest of
repeated runs, without the compilation of the Taylor series. Batches integrate four copies of the scene in the lanes of
one processor, and the time is that of one copy.
"""

import argparse
import csv
import json
import pathlib
import sys
import time

try:
    import heyoka as hy
    import numpy as np
except ImportError as missing:
    # Who asks for it beside other methods goes on without it.
    print(f"heyoka is left out: {missing}; python -m pip install heyoka")
    sys.exit()

DATA = pathlib.Path(__file__).resolve().parents[2] / "tests" / "data"
SCENES = {
    "looping": "thesis_looping_A_Jd221",
    "cuspidal": "thesis_cuspidal_A_Jd221",
    "third": "thesis_unidirectional_A_Jd221",
    "chaotic": "chaotic_asymmetric_top",
    "free": "free_asymmetric_body",
    "sprung": "spring_asymmetric_top",
    "orbiting": "fast_satellite",
}
ERRORS = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12]
LANES = 4
# For each run, s.
REPEATED = 0.05


class Scene:
    """A body, its start and its exact states, as the example reads them."""

    def __init__(self, file):
        data = json.loads((DATA / f"{file}.json").read_text())
        self.apart = "initial" in data
        self.weight = float(data["m"]) * float(data["g"]) if self.apart else float(data["mg"])
        nonstandard = np.array(data["J_d"], float)
        self.moments = nonstandard.sum() - nonstandard
        self.rho = np.array(data["rho"], float)
        self.spring = data.get("spring")
        # Three times the gravitational parameter over the cube of the distance.
        self.gradient = 3.0 if file == "fast_satellite" else None
        self.states = {round(float(state["t"]), 9): self.end(state) for state in data["states"]}
        attitude, rate = self.end(data["initial"]) if self.apart else self.states[0.0]
        self.start = [*quaternion(attitude), *(self.moments * rate)]

    def end(self, state):
        attitude = np.array(state["R" if self.apart else "R_row_major"], float).reshape(3, 3)
        return attitude, np.array(state["Omega"], float)

    def error(self, y, t):
        attitude, rate = rotation(y[:4]), y[4:] / self.moments
        exact_attitude, exact_rate = self.states[t]
        relative = lambda value, exact: np.linalg.norm(value - exact) / np.linalg.norm(exact)
        return float(np.hypot(relative(attitude, exact_attitude), relative(rate, exact_rate)))

    def equations(self):
        """`q' = ½ q Ω`, `p' = p × Ω + τ`, where `τ` is `m g w × ρ`, with a spring's `k (1 − l/|d|) a × b`, or `g w × Jw`."""
        a, b, c, d, p1, p2, p3 = variables = hy.make_vars("a", "b", "c", "d", "p1", "p2", "p3")
        o1, o2, o3 = (p / moment for p, moment in zip((p1, p2, p3), map(float, self.moments)))
        l1, l2, l3 = map(float, self.weight * self.rho)
        w1, w2, w3 = 2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c
        t1, t2, t3 = w2 * l3 - w3 * l2, w3 * l1 - w1 * l3, w1 * l2 - w2 * l1
        if self.spring:
            k, length = float(self.spring["k"]), float(self.spring["length"])
            (x, y, z), (u, v, w) = ([float(entry) for entry in self.spring[key]] for key in ("anchor", "at"))
            e1 = (a * a + b * b - c * c - d * d) * x + 2.0 * ((b * c + a * d) * y + (b * d - a * c) * z)
            e2 = (a * a - b * b + c * c - d * d) * y + 2.0 * ((b * c - a * d) * x + (c * d + a * b) * z)
            e3 = w3 * z + 2.0 * ((b * d + a * c) * x + (c * d - a * b) * y)
            pull = k - k * length / hy.sqrt((u - e1) ** 2 + (v - e2) ** 2 + (w - e3) ** 2)
            t1, t2, t3 = t1 + pull * (v * e3 - w * e2), t2 + pull * (w * e1 - u * e3), t3 + pull * (u * e2 - v * e1)
        elif self.gradient:
            j1, j2, j3 = (self.gradient * float(moment) for moment in self.moments)
            t1, t2, t3 = (j3 - j2) * (w2 * w3), (j1 - j3) * (w3 * w1), (j2 - j1) * (w1 * w2)
        rates = [
            -0.5 * (b * o1 + c * o2 + d * o3),
            0.5 * (a * o1 + c * o3 - d * o2),
            0.5 * (a * o2 + d * o1 - b * o3),
            0.5 * (a * o3 + b * o2 - c * o1),
            p2 * o3 - p3 * o2 + t1,
            p3 * o1 - p1 * o3 + t2,
            p1 * o2 - p2 * o1 + t3,
        ]
        return list(zip(variables, rates))


def quaternion(matrix):
    """The unit quaternion `(q_0, q)` of a rotation matrix, by the largest of its four components."""
    m, trace = matrix, np.trace(matrix)
    symmetric = np.array(
        [
            [trace, m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]],
            [0.0, 2 * m[0, 0] - trace, m[0, 1] + m[1, 0], m[0, 2] + m[2, 0]],
            [0.0, 0.0, 2 * m[1, 1] - trace, m[1, 2] + m[2, 1]],
            [0.0, 0.0, 0.0, 2 * m[2, 2] - trace],
        ]
    )
    symmetric = np.triu(symmetric) + np.triu(symmetric, 1).T + np.eye(4)
    row = symmetric[np.argmax(np.diag(symmetric))]
    return row / np.linalg.norm(row)


def rotation(q):
    """As it is: what has lost the length of its quaternion shall show it."""
    a, b, c, d = q
    return np.array(
        [
            [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d],
        ]
    )


def reset(integrator):
    """Back to the time zero: of a batch, in all lanes."""
    if isinstance(integrator.time, float):
        integrator.time = 0.0
    else:
        integrator.set_time(np.zeros(LANES))


def timed(integrator, start, t):
    """Where a run ends, and how long the fastest of its repetitions took, s."""
    began, best = time.perf_counter(), float("inf")
    while time.perf_counter() - began < REPEATED:
        reset(integrator)
        integrator.state[:] = start
        instant = time.perf_counter()
        integrator.propagate_until(t)
        best = min(best, time.perf_counter() - instant)
    return integrator.state, best


def cost_of(runs, wanted):
    """The least time to an error, on straight lines between the runs, both axes logarithmic."""
    found = [cost for _, error, cost in runs if error <= wanted]
    for (_, coarse, cheap), (_, fine, dear) in zip(runs, runs[1:]):
        if coarse > wanted >= fine:
            found.append(cheap * (dear / cheap) ** (np.log(coarse / wanted) / np.log(coarse / fine)))
    return min(found, default=None)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/accuracy-cost"))
    arguments.add_argument("--scene", choices=SCENES, action="append")
    arguments = arguments.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows = [("scene", "t_s", "method", "step_s_or_tolerance", "error", "cost_s")]
    print("µs to an error of".ljust(34), *(f"{error:9.0e}" for error in ERRORS))
    for short in arguments.scene or SCENES:
        scene = Scene(SCENES[short])
        runs = {}
        for tolerance in 10.0 ** -np.arange(3.0, 16.1, 0.5):
            single = hy.taylor_adaptive(scene.equations(), scene.start, tol=tolerance)
            copies = np.repeat(np.array(scene.start)[:, None], LANES, axis=1)
            batch = hy.taylor_adaptive_batch(scene.equations(), copies.copy(), tol=tolerance)
            for t in (10.0, 100.0):
                end, cost = timed(single, scene.start, t)
                runs.setdefault((t, "heyoka"), []).append((tolerance, scene.error(end, t), cost))
                end, cost = timed(batch, copies, t)
                lane = (tolerance, scene.error(end[:, 0], t), cost / LANES)
                runs.setdefault((t, f"heyoka + batch of {LANES}"), []).append(lane)
        for (t, name), measured in sorted(runs.items()):
            costs = (cost_of(measured, error) for error in ERRORS)
            cells = ("–" if cost is None else f"{cost * 1e6:.1f}" for cost in costs)
            print(f"{short}, t = {t:g}, {name}".ljust(34), *(cell.rjust(9) for cell in cells), flush=True)
            rows += [(short, f"{t:g}", name, f"{p:e}", f"{error:e}", f"{cost:e}") for p, error, cost in measured]
    with open(arguments.out / "heyoka.csv", "w", newline="") as file:
        csv.writer(file).writerows(rows)


if __name__ == "__main__":
    main()
