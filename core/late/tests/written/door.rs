//! A text of a step, run by a program of its language.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs};

use liestep_late::{Declaration, constant, prefix};

/// The step of the motions here, s.
pub(crate) const STEP: f64 = 0.01;

/// A language in which a text is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Door {
    /// C99.
    C,
    /// The text of devices as C99.
    Kernels,
    /// JavaScript by node.
    Node,
}

/// Steps, and the lengths of a step's stages as fractions of it.
pub(crate) type Course<'a> = (u32, &'a [f64]);

pub(crate) fn folder(name: &str) -> PathBuf {
    // Several tests write the text of one declaration at a time.
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = env::temp_dir().join(format!("liestep-written-{name}-{}-{number}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Whether this program is installed; if it isn't, a reason is printed.
pub(crate) fn is_there(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok();
    if !found {
        println!("skipped: there is no `{program}`");
    }
    found
}

pub(crate) fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(", ")
}

/// The bits of numbers as a row, as the programs print them.
pub(crate) fn row(numbers: impl IntoIterator<Item = f64>) -> String {
    let mut row = String::new();
    for number in numbers {
        let _ = write!(row, "{:016x} ", number.to_bits());
    }
    row + "\n"
}

impl Door {
    /// The program that the door needs.
    pub(crate) const fn program(self) -> &'static str {
        if matches!(self, Self::Node) { "node" } else { "cc" }
    }

    /// The bits of momentum and attitude after each hundredth step, from parameters, attitude, momentum and velocity; none
    /// where a step is refused.
    pub(crate) fn rows(
        self,
        (declaration, text): (&Declaration, &str),
        folder: &Path,
        course: Course<'_>,
        given: [&[f64]; 4],
    ) -> Option<String> {
        let of = if self == Self::Node { constant(declaration) } else { prefix(declaration) };
        let main = match self {
            Self::C => c_program(&of, course, given),
            Self::Kernels => kernels_program(&of, course, given),
            Self::Node => node_program(&of, course, given),
        };
        let run = if self == Self::Node {
            fs::write(folder.join("step.js"), format!("{text}{main}")).expect("a file");
            Command::new("node").arg(folder.join("step.js")).output().expect("a program")
        } else {
            compile(folder, &format!("{text}{main}"), self == Self::C);
            Command::new(folder.join("step")).output().expect("a program")
        };
        let errors = String::from_utf8_lossy(&run.stderr);
        assert!(errors.is_empty(), "{errors}");
        run.status.success().then(|| String::from_utf8(run.stdout).expect("a text"))
    }
}

/// Compiles a text of C; kernels use a part of the functions before them.
pub(crate) fn compile(folder: &Path, text: &str, uses_all: bool) {
    fs::write(folder.join("step.c"), text).expect("a file");
    let flags = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off"];
    let unused = if uses_all { "-Wunused-function" } else { "-Wno-unused-function" };
    let mut compiler = Command::new("cc");
    compiler.args(flags).args([unused, "step.c", "-o", "step", "-lm"]);
    let compiled = compiler.current_dir(folder).output().expect("a compiler");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
}

pub(crate) const PRINT: &str = "
#include <stdio.h>
#include <string.h>
#include <stdint.h>
static void print(const double *numbers, int count) {
    for (int i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, numbers + i, 8);
        printf(\"%016llx \", (unsigned long long)bits);
    }
}
";

fn c_program(of: &str, (steps, gammas): Course<'_>, given: [&[f64]; 4]) -> String {
    let [parameters, attitude, momentum, velocity] = given.map(list);
    let (upper, count, lengths) = (of.to_uppercase(), gammas.len(), list(gammas));
    let step = if count == 1 {
        format!("{of}_step(stages, &state)")
    } else {
        format!("{of}_compose(stages, g, COUNT, &state)")
    };
    format!(
        "{PRINT}int main(void) {{
    const double p[] = {{{parameters}}}, r[] = {{{attitude}}}, m[] = {{{momentum}}}, v[] = {{{velocity}}}, g[] = {{{lengths}}};
    enum {{ COUNT = {count} }};
    {of}_stepper stages[COUNT];
    {of}_state state;
    for (int k = 0; k < COUNT; k++) if (!{of}_make(stages + k, p, {STEP:?} * g[k])) return 1;
    {of}_start(stages, &state, r, m, v);
    for (int i = 1; i <= {steps}; i++) {{
        if (!{step}) return 2;
        if (i % 100) continue;
        print(state.momentum, {upper}_N);
        print(state.attitude, {upper}_ENTRIES);
        puts(\"\");
    }}
    return {of}_defect(&state) > 1e-9;
}}
"
    )
}

/// Two members, of which the second is compared.
fn kernels_program(
    of: &str,
    (steps, gammas): Course<'_>,
    [parameters, attitude, momentum, velocity]: [&[f64]; 4],
) -> String {
    assert_eq!(gammas.len(), 1, "kernels make single steps");
    let start = [attitude, momentum, velocity].concat();
    let (upper, doubled) = (of.to_uppercase(), |numbers: &[f64]| {
        list(&numbers.iter().flat_map(|&number| [number, number]).collect::<Vec<_>>())
    });
    let (parameters, start) = (doubled(parameters), doubled(&start));
    format!(
        "{PRINT}int main(void) {{
    static const double p[] = {{{parameters}}}, s[] = {{{start}}};
    static double states[2 * {upper}_ROWS], momentum[{upper}_N], attitude[{upper}_ENTRIES];
    liestep_count steps[2];
    int status[2];
    {of}_begin(states, steps, status, p, s, {STEP:?}, 2);
    for (int i = 0; i < {steps} / 100; i++) {{
        {of}_run(states, steps, status, p, {STEP:?}, 2, 100);
        for (int k = 0; k < {upper}_ENTRIES; k++) attitude[k] = states[2 * k + 1];
        for (int k = 0; k < {upper}_N; k++) momentum[k] = states[2 * ({upper}_ENTRIES + k) + 1];
        if (status[0] || status[1] || steps[1] != 100u * (i + 1)) return 2;
        print(momentum, {upper}_N);
        print(attitude, {upper}_ENTRIES);
        puts(\"\");
    }}
    return 0;
}}
"
    )
}

fn node_program(of: &str, (steps, gammas): Course<'_>, given: [&[f64]; 4]) -> String {
    let [parameters, attitude, momentum, velocity] = given.map(list);
    let lengths = list(gammas);
    let step = if gammas.len() == 1 {
        format!("{of}.step(stages[0], state)")
    } else {
        format!("{of}.compose(stages, g, state)")
    };
    format!(
        "
const g = [{lengths}], stages = g.map(gamma => {of}.make([{parameters}], {STEP:?} * gamma)), lines = [];
const state = {of}.start(stages[0], [{attitude}], [{momentum}], [{velocity}]);
const bits = numbers => Array.from(new BigUint64Array(Float64Array.from(numbers).buffer), x => x.toString(16).padStart(16, \"0\") + \" \").join(\"\");
for (let i = 1; i <= {steps}; i++) {{
  if (!{step}) process.exit(2);
  if (i % 100 === 0) lines.push(bits(state.momentum) + bits(state.attitude) + \"\\n\");
}}
process.stdout.write(lines.join(\"\"));
process.exitCode = {of}.defect(state) > 1e-9 ? 1 : 0;
"
    )
}
