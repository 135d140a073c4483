"""Models of robots by `liestep import`, each beside MuJoCo's Runge-Kutta method.

Reads every file of URDF, and of MJCF that is a model by itself, below the folders that are given. A model is imported and starts at the
zeros of its joints, with a rate in each pin and slider; it is run for a time by steps of 1 ms and 0.5 ms; centres of mass are compared with
MuJoCo's by steps of 0.1 ms, or of 0.01 ms where damping is too strong for explicit steps as long as that. Limits, contacts, dry friction, motors, tendons, air, and springs, damping and the inertia of rotors in other
joints are left out of both. A difference that falls by four is an error of second order.
"""

import argparse
import collections
import csv
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree
from collections.abc import Callable
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


def bare(scene: str) -> tuple[str, set[str]]:
    """The text of a scene with a rate in each pin and slider and without dry friction, and the names of these joints."""
    tables = scene.split("[[joint]]")
    names = set()
    for number, table in enumerate(tables[1:], 1):
        table = re.sub(r"^friction = .*\n", "", table, flags=re.M)
        kind = re.search(r'^kind = "(.*)"', table, flags=re.M)
        if kind and kind[1] in ("pin", "slider"):
            names.add(re.search(r'^name = "(.*)"', table, flags=re.M)[1])
        else:
            table = re.sub(r"^(damping|stiffness|rest|armature) = .*\n", "", table, flags=re.M)
        tables[number] = table
    text = "[[joint]]".join(tables)
    return text.replace("\nangle = 0\n", f"\nrate = {RATE}\n").replace("\nshift = 0\n", f"\nspeed = {RATE}\n"), names


def ours(program: str, folder: Path, scene: str, step: str) -> dict[str, np.ndarray]:
    """Centres of mass at the end, by the names of the bodies."""
    text = scene.replace('"1 ms"', f'"{step}"').replace("duration = 1\n", f"duration = {TIME}\n")
    (folder / "again.toml").write_text(text)
    call = [program, "run", "again.toml", "--csv", "--out", "out"]
    made = subprocess.run(call, cwd=folder, capture_output=True, text=True, timeout=300)
    if made.returncode:
        raise RuntimeError(made.stderr.strip().splitlines()[-1])
    rows = list(csv.reader((folder / "out" / "again.csv").open()))
    names = {}
    for column, name in enumerate(rows[0]):
        found = re.fullmatch(r"(.*)_x", name)
        if found and rows[0][column + 2] == f"{found[1]}_z":
            names[found[1]] = np.array([float(cell) for cell in rows[-1][column : column + 3]])
    return names


def label(name: str) -> str:
    """A name of letters, digits, `-` and `_`."""
    return "".join(letter if letter.isalnum() or letter in "_-" else "-" for letter in name)


def theirs(model: mujoco.MjModel, moving: set[str], step: float) -> dict[str, np.ndarray]:
    """Centres of mass at the end by MuJoCo with a step, s, by the names of the bodies; those that are fixed to each other are one."""
    off = mujoco.mjtDisableBit
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.timestep = step
    for bit in (off.mjDSBL_CONTACT, off.mjDSBL_LIMIT, off.mjDSBL_EQUALITY, off.mjDSBL_ACTUATION, off.mjDSBL_FRICTIONLOSS):
        model.opt.disableflags |= int(bit)
    model.opt.density, model.opt.viscosity, model.opt.wind = 0, 0, 0
    model.body_gravcomp[:] = 0
    model.tendon_stiffness[:], model.tendon_damping[:] = 0, 0
    data = mujoco.MjData(model)
    for joint in range(model.njnt):
        body = model.jnt_bodyid[joint]
        own = model.body(body).name or f"body-{body}"
        if model.body_jntnum[body] > 1:
            own = f"{own}-{joint - model.body_jntadr[body] + 1}"
        first, count = model.jnt_dofadr[joint], {0: 6, 1: 3}.get(int(model.jnt_type[joint]), 1)
        own = label(model.joint(joint).name or own)
        # Bodies come first where a joint has the name of one.
        if moving & {own, f"{own}-2"}:
            data.qvel[first] = RATE
        else:
            model.jnt_stiffness[joint] = 0
            model.dof_damping[first : first + count] = 0
            model.dof_armature[first : first + count] = 0
    mujoco.mj_forward(model, data)
    for _ in range(round(TIME / model.opt.timestep)):
        mujoco.mj_step(model, data)
    if any(data.warning[int(kind)].number for kind in (mujoco.mjtWarning.mjWARN_BADQACC, mujoco.mjtWarning.mjWARN_BADQPOS)):
        return {}
    mujoco.mj_forward(model, data)
    centres = {}
    for body in range(1, model.nbody):
        fixed = [other for other in range(1, model.nbody) if model.body_weldid[other] == body]
        mass = sum(model.body_mass[other] for other in fixed)
        if mass > 0:
            centre = sum(model.body_mass[other] * data.xipos[other] for other in fixed) / mass
            centres[label(model.body(body).name or f"body-{body}")] = centre
    return centres


