"""What a step of MuJoCo takes for the chains of the example hanging-chain, beside what the example takes.

    python -m pip install mujoco
    python examples/hanging-chain/with_mujoco.py

Both run here, one after the other for each length, and the times are the least of many short runs. MuJoCo's is the
semi-implicit Euler method of first order, with contacts and limits off; liestep's is of second order and keeps energy and
momentum. A step is a step: what it is worth is another question.
"""

import pathlib
import subprocess
import sys
import time

try:
    import mujoco
except ImportError as missing:
    # Who asks for it beside the example goes on without it.
    print(f"MuJoCo is left out: {missing}; python -m pip install mujoco")
    sys.exit()

ROOT = pathlib.Path(__file__).resolve().parents[2]
RUNS = 60


def chain(links, step):
    inertia = "0.088333333333333333 0.088333333333333333 0.01"
    body = f'<joint type="ball"/><inertial pos="0 0 -0.5" mass="1" diaginertia="{inertia}"/>'
    first = f'<body pos="0 0 0">{body}'
    more = f'<body pos="0 0 -1">{body}' * (links - 1)
    return f"""<mujoco><option timestep="{step}" gravity="0 0 -9.81" integrator="Euler">
        <flag contact="disable" constraint="disable"/></option>
        <worldbody>{first}{more}{"</body>" * links}</worldbody></mujoco>"""


def microseconds(links, step):
    model = mujoco.MjModel.from_xml_string(chain(links, step))
    data = mujoco.MjData(model)
    steps = max(1000 // links, 10)
    least = float("inf")
    for _ in range(RUNS):
        mujoco.mj_resetData(model, data)
        data.qvel[:] = 0.2
        begin = time.perf_counter()
        mujoco.mj_step(model, data, nstep=steps)
        least = min(least, (time.perf_counter() - begin) * 1e6 / steps)
    return least


def main():
    command = ["cargo", "run", "--release", "--quiet", "-p", "liestep-examples", "--example", "hanging-chain", "--", "times"]
    lines = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()
    print(f"links  step s  liestep µs  MuJoCo {mujoco.__version__} Euler µs  ratio")
    for line in lines[1:]:
        links, step, ours, _ = line.split()
        # Of both the step 2 ms would do as well: the time of MuJoCo's doesn't depend on it.
        theirs = microseconds(int(links), 0.002)
        print(f"{links:>5}  {step:>6}  {float(ours):10.2f}  {theirs:20.2f}  {theirs / float(ours):5.1f}")


main()
