"""What the Taylor integrator heyoka takes for ten seconds of symmetric tops, in batches of four, µs a top.

Called by `cargo bench -p liestep-benches -- splittings`, which gives the tops and where they end, a line for each: two moments, weight times distance, quaternion, momentum, vertical and velocity at the end. Without the
compilation of the Taylor series; of repeated runs the fastest counts.
"""

import sys
import time

try:
    import heyoka as hy
    import numpy as np
except ImportError as missing:
    print(f"heyoka is left out: {missing}; python -m pip install heyoka", file=sys.stderr)
    sys.exit()

LANES = 4
TIME = 10.0
REPEATED = 30
ERRORS = [1e-6, 1e-8]


def equations():
    """`q' = ½ q Ω`, `p' = p × Ω + τ`, where `τ` is the weight's, with the moments and the weight as parameters."""
    a, b, c, d, p1, p2, p3 = variables = hy.make_vars("a", "b", "c", "d", "p1", "p2", "p3")
    o1, o2, o3 = p1 / hy.par[0], p2 / hy.par[0], p3 / hy.par[1]
    w1, w2 = 2.0 * (b * d - a * c), 2.0 * (c * d + a * b)
    rates = [
        -0.5 * (b * o1 + c * o2 + d * o3),
        0.5 * (a * o1 + c * o3 - d * o2),
        0.5 * (a * o2 + d * o1 - b * o3),
        0.5 * (a * o3 + b * o2 - c * o1),
        p2 * o3 - p3 * o2 + w2 * hy.par[2],
        p3 * o1 - p1 * o3 - w1 * hy.par[2],
        p1 * o2 - p2 * o1,
    ]
    return list(zip(variables, rates))


def measured(tops, tolerance):
    """The error, and the time of a top, s."""
    integrator = hy.taylor_adaptive_batch(
        equations(), np.zeros((7, LANES)), pars=np.ones((3, LANES)), tol=tolerance, fast_math=True
    )
    ends, total = np.zeros((len(tops), 7)), 0.0
    for first in range(0, len(tops), LANES):
        four, fastest = tops[first : first + LANES], float("inf")
        integrator.pars[:] = four[:, :3].T
        for _ in range(REPEATED):
            integrator.set_time(np.zeros(LANES))
            integrator.state[:] = four[:, 3:10].T
            instant = time.perf_counter()
            integrator.propagate_until(TIME)
            fastest = min(fastest, time.perf_counter() - instant)
        ends[first : first + LANES] = integrator.state.T
        total += fastest
    a, b, c, d = ends[:, :4].T
    vertical = np.stack([2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c], axis=1)
    rates = ends[:, 4:] / tops[:, [0, 0, 1]]
    exact = tops[:, 13:16]
    squares = ((vertical - tops[:, 10:13]) ** 2).sum(axis=1)
    squares += ((rates - exact) ** 2).sum(axis=1) / (exact**2).sum(axis=1)
    return float(np.sqrt(squares.mean())), total / len(tops)


def cost_of(runs, wanted):
    """The least time to an error, on straight lines between the runs, both axes logarithmic."""
    found = [cost for error, cost in runs if error <= wanted]
    for (coarse, cheap), (fine, dear) in zip(runs, runs[1:]):
        if coarse > wanted >= fine:
            found.append(cheap * (dear / cheap) ** (np.log(coarse / wanted) / np.log(coarse / fine)))
    return min(found)


tops = np.array([[float(word) for word in line.split()] for line in sys.stdin])
runs = [measured(tops, tolerance) for tolerance in 10.0 ** -np.arange(5.0, 11.1, 0.5)]
print(*(cost_of(runs, wanted) * 1e6 for wanted in ERRORS))
