"""Two scenes' members, whose rows of `liestep ensemble` are one file of bits that every language is compared with.

usage: compare.py LIESTEP [MEMBERS]
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow as pa

STEPS, EVERY, STEP = 10_000, 100, 0.01
ROWS = STEPS // EVERY + 1
TABLES = """
[start]
euler = [0, "30 deg", 0]
velocity = [0, 0, 12]
[run]
step = "10 ms"
duration = "100 s"
[output]
columns = ["momentum", "velocity"]
[ensemble]
members = {members}
seed = 1
every = {every}
[ensemble.draw]
{mass} = {{ from = 0.9, to = 1.1 }}
start.velocity = [{{ from = -1, to = 1 }}, {{ from = -1, to = 1 }}, {{ from = 8, to = 14 }}]
"""
SCENES = {
    "own": ("lagrangian.m", "m", """title = "own"
[lagrangian]
advected = { w = "up" }
l_d = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * m * g * w.dot(&(rho + F * rho))"
J_d = { moments = [3, 3, 4] }
m = "1 kg"
g = 9.81
rho = [0, 0, "1 m"]
up = [0, 0, 1]
"""),
    "several": ("gravity.m", "Gravity.m", """title = "several"
[body]
moments = [3, 3, 4]
[gravity]
m = "1 kg"
g = 9.81
rho = [0, 0, "1 m"]
up = [0, 0, 1]
[drag]
c = "0.05 N m s"
[spring]
k = "5 N/m"
length = "0.5 m"
at = [0, 0, "1 m"]
anchor = ["1 m", 0, "1 m"]
"""),
}
STRICT = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O2"]

# Reads the file of bits: for each member the mass, momentum and velocity at the start, and the momentum of each row.
# Prints how many numbers have other bits.
IN_C = """
#include <stdio.h>
#include <string.h>
int main(void) {{
    static double member[7 + 3 * {rows}], p[{upper}_PARAMETERS];
    {of}_state start;
    unsigned long others = 0, all = 0;
    memcpy(p, {of}_stages[0].parameters, sizeof p);
    {of}_begin(&start);
    while (fread(member, sizeof member, 1, stdin) == 1) {{
        {of}_stepper stepper;
        {of}_state state;
        p[{place}] = member[0];
        if (!{of}_make(&stepper, p, {h})) return 1;
        {of}_start(&stepper, &state, start.attitude, member + 1, member + 4);
        for (int row = 0; row < {rows}; row++, all++) {{
            others += memcmp(state.momentum, member + 7 + 3 * row, sizeof state.momentum) != 0;
            for (int n = 0; n < {every} && row + 1 < {rows}; n++) if (!{of}_step(&stepper, &state)) return 2;
        }}
    }}
    printf("%lu %lu\\n", others, all);
    return 0;
}}
"""
IN_NODE = """
const bytes = require("fs").readFileSync(0), given = new Float64Array(bytes.buffer, bytes.byteOffset, bytes.length / 8);
const p = [{parameters}], attitude = [{attitude}], size = 7 + 3 * {rows};
let others = 0, all = 0;
for (let first = 0; first < given.length; first += size) {{
  p[{place}] = given[first];
  const stepper = {name}.make(p, {h}), state = {name}.start(stepper, attitude, given.subarray(first + 1, first + 4), given.subarray(first + 4, first + 7));
  for (let row = 0; row < {rows}; row++, all++) {{
    if (![0, 1, 2].every(k => Object.is(state.momentum[k], given[first + 7 + 3 * row + k]))) others++;
    for (let n = 0; n < {every} && row + 1 < {rows}; n++) if (!{name}.step(stepper, state)) process.exit(2);
  }}
}}
console.log(others, all);
"""


class Scene:
    """A scene with its texts and its file of bits."""

    def __init__(self, liestep, folder, name, members):
        mass, parameter, text = SCENES[name]
        self.name, self.folder, self.liestep = name, folder, liestep
        (folder / f"{name}.toml").write_text(text + TABLES.format(members=members, every=EVERY, mass=mass))
        self.called("ensemble", f"{name}.toml", "--out", ".")
        files = sorted((folder / f"{name}.ensemble").glob("**/*.arrow"))
        table = pa.concat_tables([pa.ipc.open_file(file).read_all() for file in files])
        columns = {key: table[key].to_numpy(zero_copy_only=False).reshape(members, -1) for key in table.schema.names}
        if columns["momentum_x"].shape[1] != ROWS:
            raise SystemExit(f"{name}: {columns['momentum_x'].shape[1]} rows, and {ROWS} were asked for")
        self.momentum = np.stack([columns[f"momentum_{axis}"] for axis in "xyz"], axis=2)
        self.velocity = np.stack([columns[f"velocity_{axis}"][:, 0] for axis in "xyz"], axis=1)
        self.mass = columns[mass][:, 0]
        parts = [self.mass[:, None], self.momentum[:, 0], self.velocity, self.momentum.reshape(members, -1)]
        self.bits = np.ascontiguousarray(np.concatenate(parts, axis=1)).tobytes()
        self.c, self.js, self.gpu = (self.called("derive", f"{name}.toml", form) for form in ("--c", "--js", "--gpu"))
        self.of = re.search(r"(\w+)_make\(", self.c)[1]
        self.place = int(re.search(rf"parameters\[(\d+)\.\.\d+\]: {re.escape(parameter)}\n", self.c)[1])
        stages = re.search(r"_stages\[\w+\] = \{\s*\{[^{]*\{([^}]*)\}", self.c)
        self.parameters = stages[1]
        self.attitude = re.search(r"attitude\[\] = \{([^}]*)\}", self.c)[1]

    def called(self, *arguments):
        run = subprocess.run([self.liestep, *arguments], cwd=self.folder, check=True, capture_output=True, text=True)
        return run.stdout

    def said(self, command):
        """How many numbers have other bits, of how many, as a program says that reads the file of bits."""
        run = subprocess.run(command, input=self.bits, cwd=self.folder, check=True, capture_output=True)
        return tuple(map(int, run.stdout.split()))

    def in_c(self, *options):
        values = {"of": self.of, "upper": self.of.upper(), "place": self.place, "rows": ROWS, "every": EVERY, "h": STEP}
        (self.folder / "step.c").write_text(self.c + IN_C.format(**values))
        subprocess.run(["cc", *STRICT, *options, "step.c", "-o", "step", "-lm"], cwd=self.folder, check=True)
        return self.said(["./step"])

    def in_node(self):
        name = re.search(r"const (\w+) = \(\(\) =>", self.js)[1]
        values = {"name": name, "place": self.place, "rows": ROWS, "every": EVERY, "h": STEP}
        values |= {"parameters": self.parameters, "attitude": self.attitude}
        (self.folder / "step.js").write_text(self.js + IN_NODE.format(**values))
        return self.said(["node", "step.js"])

    def on_opencl(self, *options):
        import pyopencl as cl

        context = cl.Context(cl.get_platforms()[0].get_devices()[:1])
        queue = cl.CommandQueue(context)
        text = self.gpu if not options else self.gpu.replace("#pragma OPENCL FP_CONTRACT OFF\n", "")
        kernels = cl.Program(context, text).build(options=list(options))
        members = len(self.mass)
        parameters = np.repeat(np.array(self.parameters.split(","), float)[:, None], members, axis=1)
        parameters[self.place] = self.mass
        attitude = np.array(self.attitude.split(","), float)
        starts = np.concatenate([np.repeat(attitude[:, None], members, axis=1), self.momentum[:, 0].T, self.velocity.T])
        advected = int(re.search(r"_ADVECTED = (\d+)", text)[1])
        states = np.zeros((9 + 3 + advected + 9, members))
        arrays = (states, np.zeros(members, np.uint64), np.zeros(members, np.int32), parameters, np.ascontiguousarray(starts))
        flags = cl.mem_flags.READ_WRITE | cl.mem_flags.COPY_HOST_PTR
        buffers = [cl.Buffer(context, flags, hostbuf=array) for array in arrays]
        begin, go_on = cl.Kernel(kernels, f"{self.of}_begin"), cl.Kernel(kernels, f"{self.of}_run")
        size, h = np.uint64(members), np.float64(STEP)
        begin(queue, (members,), None, *buffers, h, size)
        others = 0
        for row in range(ROWS):
            if row:
                go_on(queue, (members,), None, *buffers[:4], h, size, np.uint32(EVERY))
            cl.enqueue_copy(queue, states, buffers[0]).wait()
            found = np.ascontiguousarray(states[9:12].T).view(np.int64)
            others += int((found != np.ascontiguousarray(self.momentum[:, row]).view(np.int64)).any(axis=1).sum())
        return others, members * ROWS

    def as_unit(self, fmi):
        """The first member's motion by FMPy, which also looks for problems of the description."""
        import fmpy
        from fmpy.validation import validate_fmu

        self.called("fmu", f"{self.name}.toml", "--out", ".", *(["--fmi2"] if fmi == 2 else []))
        unit = self.folder / f"{self.name}.fmu"
        problems = validate_fmu(str(unit))
        if problems:
            raise SystemExit(f"FMI {fmi}: {problems}")
        velocity = [f"velocity_at_start[{k + 1}]" for k in range(3)] if fmi == 2 else None
        mass = SCENES[self.name][0]
        names = [f"momentum[{k + 1}]" for k in range(3)] if fmi == 2 else ["momentum"]
        others = 0
        for member in range(min(5, len(self.mass))):
            # The velocity that the file draws is that of its row up to rounding, so the momentum is compared with its table.
            start = {mass: self.mass[member]}
            start |= dict(zip(velocity, self.velocity[member])) if fmi == 2 else {"velocity_at_start": self.velocity[member]}
            rows = fmpy.simulate_fmu(
                str(unit), start_values=start, output=names, stop_time=STEPS * STEP, step_size=STEP,
                output_interval=STEP * EVERY, validate=False,
            )
            found = np.array([list(np.ravel(list(row)[1:])) for row in rows.tolist()]) if fmi == 2 else np.array([row[1] for row in rows.tolist()])
            apart = np.abs(found - self.momentum[member][: len(found)]).max()
            others += int(apart > 1e-9)
        return others, min(5, len(self.mass))


