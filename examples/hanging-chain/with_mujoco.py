"""What a step of MuJoCo takes for the chains of the example hanging-chain, beside what the example takes.

    python -m pip install mujoco
    python examples/hanging-chain/with_mujoco.py

Both start from the same attitudes and velocities with the same step, and run as many steps as often. They take turns for
each length, and the times are the least of all their runs. MuJoCo's is the semi-implicit Euler method of first order, with
contacts and limits off; liestep's is of second order, keeps the momentum about the vertical, and its energy doesn't drift. A
step is a step: what it is worth is another question.
"""

import pathlib
import subprocess
import sys
import time

try:
    import mujoco
    import numpy as np
except ImportError as missing:
    # Who asks for it beside the example goes on without it.
    print(f"MuJoCo is left out: {missing}; python -m pip install mujoco")
    sys.exit()

ROOT = pathlib.Path(__file__).resolve().parents[2]
# As in main.rs, for each of the turns.
STEPS = 1000
RUNS = 40
TURNS = 3
LENGTHS = [1, 2, 3, 5, 10, 20, 50, 100]


def chain(links, step):
    inertia = "0.088333333333333333 0.088333333333333333 0.01"
    body = f'<joint type="ball"/><inertial pos="0 0 -0.5" mass="1" diaginertia="{inertia}"/>'
    first = f'<body pos="0 0 0">{body}'
    more = f'<body pos="0 0 -1">{body}' * (links - 1)
    return f"""<mujoco><option timestep="{step}" gravity="0 0 -9.81" integrator="Euler">
        <flag contact="disable" constraint="disable"/></option>
        <worldbody>{first}{more}{"</body>" * links}</worldbody></mujoco>"""


def about(axis, angle):
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * np.array(axis))])


def product(a, b):
    result = np.empty(4)
    mujoco.mju_mulQuat(result, a, b)
    return result


def rotation(quaternion):
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, quaternion)
    return matrix.reshape(3, 3)


def start(links):
    """The attitudes of main.rs relative to the link before, and the velocities likewise, in each link's axes."""
    # Precession, and nutation.
    attitudes = [product(about([0, 0, 1], 0.4 if k % 2 == 0 else -0.3), about([1, 0, 0], 0.5)) for k in range(links)]
    velocity = np.array([0.1, 0.2, 0.0])
    positions, velocities = [attitudes[0]], [velocity]
    for before, after in zip(attitudes, attitudes[1:]):
        conjugate = before * np.array([1, -1, -1, -1])
        relative = product(conjugate, after)
        positions.append(relative)
        velocities.append(velocity - rotation(relative).T @ velocity)
    return np.concatenate(positions), np.concatenate(velocities)


def theirs(links, step):
    model = mujoco.MjModel.from_xml_string(chain(links, step))
    data = mujoco.MjData(model)
    positions, velocities = start(links)
    least = float("inf")
    for _ in range(RUNS):
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = positions, velocities
        begin = time.perf_counter()
        mujoco.mj_step(model, data, nstep=STEPS)
        least = min(least, (time.perf_counter() - begin) * 1e6 / STEPS)
    return least


def ours(links):
    """Step and time of the example."""
    command = ["cargo", "run", "--release", "--quiet", "-p", "liestep-examples", "--example", "hanging-chain", "--"]
    arguments = ["times", str(links)]
    lines = subprocess.run(command + arguments, cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()
    _, step, least, _ = lines[1].split()
    return step, float(least)


def main():
    print(f"links  step s  liestep µs  MuJoCo {mujoco.__version__} Euler µs  ratio")
    for links in LENGTHS:
        least = [float("inf")] * 2
        for _ in range(TURNS):
            step, time_of_ours = ours(links)
            least = [min(least[0], time_of_ours), min(least[1], theirs(links, float(step)))]
        print(f"{links:>5}  {step:>6}  {least[0]:10.2f}  {least[1]:20.2f}  {least[1] / least[0]:5.1f}")


main()
