//! Steps beside the one in C: in JavaScript, for devices, and for firmware, with the same bits.

use std::fs;
use std::path::Path;
use std::process::Command;

use declarations::{DoublePendulum, Flyer, FullTop, LogTop};
use liestep::groups::{LieGroup as _, SE3};
use liestep::mechanics::Effect;
use liestep::methods::CompositionScheme;
use liestep::{SO3, Stepper};
use liestep_late::{Sums, c, constant, gpu, header, is_exact, javascript, prefix};
use nalgebra::{Matrix4, SMatrix, UnitQuaternion, Vector3};

use crate::door::{Door, STEP, compile, folder, is_there};
use crate::{ExtendedPose, entries, has_the_bits_of, has_the_bits_of_a_step, parsed, top};

fn start() -> (SO3, &'static [f64]) {
    (SO3::exp(Vector3::new(0.3, -0.5, 0.2)), &[0.7, -1.1, 4.0])
}

#[test]
fn javascript_has_the_bits_of_the_library() {
    if !is_there(Door::Node.program()) {
        return;
    }
    let text = javascript(parsed(FullTop::DECLARATION)).expect("a step");
    assert!(text.starts_with("// A step of FullTop on SO3, to the bit that of the library.\n"), "{text}");
    let bits = |text: &str| has_the_bits_of_a_step(&top(), start().0, start().1, 10_000, (Door::Node, text));
    assert!(bits(&text));
    // A single wrong operation is detected, and so is an end of Newton's iteration that comes too soon.
    let (before, after) = text.split_once("function again").expect("a program");
    assert!(!bits(&format!("{before}function again{}", after.replacen("-x", "+x", 1))));
    assert!(!bits(&text.replace("(EPSILON * 0.015625)", "1e-3")));
    for scheme in [CompositionScheme::SUZUKI_4, CompositionScheme::KAHAN_LI_8] {
        let stepper = Stepper::composed(top(), STEP, scheme).expect("a stepper").into_any();
        let gammas: Vec<f64> = scheme.stages().collect();
        assert!(has_the_bits_of(
            &top(),
            &stepper,
            (&entries(&start().0.matrix()), start().1),
            (2_000, &gammas),
            (Door::Node, &text)
        ));
    }
}

#[test]
fn so_has_one_of_other_groups() {
    if !is_there(Door::Node.program()) {
        return;
    }
    let turned = SO3::exp(Vector3::new(-0.2, 0.3, 0.1));
    let text = javascript(parsed(DoublePendulum::<f64>::DECLARATION)).expect("a step");
    let velocity = [0.5, -0.8, 1.2, -0.3, 0.9, 0.4];
    let both = DoublePendulum::asymmetric();
    assert!(has_the_bits_of_a_step(&both, (start().0, turned), &velocity, 2_000, (Door::Node, &text)));
    let J = Matrix4::new(0.3, 0.02, 0.0, 0.05, 0.02, 0.2, 0.01, 0.0, 0.0, 0.01, 0.25, -0.1, 0.05, 0.0, -0.1, 1.5);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.2, 0.1));
    let attitude = SE3::from_rotation_and_translation(turn, Vector3::new(0.1, 0.2, 0.5));
    let text = javascript(parsed(Flyer::DECLARATION)).expect("a step");
    assert!(has_the_bits_of_a_step(
        &Flyer { J },
        attitude,
        &[0.5, -0.8, 1.2, 0.3, 0.2, -0.4],
        2_000,
        (Door::Node, &text)
    ));
    let J = SMatrix::from_fn(|i, j| if i == j { [1.0, 1.1, 1.2, 1.3, 1.4][i] } else { 0.05 });
    let text = javascript(parsed(ExtendedPose::DECLARATION)).expect("a step");
    let velocity = [0.25, -0.4, 0.6, 0.15, 0.1, -0.2, 0.05, 0.3, -0.1];
    let attitude = liestep::groups::LieGroup::identity();
    assert!(has_the_bits_of_a_step(&ExtendedPose { J }, attitude, &velocity, 1_000, (Door::Node, &text)));
}

/// Texts with functions of the engine say so, and their motions agree to rounding.
#[test]
fn functions_of_the_engine_are_said() {
    let text = javascript(parsed(LogTop::DECLARATION)).expect("a step");
    assert!(text.contains("not to the bit") && !is_exact(parsed(LogTop::DECLARATION)).expect("a step"));
    assert!(is_exact(parsed(FullTop::DECLARATION)).expect("a step"));
    assert_eq!(constant(parsed(LogTop::DECLARATION)), "logTopStep");
}