def main(liestep, members=100):
    liestep, members, wrong, doors = Path(liestep).resolve(), int(members), [], 0
    with tempfile.TemporaryDirectory() as folder:
        for name in SCENES:
            scene = Scene(liestep, Path(folder), name, members)

            def compare(door, run, is_same=True, name=name):
                others, count = run()
                print(f"{name}: {door}: {count - others} of {count} rows have the bits")
                if (others == 0) != is_same:
                    wrong.append(f"{name}: {door}")

            if shutil.which("cc"):
                compare("C99", lambda: scene.in_c("-ffp-contract=off"))
                if "fma" in Path("/proc/cpuinfo").read_text():
                    compare("C99 that fuses, which has to differ", lambda: scene.in_c("-ffp-contract=fast", "-mfma"), False)
                doors += 1
            else:
                print("skipped: there is no `cc`")
            if shutil.which("node"):
                compare("JavaScript", scene.in_node)
                doors += 1
            else:
                print("skipped: there is no `node`")
            try:
                import pyopencl

                pyopencl.get_platforms()
            except Exception as cause:  # no loader, no platform
                print(f"skipped: OpenCL: {cause}")
            else:
                compare("OpenCL", scene.on_opencl)
                fast = "-cl-fast-relaxed-math"
                compare("OpenCL that is fast, which has to differ", lambda: scene.on_opencl(fast), False)
                doors += 1
            for fmi in (3, 2):
                others, count = scene.as_unit(fmi)
                print(f"{name}: FMI {fmi} by FMPy: no problem; {count - others} of {count} motions agree")
                if others:
                    wrong.append(f"{name}: FMI {fmi}")
    print(f"{doors} comparisons passed, {len(wrong)} failed")
    if wrong:
        raise SystemExit("\n".join(wrong))


if __name__ == "__main__":
    os.environ.setdefault("OCL_ICD_VENDORS", "/etc/OpenCL/vendors")
    main(*sys.argv[1:])
