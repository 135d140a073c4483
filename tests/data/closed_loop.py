"""Writes closed_loop.json: three bodies on ball joints between two pivots, a closed loop.

    python tests/data/closed_loop.py > tests/data/closed_loop.json

Newton's and Euler's equations of each body in inertial coordinates with quaternions. The forces of the joints are found
from the second derivatives of what they hold together, and nothing pulls the solution back: how far the joints have
opened at the end is an error estimate. Extrapolated midpoint steps of two sizes, by mpmath with 40 digits; a minute.
"""

import json

from elimination import solve
from mpmath import mp, mpf, nstr

mp.dps = 40

G = mpf("9.81")
BODIES = [
    {"m": "1.2", "J": ["0.03", "0.12", "0.11"], "left": ["-0.5", "0.05", "0"], "right": ["0.5", "0", "0.02"]},
    {"m": "0.7", "J": ["0.02", "0.06", "0.07"], "left": ["-0.4", "0", "0.1"], "right": ["0.3", "0.1", "-0.05"]},
    {"m": "2", "J": ["0.15", "0.2", "0.3"], "left": ["-0.6", "-0.1", "0"], "right": ["0.55", "0.02", "0.1"]},
]
# Not of length one yet, scalar part first; and velocities that the joints have to correct.
ATTITUDES = [["9", "1", "4", "1"], ["10", "2", "0.5", "-2"], ["9", "-1", "-4", "1.5"]]
TURNING = [["0.5", "1.5", "-0.7"], ["-1", "0.3", "1.2"], ["0.8", "-1.1", "0.4"]]

M = [mpf(b["m"]) for b in BODIES]
J = [[mpf(x) for x in b["J"]] for b in BODIES]
LEFT = [[mpf(x) for x in b["left"]] for b in BODIES]
RIGHT = [[mpf(x) for x in b["right"]] for b in BODIES]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def add(*vectors):
    return [sum(entries) for entries in zip(*vectors)]


def scale(s, a):
    return [s * x for x in a]