def loaded(path: Path, folder: Path) -> tuple[Path, Callable[[], mujoco.MjModel]]:
    """The file that is imported, and the model as MuJoCo reads it."""
    if path.suffix == ".urdf":
        text = plain(path)
        robot = folder / "robot.urdf"
        robot.write_text(text)
        return robot, lambda: mujoco.MjModel.from_xml_string(text)
    return path, lambda: mujoco.MjModel.from_xml_path(str(path))


def models(folder: Path) -> list[Path]:
    """Files of URDF, and those of MJCF with bodies that no other file includes."""
    files = list(folder.rglob("*.xml"))
    texts = {path: path.read_text(errors="replace") for path in files}
    parts = {(path.parent / name).resolve() for path, text in texts.items() for name in re.findall(r'<include\s+file="(.*?)"', text)}
    whole = [path for path, text in texts.items() if "<mujoco" in text and "<worldbody" in text and path.resolve() not in parts]
    return sorted([*folder.rglob("*.urdf"), *whole])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the program liestep")
    parser.add_argument("folders", nargs="+", type=Path)
    given = parser.parse_args()
    program = str(Path(given.program).resolve())
    paths = [path for folder in given.folders for path in models(folder.resolve())]
    counts: collections.Counter[str] = collections.Counter()
    wrong = []
    print(f"{len(paths)} models\n{'model':<44}{'bodies':>7}{'1 ms, m':>11}{'0.5 ms, m':>11}{'ratio':>7}")
    for path in paths:
        name = f"{path.parent.name}/{path.name}"[-43:]
        with tempfile.TemporaryDirectory() as kept:
            folder = Path(kept)
            try:
                robot, model = loaded(path, folder)
            except tree.ParseError as error:
                counts["no XML"] += 1
                print(f"{name:<44} isn't XML: {error}")
                continue
            made = subprocess.run([program, "import", str(robot), "--out", "."], cwd=folder, capture_output=True, text=True)
            if made.returncode:
                counts["refused"] += 1
                print(f"{name:<44} {made.stderr.strip().splitlines()[-1][-110:]}")
                continue
            counts["imported"] += 1
            scene, moving = bare((folder / robot.with_suffix(".toml").name).read_text())
            if "[[joint]]" not in scene:
                counts["of free bodies"] += 1
                continue
            if re.search("given|raised|isn't read, and", made.stderr):
                counts["with a mass or an inertia that was chosen"] += 1
                continue
            if re.search(r'^name = "connect', scene, flags=re.M) or re.search("closes", made.stderr):
                counts["with a loop"] += 1
                continue
            try:
                ends = [ours(program, folder, scene, step) for step in ("1 ms", "0.5 ms")]
                for step in (1e-4, 1e-5):
                    expected = theirs(model(), moving, step)
                    both = sorted(set(expected) & set(ends[0]))
                    off = [max((np.linalg.norm(end[body] - expected[body]) for body in both), default=np.nan) for end in ends]
                    is_right = len(both) > 0 and off[0] < 1e-3 and (off[0] / max(off[1], 1e-300) > 3.5 or off[0] < 1e-9)
                    if is_right:
                        break
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                counts["stopped"] += 1
                wrong.append(name)
                print(f"{name:<44} {error}")
                continue
            except ValueError as error:
                counts["MuJoCo refuses"] += 1
                print(f"{name:<44} MuJoCo: {str(error).splitlines()[0][:100]}")
                continue
        if not expected:
            counts["MuJoCo's explicit steps are unstable"] += 1
            continue
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
