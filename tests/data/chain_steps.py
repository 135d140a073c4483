"""Writes chain_steps.json: how far steps of the chain of several_bodies.json end from its reference.

    python tests/data/chain_steps.py > tests/data/chain_steps.json

The discrete Euler-Lagrange equations of the action in terms of where all masses are, in inertial coordinates: nothing is
reduced or eliminated. Increments are exponentials, found by Newton's iteration with differences; some ten seconds.
"""

import json
import math
import pathlib

from elimination import solve

DATA = json.loads(pathlib.Path(__file__).with_name("several_bodies.json").read_text())["chain3"]
LINKS, G = DATA["parameters"]["bodies"], DATA["parameters"]["g"]
N = range(3)
# Nonstandard, about the centre of mass: a matrix with these on its diagonal.
CENTRAL = [[sum(link["J_cm"]) / 2 - moment for moment in link["J_cm"]] for link in LINKS]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in N) for j in N] for i in N]


def transposed(a):
    return [list(row) for row in zip(*a)]


def acting(a, v):
    return [sum(x * y for x, y in zip(row, v)) for row in a]


def hat(w):
    return [[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]]


def exp(w):
    """Rodrigues' formula."""
    angle = math.sqrt(sum(x * x for x in w))
    first = math.sin(angle) / angle if angle else 1
    second = 2 * (math.sin(angle / 2) / angle) ** 2 if angle else 0.5
    k = hat(w)
    square = times(k, k)
    return [[(i == j) + first * k[i][j] + second * square[i][j] for j in N] for i in N]


def places(r):
    """Of the centres of mass, linear in the attitudes."""
    joint, centres = [0, 0, 0], []
    for a, link in zip(r, LINKS):
        centres.append([x + y for x, y in zip(joint, acting(a, link["c"]))])
        joint = [x + y for x, y in zip(joint, acting(a, link["rho"]))]
    return centres


def torques(r, rates, forces):
    """Moments in the body frames of the kinetic energy's derivatives by rates of attitudes, and of forces on the masses."""
    found, beyond = [], [0, 0, 0]
    for a, rate, force, link, central in reversed(list(zip(r, rates, forces, LINKS, CENTRAL))):
        gradient = [
            [rate[i][j] * central[j] + force[i] * link["c"][j] + beyond[i] * link["rho"][j] for j in N] for i in N
        ]
        beyond = [x + y for x, y in zip(beyond, force)]
        m = times(transposed(a), gradient)
        found = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]] + found
    return found


def momenta(r, velocity):
    rates = [times(a, hat(velocity[3 * k : 3 * k + 3])) for k, a in enumerate(r)]
    return torques(r, rates, [[link["m"] * x for x in v] for link, v in zip(LINKS, places(rates))])


def ends(r, after, h):
    """What the momenta before and after a step are by the derivatives of its action."""
    rates = [[[(y - x) / h for x, y in zip(*rows)] for rows in zip(*pair)] for pair in zip(r, after)]
    moved = [[link["m"] * x for x in v] for link, v in zip(LINKS, places(rates))]
    kicked = lambda sign: [
        [x + sign * (0.5 * h * link["m"] * G if k == 2 else 0) for k, x in enumerate(f)] for link, f in zip(LINKS, moved)
    ]
    return torques(r, rates, kicked(1)), torques(after, rates, kicked(-1))


def turned(r, u):
    return [times(a, exp(u[3 * k : 3 * k + 3])) for k, a in enumerate(r)]


def step(r, p, guess, h):
    missed = lambda u: [x - y for x, y in zip(ends(r, turned(r, u), h)[0], p)]
    u, small = guess, 1e-6
    for _ in range(20):
        here, columns = missed(u), []
        for k in range(9):
            next_to = [missed([x + s * (i == k) for i, x in enumerate(u)]) for s in (small, -small)]
            columns.append([(x - y) / (2 * small) for x, y in zip(*next_to)])
        update = solve(transposed(columns), here)
        u = [x - y for x, y in zip(u, update)]
        if max(map(abs, update)) < 1e-14:
            after = turned(r, u)
            return after, ends(r, after, h)[1], u
    raise ArithmeticError(f"no increment: {update}")


def state(k):
    bodies = DATA["states"][k]["bodies"]
    read = lambda numbers: [float(x) for x in numbers]
    return [[read(row) for row in b["R"]] for b in bodies], sum((read(b["Omega_body"]) for b in bodies), [])


def errors(h, steps):
    (r, velocity), (last, last_velocity) = state(0), state(1)
    p, u = momenta(r, velocity), [h * x for x in velocity]
    for _ in range(steps):
        r, p, u = step(r, p, u, h)
    velocity = solve(transposed([momenta(r, [float(i == k) for i in range(9)]) for k in range(9)]), p)
    attitude = max(abs(x - y) for rows in zip(r[0], last[0]) for x, y in zip(*rows))
    return {
        "h": h,
        "attitude": f"{attitude:.6e}",
        "velocity": f"{max(abs(x - y) for x, y in zip(velocity[6:], last_velocity[6:])):.6e}",
    }


about = "The largest errors of an entry of the first attitude and of the last body velocity of chain3, at t = 2"
runs = [errors(h, steps) for h, steps in [(0.02, 100), (0.01, 200), (0.005, 400), (0.0025, 800)]]
print(json.dumps({"description": about, "errors": runs}, indent=1))
