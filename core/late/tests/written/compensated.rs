//! Steps in C with compensated sums: the bits of the compiled stepper and of the text's.

use std::fs;
use std::process::Command;

use declarations::{DoublePendulum, Flyer, FullTop};
use liestep::groups::SE3;
use liestep::mechanics::{Effect, Regular};
use liestep::methods::CompositionScheme;
use liestep::{SO3, Stepper};
use liestep_late::{Declaration, Interpreter, LateError, c, compensated, stepper};
use nalgebra::{Matrix4, UnitQuaternion, Vector3};

use crate::door::{Door, STEP, compile, folder, is_there, row};
use crate::{entries, has_the_bits_of_a_method, parsed, top};

const STEPS: u32 = 10_000;

/// Whether a text in C has the bits of the text's stepper by this method, whose stages have these lengths.
fn has_the_bits_of_the_text<E>(
    effect: &E,
    start: (&[f64], &[f64]),
    (method, gammas): (&str, &[f64]),
    text: &str,
) -> bool
where
    E: Regular<Scalar = f64>,
{
    let declaration = parsed(E::DECLARATION);
    let numbers = declaration.described(&liestep_late::numbers(effect)).expect("numbers");
    let by = stepper::<Interpreter>(declaration, &numbers, STEP, method.parse().expect("a method")).expect("a stepper");
    let mut state = by.start(start.0, start.1).expect("a start");
    let (momentum, velocity) = (state.momentum().to_vec(), by.velocity(&state));
    let folder = folder(&format!("text-{}-{}", declaration.name, gammas.len()));
    let given = [&numbers[..], start.0, &momentum, &velocity];
    let found = Door::C.rows((declaration, text), &folder, (STEPS, gammas), given);
    fs::remove_dir_all(&folder).expect("the folder is there");
    let mut expected = String::new();
    for _ in 0..STEPS / 100 {
        by.run(&mut state, 100).expect("steps");
        expected += &row(state.momentum().iter().chain(state.attitude()).copied());
    }
    found == Some(expected)
}

/// Asserts the bits of both steppers, for the step and for a composition, and that they are lost without the errors.
fn assert_bits<E>(effect: &E, attitude: E::Group, velocity: &[f64])
where
    E: Regular<Scalar = f64> + Clone,
    E::Group: Copy,
{
    let text = compensated::c(parsed(E::DECLARATION)).expect("a step in C");
    assert!(text.contains("Sums are compensated"), "{text}");
    let suzuki = CompositionScheme::SUZUKI_4;
    let gammas: Vec<f64> = suzuki.stages().collect();
    let start = (attitude, velocity);
    let compiled = |text: &str| {
        let stepper = Stepper::new(effect.clone(), STEP).expect("a stepper").compensated();
        has_the_bits_of_a_method(effect, &stepper, start, (STEPS, &[1.0]), (Door::C, text))
    };
    assert!(compiled(&text));
    let composed = Stepper::composed(effect.clone(), STEP, suzuki).expect("a stepper").compensated();
    assert!(has_the_bits_of_a_method(effect, &composed, start, (STEPS, &gammas), (Door::C, &text)));
    let start = entries(&liestep::groups::LieGroup::matrix(&attitude));
    for (method, gammas) in [("step, compensated", &[1.0][..]), ("composition Suzuki 4, compensated", &gammas)] {
        assert!(has_the_bits_of_the_text(effect, (&start, velocity), (method, gammas), &text), "{method}");
    }
    let kernels = compensated::gpu(parsed(E::DECLARATION)).expect("a step of devices");
    let stepper = Stepper::new(effect.clone(), STEP).expect("a stepper").compensated();
    assert!(has_the_bits_of_a_method(
        effect,
        &stepper,
        (attitude, velocity),
        (STEPS, &[1.0]),
        (Door::Kernels, &kernels)
    ));
    // Errors that aren't carried are detected.
    let wrong = text.replace("errors[i] = (a - (sum - of_b)) + (b - of_b);", "errors[i] = 0.0 * of_b;");
    assert!(wrong != text && !compiled(&wrong));
}

#[test]
fn a_top() {
    if is_there("cc") {
        for up in [Vector3::z(), Vector3::new(0.48, -0.6, 0.64)] {
            assert_bits(&FullTop { up, ..top() }, SO3::exp(Vector3::new(0.3, -0.5, 0.2)), &[0.7, -1.1, 4.0]);
        }
    }
}

#[test]
fn a_body_with_a_place() {
    if !is_there("cc") {
        return;
    }
    let J = Matrix4::new(0.3, 0.02, 0.0, 0.05, 0.02, 0.2, 0.01, 0.0, 0.0, 0.01, 0.25, -0.1, 0.05, 0.0, -0.1, 1.5);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.2, 0.1));
    let attitude = SE3::from_rotation_and_translation(turn, Vector3::new(0.1, 0.2, 0.5));
    assert_bits(&Flyer { J }, attitude, &[0.5, -0.8, 1.2, 0.3, 0.2, -0.4]);
}

