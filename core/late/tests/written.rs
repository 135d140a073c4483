//! Steps as text in other languages: compiled C makes the library's steps, and Rust is formatted as by rustfmt.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use declarations::{CayleyTop, FullTop, LogTop, SixthOrderTop};
use liestep::mechanics::Effect;
use liestep::{NonstandardInertia, SO3, Stepper};
use liestep_late::{Declaration, LateError, c, latex, rust};
use nalgebra::{Matrix3, Vector3};

const STEPS: u32 = 10_000;
const STEP: f64 = 0.01;

fn folder(name: &str) -> PathBuf {
    let folder = env::temp_dir().join(format!("liestep-written-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Whether this program is installed; if it isn't, a reason is printed.
fn is_there(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok();
    if !found {
        println!("skipped: there is no `{program}`");
    }
    found
}

fn parsed(text: &str) -> &'static Declaration {
    Declaration::parse(text).expect("a declaration")
}

fn top() -> FullTop {
    let J_d = Matrix3::new(2.0, 0.1, -0.2, 0.1, 2.5, 0.3, -0.2, 0.3, 3.0);
    let J_d = NonstandardInertia::new(J_d).expect("an inertia");
    FullTop { J_d, m: 1.5, g: 9.81, rho: Vector3::new(0.1, -0.2, 0.4), up: Vector3::z() }
}

fn list(numbers: impl IntoIterator<Item = f64>) -> String {
    let numbers: Vec<String> = numbers.into_iter().map(|number| format!("{number:?}")).collect();
    format!("{{{}}}", numbers.join(", "))
}

/// The output of the compiled program: the bits of momentum and attitude after each hundredth step.
fn by_c(text: &str, folder: &Path, [parameters, attitude, momentum, velocity]: [String; 4]) -> Option<String> {
    let main = format!(
        "{text}\n#include <stdio.h>\n#include <string.h>\n#include <stdint.h>\n\
         static void print(const double *numbers, int count) {{\n    for (int i = 0; i < count; i++) {{\n        \
         uint64_t bits;\n        memcpy(&bits, numbers + i, 8);\n        printf(\"%016llx \", (unsigned long long)bits);\n    }}\n}}\n\
         int main(void) {{\n    const double p[] = {parameters}, r[] = {attitude}, m[] = {momentum}, v[] = {velocity};\n    \
         Stepper stepper;\n    State state;\n    if (!liestep_make(&stepper, p, {STEP:?})) return 1;\n    \
         liestep_start(&stepper, &state, r, m, v);\n    for (int i = 1; i <= {STEPS}; i++) {{\n        \
         if (!liestep_step(&stepper, &state)) return 2;\n        if (i % 100) continue;\n        \
         print(state.momentum, 3);\n        print(state.attitude, 9);\n        puts(\"\");\n    }}\n    \
         return liestep_defect(&state) > 1e-9;\n}}\n"
    );
    fs::write(folder.join("step.c"), main).expect("a file");
    let flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off", "step.c", "-o", "step", "-lm"];
    let compiled = Command::new("cc").args(flags).current_dir(folder).output().expect("a compiler");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let run = Command::new(folder.join("step")).output().expect("a program");
    run.status.success().then(|| String::from_utf8(run.stdout).expect("a text"))
}

#[test]
fn a_step_in_c_has_the_bits_of_the_library() {
    if !is_there("cc") {
        return;
    }
    let folder = folder("c");
    let top = top();
    let stepper = Stepper::new(top.clone(), STEP).expect("a stepper");
    let attitude = SO3::exp(Vector3::new(0.3, -0.5, 0.2));
    let mut state = stepper.start(attitude, Vector3::new(0.7, -1.1, 4.0)).expect("a start");
    let given = [
        list(liestep_late::numbers(&top)),
        list(attitude.as_matrix().transpose().iter().copied()),
        list(state.momentum().iter().copied()),
        list(stepper.velocity(&state).iter().copied()),
    ];
    let text = c(parsed(FullTop::DECLARATION)).expect("a step in C");
    let found = by_c(&text, &folder, given.clone()).expect("all steps are made");
    let mut expected = String::new();
    for step in 1..=STEPS {
        stepper.step(&mut state).expect("a step");
        if step % 100 == 0 {
            let row_by_row = state.attitude().as_matrix().transpose();
            for number in state.momentum().iter().chain(row_by_row.iter()) {
                let _ = write!(expected, "{:016x} ", number.to_bits());
            }
            expected.push('\n');
        }
    }
    assert_eq!(found, expected);
    // A single wrong operation is detected.
    let (before, after) = text.split_once("static void newton_residual").expect("a stage");
    let wrong = format!("{before}static void newton_residual{}", after.replacen(" - ", " + ", 1));
    assert_ne!(by_c(&wrong, &folder, given), Some(expected));
    fs::remove_dir_all(folder).expect("the folder is there");
}

#[test]
fn what_has_no_step_in_c_is_told() {
    for text in [declarations::Flyer::DECLARATION, liestep::effects::Gravity::<f64>::DECLARATION] {
        assert!(matches!(c(parsed(text)), Err(LateError::C(_))), "{text}");
    }
    for text in [LogTop::DECLARATION, SixthOrderTop::DECLARATION] {
        assert!(matches!(c(parsed(text)), Ok(_) | Err(LateError::Function(_))), "{text}");
    }
}

/// Rust text is formatted, and complete.
#[test]
fn rust_is_formatted() {
    if !is_there("rustfmt") {
        return;
    }
    let folder = folder("rust");
    for (name, text) in
        [("full", FullTop::DECLARATION), ("log", LogTop::DECLARATION), ("cayley", CayleyTop::DECLARATION)]
    {
        let file = folder.join(format!("{name}.rs"));
        fs::write(&file, rust(parsed(text)).expect("Rust")).expect("a file");
        let checked =
            Command::new("rustfmt").args(["--edition", "2024", "--check"]).arg(&file).output().expect("it runs");
        assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stdout));
    }
    fs::remove_dir_all(folder).expect("the folder is there");
}

/// LaTeX lines have balanced braces, and only signs that LaTeX has.
#[test]
fn equations_are_latex() {
    let made = latex(parsed(FullTop::DECLARATION));
    assert!(made.contains(r"\mu &= \frac{1}{h} \left(F J_{d} - J_{d} F^{\top}\right)^\vee"), "{made}");
    for text in [FullTop::DECLARATION, SixthOrderTop::DECLARATION, declarations::ElasticFlow::DECLARATION] {
        let made = latex(parsed(text));
        assert!(made.lines().count() > 8, "{made}");
        for line in made.lines() {
            let count = |part: &str| line.matches(part).count();
            assert_eq!(count("{"), count("}"), "{line}");
            assert_eq!(count("\\left("), count("\\right)"), "{line}");
            let unknown = line.chars().find(|character| !character.is_ascii() && !"–’‖≤≥∈".contains(*character));
            assert_eq!(unknown, None, "{line}");
        }
    }
}
