"""Models of robots by `liestep import`, each beside MuJoCo's Runge-Kutta method.

Reads every URDF file below the folders that are given. A model is imported without its friction and without shapes, starts at the
zeros of its joints with a rate in each, and is run for a time by steps of 1 ms and 0.5 ms; centres of mass are compared with MuJoCo's by
steps of 0.1 ms, without limits, contacts and friction. A difference that falls by four is an error of second order.
"""

import argparse
import collections
import csv
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree
from pathlib import Path

import mujoco
import numpy as np

TIME = 0.25
# Of each joint at the start, rad/s or m/s.
RATE = 0.5


def plain(path: Path) -> str:
    """The text of a model without shapes, friction, limits and what belongs to other programs."""
    root = tree.parse(path).getroot()
    for link in root.iter("link"):
        for tag in ["visual", "collision", "contact"]:
            for shape in link.findall(tag):
                link.remove(shape)
    for joint in root.iter("joint"):
        for tag in ["limit", "mimic", "safety_controller", "calibration"]:
            for other in joint.findall(tag):
                joint.remove(other)
        if joint.get("type") == "revolute":
            joint.set("type", "continuous")
        for dynamics in joint.findall("dynamics"):
            dynamics.attrib.pop("friction", None)
    for child in list(root):
        if child.tag not in ("link", "joint"):
            root.remove(child)
    return tree.tostring(root, encoding="unicode")


def ours(program: str, scene: Path, step: str) -> dict[str, np.ndarray]:
    """Centres of mass at the end, by the names of the bodies."""
    text = scene.read_text().replace('"1 ms"', f'"{step}"').replace("duration = 1\n", f"duration = {TIME}\n")
    text = text.replace("\nangle = 0\n", f"\nrate = {RATE}\n").replace("\nshift = 0\n", f"\nspeed = {RATE}\n")
    again = scene.with_name("again.toml")
    again.write_text(text)
    call = [program, "run", "again.toml", "--csv", "--out", "out"]
    made = subprocess.run(call, cwd=scene.parent, capture_output=True, text=True, timeout=300)
    if made.returncode:
        raise RuntimeError(made.stderr.strip().splitlines()[-1])
    rows = list(csv.reader((scene.parent / "out" / "again.csv").open()))
    names = {}
    for column, name in enumerate(rows[0]):
        found = re.fullmatch(r"(.*)_x", name)
        if found and rows[0][column + 2] == f"{found[1]}_z":
            names[found[1]] = np.array([float(cell) for cell in rows[-1][column : column + 3]])
    return names


def theirs(text: str) -> dict[str, np.ndarray]:
    """Centres of mass at the end by MuJoCo, by the names of the bodies."""
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.timestep = 1e-4
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT) | int(mujoco.mjtDisableBit.mjDSBL_LIMIT)
    data = mujoco.MjData(model)
    for joint in range(model.njnt):
        if model.jnt_type[joint] in (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)):
            data.qvel[model.jnt_dofadr[joint]] = RATE
    mujoco.mj_forward(model, data)
    for _ in range(round(TIME / model.opt.timestep)):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    return {model.body(body).name: data.xipos[body].copy() for body in range(1, model.nbody)}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the program liestep")
    parser.add_argument("folders", nargs="+", type=Path)
    given = parser.parse_args()
    program = str(Path(given.program).resolve())
    paths = sorted({path for folder in given.folders for path in folder.rglob("*.urdf")})
    counts: collections.Counter[str] = collections.Counter()
    wrong = []
    print(f"{len(paths)} models\n{'model':<44}{'bodies':>7}{'1 ms, m':>11}{'0.5 ms, m':>11}{'ratio':>7}")
    for path in paths:
        name = f"{path.parent.name}/{path.name}"[-43:]
        with tempfile.TemporaryDirectory() as folder:
            robot = Path(folder) / "robot.urdf"
            try:
                text = plain(path)
            except tree.ParseError as error:
                counts["no XML"] += 1
                print(f"{name:<44} isn't XML: {error}")
                continue
            robot.write_text(text)
            made = subprocess.run([program, "import", "robot.urdf", "--out", "."], cwd=folder, capture_output=True, text=True)
            if made.returncode:
                counts["refused"] += 1
                print(f"{name:<44} {made.stderr.strip().splitlines()[-1][:110]}")
                continue
            counts["imported"] += 1
            if "[[joint]]" not in (Path(folder) / "robot.toml").read_text():
                counts["of one body"] += 1
                continue
            if re.search("given|raised|has no dry", made.stderr):
                counts["with a mass or an inertia that was chosen"] += 1
                continue
            try:
                expected = theirs(text)
            except ValueError as error:
                counts["MuJoCo refuses"] += 1
                print(f"{name:<44} MuJoCo: {str(error).splitlines()[0][:100]}")
                continue
            try:
                ends = [ours(program, Path(folder) / "robot.toml", step) for step in ("1 ms", "0.5 ms")]
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                counts["stopped"] += 1
                wrong.append(name)
                print(f"{name:<44} {error}")
                continue
        both = sorted(set(expected) & set(ends[0]))
        off = [max((np.linalg.norm(end[body] - expected[body]) for body in both), default=np.nan) for end in ends]
        is_right = len(both) > 0 and off[0] < 1e-3 and (off[0] / max(off[1], 1e-300) > 3.5 or off[0] < 1e-9)
        counts["compared"] += 1
        if not is_right:
            wrong.append(name)
        print(f"{name:<44}{len(both):>7}{off[0]:>11.1e}{off[1]:>11.1e}{off[0] / max(off[1], 1e-300):>7.2f}{'' if is_right else '  !'}", flush=True)
    for name, count in counts.most_common():
        print(f"{count:>6} {name}")
    if wrong:
        print(f"not of second order, or stopped: {', '.join(wrong)}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