/// No name of a device's text is a type or a function of `OpenCL` C.
#[test]
fn kernels_name_nothing_of_opencl() {
    let text = gpu(parsed(FullTop::DECLARATION), Sums::Rounded).expect("a step");
    let reserved = ["half", "dot", "cross", "step", "global", "local", "private", "kernel", "long long", "image1d_t"];
    let head = text.rfind("#endif\n#endif\n").expect("a head");
    // Outside comments.
    let parts = text[head..].split("/*").enumerate();
    let code: String = parts
        .map(|(at, part)| if at == 0 { part } else { part.split_once("*/").map_or("", |(_, code)| code) })
        .collect();
    let words: Vec<&str> = code.split(|letter: char| !(letter.is_alphanumeric() || letter == '_')).collect();
    for word in reserved {
        assert!(!words.contains(&word), "{word}");
    }
}

/// Compiles units together and runs them; the exit code.
fn together(folder: &Path, units: &[(&str, &str)], options: &[&str]) -> Option<i32> {
    for (name, text) in units {
        fs::write(folder.join(name), text).expect("a file");
    }
    let sources = units
        .iter()
        .map(|(name, _)| *name)
        .filter(|name| Path::new(name).extension().is_some_and(|found| found == "c"));
    let flags = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off"];
    let mut compiler = Command::new("cc");
    compiler.args(flags).args(options).args(sources).args(["-o", "together", "-lm"]).current_dir(folder);
    let compiled = compiler.output().expect("a compiler");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    Command::new(folder.join("together")).status().expect("a program").code()
}

/// The texts of two declarations stand in one unit, and another unit calls a step by its header.
#[test]
fn texts_have_names_of_their_own() {
    if !is_there("cc") {
        return;
    }
    let folder = folder("together");
    let [top, flyer] =
        [FullTop::DECLARATION, Flyer::DECLARATION].map(|text| c(parsed(text), Sums::Rounded).expect("a step"));
    let header = header(parsed(FullTop::DECLARATION), Sums::Rounded).expect("a head");
    let both = format!("{top}{flyer}");
    let main = "#include \"full_top.h\"\n#include \"full_top.h\"\nint main(void) {\n    full_top_stepper stepper;\n    const double p[FULL_TOP_PARAMETERS] = {0};\n    return full_top_make(&stepper, p, 0.01);\n}\n";
    let units = [("both.c", &*both), ("full_top.h", &header), ("main.c", main)];
    assert_eq!(together(&folder, &units, &[]), Some(0));
    assert_eq!(prefix(parsed(Flyer::DECLARATION)), "flyer");
    // Device texts share the head of their language.
    let kernels =
        [FullTop::DECLARATION, Flyer::DECLARATION].map(|text| gpu(parsed(text), Sums::Rounded).expect("a step"));
    compile(&folder, &format!("{}int main(void) {{ return 0; }}\n", kernels.concat()), false);
    fs::remove_dir_all(folder).expect("the folder is there");
}

/// A bound of the iterations refuses a step, and leaves each byte as it was.
#[test]
fn iterations_have_a_bound() {
    if !is_there("cc") {
        return;
    }
    let folder = folder("bound");
    let text = c(parsed(FullTop::DECLARATION), Sums::Rounded).expect("a step");
    let main = "#include <string.h>
int main(void) {
    const double p[] = {2, 0, 0, 0, 2, 0, 0, 0, 1, 1, 9.81, 0.3, 0, 1, 0, 0, 1}, r[] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, m[] = {30, 0, 48}, v[] = {10, 0, 12};
    full_top_stepper stepper;
    full_top_state state, before;
    int made = 0;
    if (!full_top_make(&stepper, p, 0.01)) return 100;
    full_top_start(&stepper, &state, r, m, v);
    memcpy(&before, &state, sizeof state);
    while (made < 50 && full_top_step(&stepper, &state)) made++;
    return made > 0 || !memcmp(&before, &state, sizeof state) ? made : 101;
}
";
    let steps = |bound: &str| together(&folder, &[("bound.c", &format!("{text}{main}"))], &[bound]);
    assert_eq!(steps("-DFULL_TOP_ITERATIONS=1"), Some(0));
    assert_eq!(steps("-DFULL_TOP_ITERATIONS=4"), Some(50));
    fs::remove_dir_all(folder).expect("the folder is there");
}