/// A product of groups is restored often.
#[test]
fn two_bodies() {
    if is_there("cc") {
        let attitude = (SO3::exp(Vector3::new(0.3, -0.5, 0.2)), SO3::exp(Vector3::new(-0.2, 0.3, 0.1)));
        assert_bits(&DoublePendulum::asymmetric(), attitude, &[0.5, -0.8, 1.2, -0.3, 0.9, 0.4]);
    }
}

/// Other parameters between two steps leave the errors as they are, but those of values in space that are others.
#[test]
fn parameters_change_between_steps() {
    if !is_there("cc") {
        return;
    }
    let declaration = parsed(FullTop::DECLARATION);
    let numbers = declaration.described(&liestep_late::numbers(&top())).expect("numbers");
    let mut heavier = numbers.clone();
    declaration.set(&mut heavier, "m", &[2.5]).expect("a mass");
    let mut turned = heavier.clone();
    declaration.set(&mut turned, "up", &[0.6, 0.0, 0.8]).expect("a direction");
    let of = |numbers: &[f64]| {
        let method = "step, compensated".parse().expect("a method");
        stepper::<Interpreter>(declaration, numbers, STEP, method).expect("a stepper")
    };
    let attitude = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let mut state = of(&numbers).start(&attitude, &[0.7, -1.1, 4.0]).expect("a start");
    let list = |numbers: &[f64]| numbers.iter().map(|one| format!("{one:?}")).collect::<Vec<_>>().join(", ");
    let momentum = list(state.momentum());
    of(&numbers).run(&mut state, 100).expect("steps");
    of(&heavier).run(&mut state, 100).expect("steps");
    let text = compensated::c(declaration).expect("a step");
    let main = format!(
        "#include <stdio.h>\n#include <stdint.h>\n#include <string.h>
int main(void) {{
    const double p[] = {{{}}}, heavier[] = {{{}}}, turned[] = {{{}}}, r[] = {{{}}}, m[] = {{{momentum}}};
    enum {{ PLACE = FULL_TOP_ENTRIES + FULL_TOP_N }};
    full_top_stepper stepper;
    full_top_state state, before;
    double v[3];
    if (!full_top_make(&stepper, p, {STEP:?})) return 1;
    full_top_velocity(&stepper, r, m, v);
    full_top_start(&stepper, &state, r, m, v);
    for (int i = 0; i < 200; i++) {{
        if (i == 100) {{
            before = state;
            if (!full_top_give(&stepper, &state, heavier) || memcmp(&before, &state, sizeof state)) return 2;
        }}
        if (!full_top_step(&stepper, &state)) return 3;
    }}
    for (int i = 0; i < 3; i++) {{
        uint64_t bits;
        memcpy(&bits, state.momentum + i, 8);
        printf(\"%016llx \", (unsigned long long)bits);
    }}
    puts(\"\");
    before = state;
    if (!full_top_give(&stepper, &state, turned)) return 4;
    for (int i = 0; i < FULL_TOP_CHANGES; i++) {{
        if (state.errors[i] != (i < PLACE ? before.errors[i] : 0.0)) return 5;
    }}
    return before.errors[PLACE] == 0.0;
}}
",
        list(&numbers),
        list(&heavier),
        list(&turned),
        list(&attitude)
    );
    let folder = folder("give-compensated");
    compile(&folder, &format!("{text}{main}"), true);
    let run = Command::new(folder.join("step")).output().expect("a program");
    let expected = row(state.momentum().iter().copied());
    assert_eq!((run.status.code(), String::from_utf8_lossy(&run.stdout).into_owned()), (Some(0), expected));
    fs::remove_dir_all(folder).expect("the folder is there");
}

/// A header is that of its text, and what has no compensated sums is told.
#[test]
fn what_has_none_is_told() {
    let [text, header] =
        [compensated::c, compensated::header].map(|of| of(parsed(FullTop::DECLARATION)).expect("a text"));
    assert!(header.contains("double errors[") && text.starts_with(header.trim_end()), "{header}");
    let disk = "#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2 * h))]
        struct Disk { J_d: NonstandardInertia }";
    let rolling = "#[nonholonomic(group = SO3, velocity = Omega, zero = a.dot(Omega))] struct Edge { a: Vector3<f64> }";
    let held = Declaration::sum(&[parsed(disk), parsed(rolling)]).expect("a sum");
    let refused = compensated::c(held).expect_err("a refusal");
    assert_eq!(refused, LateError::Compensated { beside: "constraints on velocities" });
    assert!(refused.to_string().starts_with("sums aren't compensated beside constraints on velocities: "));
    assert!(c(held).is_ok());
}