def rotation(q):
    w, x, y, z = q
    s = 2 / (w * w + x * x + y * y + z * z)
    return [
        [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
    ]


def out(r, a):
    return [sum(r[i][k] * a[k] for k in range(3)) for i in range(3)]


def into(r, a):
    return [sum(r[k][i] * a[k] for k in range(3)) for i in range(3)]


# The ends that meet: (body, point, sign); a pivot has one.
JOINTS = [
    [(0, LEFT[0], 1)],
    [(1, LEFT[1], 1), (0, RIGHT[0], -1)],
    [(2, LEFT[2], 1), (1, RIGHT[1], -1)],
    [(2, RIGHT[2], 1)],
]


def pushed(r, body, point, force):
    """What a force at a point does to velocity and body rates."""
    torque = cross(point, into(r[body], force))
    return scale(1 / M[body], force), [t / j for t, j in zip(torque, J[body])]


def responses(r):
    """How the gap of each joint is moved by unit forces in each joint: minus what multipliers have to undo."""
    columns = []
    for joint in JOINTS:
        for k in range(3):
            v, w = [[mpf(0)] * 3 for _ in M], [[mpf(0)] * 3 for _ in M]
            for body, point, sign in joint:
                force = [mpf(sign) if i == k else mpf(0) for i in range(3)]
                dv, dw = pushed(r, body, point, force)
                v[body], w[body] = add(v[body], dv), add(w[body], dw)
            columns.append((v, w))
    return columns


def opening(r, v, w):
    gaps = []
    for joint in JOINTS:
        gap = [mpf(0)] * 3
        for body, point, sign in joint:
            gap = add(gap, scale(sign, add(v[body], out(r[body], cross(w[body], point)))))
        gaps += gap
    return gaps


def corrected(r, v, w, extra):
    """Velocities or accelerations with the least change that brings the opening to minus the extra."""
    columns = responses(r)
    images = [opening(r, *column) for column in columns]
    n = len(images)
    matrix = [[images[j][i] for j in range(n)] for i in range(n)]
    right = [-a - b for a, b in zip(opening(r, v, w), extra)]
    multipliers = solve(matrix, right)
    for (dv, dw), multiplier in zip(columns, multipliers):
        for body in range(3):
            if any(dv[body]) or any(dw[body]):
                v[body] = add(v[body], scale(multiplier, dv[body]))
                w[body] = add(w[body], scale(multiplier, dw[body]))
    return v, w


def rate(state):
    bodies = [state[13 * k : 13 * k + 13] for k in range(3)]
    r = [rotation(b[3:7]) for b in bodies]
    turning = [b[10:] for b in bodies]
    a = [[mpf(0), mpf(0), -G] for _ in M]
    alpha = [[x / j for x, j in zip(cross([j * x for j, x in zip(J[k], turning[k])], turning[k]), J[k])] for k in range(3)]
    extra = []
    for joint in JOINTS:
        gap = [mpf(0)] * 3
        for body, point, sign in joint:
            inward = cross(turning[body], cross(turning[body], point))
            gap = add(gap, scale(sign, out(r[body], inward)))
        extra += gap
    a, alpha = corrected(r, a, alpha, extra)
    result = []
    for k, b in enumerate(bodies):
        (w, x, y, z), (p, q, s) = b[3:7], turning[k]
        turned = [-x * p - y * q - z * s, w * p + y * s - z * q, w * q + z * p - x * s, w * s + x * q - y * p]
        result += b[7:10] + scale(mpf("0.5"), turned) + a[k] + alpha[k]
    return result


ORDER = 12


def step(state, h):
    """Extrapolated modified midpoint steps of 2, 4, … parts."""
    table = []
    first = rate(state)
    for i in range(ORDER):
        parts = 2 * (i + 1)
        part = h / parts
        before, now = state, [x + part * d for x, d in zip(state, first)]
        for _ in range(parts - 1):
            d = rate(now)
            before, now = now, [x + 2 * part * y for x, y in zip(before, d)]
        d = rate(now)
        row = [[(x + y + part * z) / 2 for x, y, z in zip(before, now, d)]]
        for j in range(i):
            ratio = mpf(parts) / (2 * (i - j))
            factor = 1 / (ratio * ratio - 1)
            row.append([x + (x - y) * factor for x, y in zip(row[j], table[j])])
        table = row
    return table[-1]


def start():
    state, place = [], [mpf(0)] * 3
    r, v, w, quaternions, places = [], [], [], [], []
    velocity = [mpf(0)] * 3
    for k in range(3):
        q = [mpf(x) for x in ATTITUDES[k]]
        q = scale(1 / sum(x * x for x in q) ** mpf("0.5"), q)
        turning = [mpf(x) for x in TURNING[k]]
        r.append(rotation(q))
        centre = add(place, scale(-1, out(r[k], LEFT[k])))
        place = add(centre, out(r[k], RIGHT[k]))
        v.append(velocity)
        w.append(turning)
        quaternions.append(q)
        places.append(centre)
    v, w = corrected(r, v, w, [mpf(0)] * 12)
    for k in range(3):
        state += places[k] + quaternions[k] + v[k] + w[k]
    return state, place


def energy(state):
    total = mpf(0)
    for k in range(3):
        b = state[13 * k : 13 * k + 13]
        total += M[k] * sum(x * x for x in b[7:10]) / 2 + sum(j * x * x for j, x in zip(J[k], b[10:])) / 2 + M[k] * G * b[2]
    return total


def open_by(state, pivot):
    most = mpf(0)
    for joint in JOINTS:
        gap = [mpf(0)] * 3
        for body, point, sign in joint:
            b = state[13 * body : 13 * body + 13]
            gap = add(gap, scale(sign, add(b[:3], out(rotation(b[3:7]), point))))
        if joint is JOINTS[-1]:
            gap = add(gap, scale(-1, pivot))
        most = max(most, max(abs(x) for x in gap))
    return most


def texts(a):
    return [nstr(x, 25) for x in a]


def written(t, state):
    bodies = []
    for k in range(3):
        b = state[13 * k : 13 * k + 13]
        r = [texts(row) for row in rotation(b[3:7])]
        bodies.append({"x": texts(b[:3]), "R": r, "v": texts(b[7:10]), "Omega_body": texts(b[10:])})
    return {"t": t, "energy": nstr(energy(state), 25), "bodies": bodies}


def main():
    first, pivot = start()
    ends = []
    for steps in [16, 24]:
        state = first
        for _ in range(steps):
            state = step(state, mpf(1) / steps)
        ends.append(state)
    agreement = max(abs(a - b) for a, b in zip(*ends))
    result = {
        "description": "Three bodies on ball joints between two pivots: inertial coordinates, quaternions, Newton's and Euler's "
        "equations with the forces of joints from second derivatives, extrapolated midpoint steps of 40 digits",
        "parameters": {"g": "9.81", "bodies": BODIES, "pivot": texts(pivot)},
        "agreement_of_two_step_sizes": nstr(agreement, 3),
        "energy_moved_by": nstr(energy(ends[1]) - energy(first), 3),
        "joints_open_by": nstr(open_by(ends[1], pivot), 3),
        "states": [written(0, first), written(1, ends[1])],
    }
    print(json.dumps(result, indent=1))


main()
