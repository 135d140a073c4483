//! Steps in C with rounded and with compensated sums: the bits of the compiled stepper and of the text's.

use std::fs;
use std::process::Command;

use declarations::{DoublePendulum, Flyer, FullTop};
use liestep::groups::{LieGroup as _, SE3};
use liestep::mechanics::{Effect, Regular};
use liestep::methods::CompositionScheme;
use liestep::motion::{AnyStepper, Integrator as _, Plan};
use liestep::with::{Compensable, Method};
use liestep::{SO3, Stepper};
use liestep_late::{Declaration, Interpreter, LateError, Sums, c, gpu, header, stepper};
use nalgebra::{Matrix4, UnitQuaternion, Vector3};

use crate::door::{Door, PRINT, STEP, compile, folder, is_there, list, row};
use crate::{entries, has_the_bits_of, parsed, top};

const STEPS: u32 = 10_000;
const BOTH: [Sums; 2] = [Sums::Rounded, Sums::Compensated];

/// The step or a composition of it by its name, with such sums.
fn method(name: &str, sums: Sums) -> Method {
    let compensated = if sums == Sums::Compensated { ", compensated" } else { "" };
    format!("{name}{compensated}").parse().expect("a method")
}

/// A compiled stepper with such sums.
fn any<E, P>(stepper: Stepper<E, P>, sums: Sums) -> AnyStepper
where
    E: Regular<Scalar = f64> + 'static,
    P: Plan<E, Kept: 'static> + Compensable + 'static,
{
    if sums == Sums::Compensated { stepper.compensated().into_any() } else { stepper.into_any() }
}

/// Asserts the bits of both steppers, for the step, a composition and kernels.
fn assert_bits<E>(effect: &E, attitude: E::Group, velocity: &[f64], sums: Sums)
where
    E: Regular<Scalar = f64> + Clone + 'static,
{
    let declaration = parsed(E::DECLARATION);
    let numbers = declaration.described(&liestep_late::numbers(effect)).expect("numbers");
    let text = c(declaration, sums).expect("a step in C");
    assert_eq!(text.contains("Sums are compensated"), sums == Sums::Compensated, "{text}");
    let suzuki = CompositionScheme::SUZUKI_4;
    let one = any(Stepper::new(effect.clone(), STEP).expect("a stepper"), sums);
    let composed = any(Stepper::composed(effect.clone(), STEP, suzuki).expect("a stepper"), sums);
    let attitude = entries(&attitude.matrix());
    let bits = |stepper: &AnyStepper, gammas: &[f64], written: (Door, &str)| {
        has_the_bits_of(effect, stepper, (&attitude, velocity), (STEPS, gammas), written)
    };
    let gammas: Vec<f64> = suzuki.stages().collect();
    for (compiled, name, gammas) in [(&one, "step", &[1.0][..]), (&composed, "composition Suzuki 4", &gammas)] {
        assert!(bits(compiled, gammas, (Door::C, &text)), "{name}, {sums:?}");
        let by = stepper::<Interpreter>(declaration, &numbers, STEP, method(name, sums)).expect("a stepper");
        assert!(bits(&by, gammas, (Door::C, &text)), "{name}, {sums:?}, from a text");
    }
    let kernels = gpu(declaration, sums).expect("a step of devices");
    assert!(bits(&one, &[1.0], (Door::Kernels, &kernels)), "{sums:?}");
}

#[test]
fn a_top() {
    if !is_there("cc") {
        return;
    }
    for (sums, up) in BOTH.map(|sums| [Vector3::z(), Vector3::new(0.48, -0.6, 0.64)].map(|up| (sums, up))).concat() {
        assert_bits(&FullTop { up, ..top() }, SO3::exp(Vector3::new(0.3, -0.5, 0.2)), &[0.7, -1.1, 4.0], sums);
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
    for sums in BOTH {
        assert_bits(&Flyer { J }, attitude, &[0.5, -0.8, 1.2, 0.3, 0.2, -0.4], sums);
    }
}

/// A product of groups is restored often.
#[test]
fn two_bodies() {
    if is_there("cc") {
        let attitude = (SO3::exp(Vector3::new(0.3, -0.5, 0.2)), SO3::exp(Vector3::new(-0.2, 0.3, 0.1)));
        let velocity = [0.5, -0.8, 1.2, -0.3, 0.9, 0.4];
        for sums in BOTH {
            assert_bits(&DoublePendulum::asymmetric(), attitude, &velocity, sums);
        }
    }
}

/// A single wrong operation is detected, in the step and in a composition, and so are errors that aren't carried.
#[test]
fn a_wrong_operation_is_detected() {
    if !is_there("cc") {
        return;
    }
    let attitude = entries(&SO3::exp(Vector3::new(0.3, -0.5, 0.2)).matrix());
    let bits = |stepper: AnyStepper, gammas: &[f64], text: &str| {
        has_the_bits_of(&top(), &stepper, (&attitude, &[0.7, -1.1, 4.0]), (2_000, gammas), (Door::C, text))
    };
    let composed = |scheme: CompositionScheme, sums, text: &str| {
        let stepper = Stepper::composed(top(), STEP, scheme).expect("a stepper");
        bits(any(stepper, sums), &scheme.stages().collect::<Vec<_>>(), text)
    };
    let single = |sums, text: &str| bits(any(Stepper::new(top(), STEP).expect("a stepper"), sums), &[1.0], text);
    for sums in BOTH {
        let text = c(parsed(FullTop::DECLARATION), sums).expect("a step in C");
        let (before, after) = text.split_once("void full_top_again").expect("a program");
        assert!(!single(sums, &format!("{before}void full_top_again{}", after.replacen(" - ", " + ", 1))), "{sums:?}");
        assert!(composed(CompositionScheme::KAHAN_LI_8, sums, &text), "{sums:?}");
        let wrong = text.replace("earlier[i] * factor", "earlier[i] * -factor");
        assert!(wrong != text && !composed(CompositionScheme::SUZUKI_4, sums, &wrong), "{sums:?}");
        let wrong = text.replace("errors[i] = (a - (sum - of_b)) + (b - of_b);", "errors[i] = 0.0 * of_b;");
        assert_eq!((wrong != text, single(sums, &wrong)), (sums == Sums::Compensated, sums == Sums::Rounded));
    }
}

/// Other parameters between two steps are those of a stepper with them, which goes on with the state: compensated sums have no
/// errors of values in space that are others.
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
    let attitude = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    for sums in BOTH {
        let of = |numbers: &[f64]| {
            stepper::<Interpreter>(declaration, numbers, STEP, method("step", sums)).expect("a stepper")
        };
        let mut state = of(&numbers).start(&attitude, &[0.7, -1.1, 4.0]).expect("a start");
        let momentum = state.momentum().to_vec();
        let mut expected = String::new();
        for (given, is_turned) in [(&numbers, false), (&heavier, false), (&turned, true)] {
            let by = of(given);
            if is_turned {
                // The advected direction has another value in space, and no error there.
                let (advected, mut now) = (by.layout().advected(), state.numbers().to_vec());
                let errors = now.len() - 4..now.len() - 1;
                now[advected.clone()].copy_from_slice(&by.adopt(&state).numbers()[advected]);
                if sums == Sums::Compensated {
                    now[errors].fill(0.0);
                }
                state = by.state_of(&now).expect("a state");
            }
            by.run(&mut state, 100).expect("steps");
            expected += &row(state.momentum().iter().copied());
        }
        let text = c(declaration, sums).expect("a step");
        let errors = "enum { PLACE = FULL_TOP_ENTRIES + FULL_TOP_N };
            if (before.errors[PLACE] == 0.0) return 4;
            for (int k = 0; k < FULL_TOP_CHANGES; k++) {
                if (state.errors[k] != (k < PLACE ? before.errors[k] : 0.0)) return 5;
            }";
        let main = format!(
            "{PRINT}int main(void) {{
    const double p[] = {{{}}}, heavier[] = {{{}}}, turned[] = {{{}}}, r[] = {{{}}}, m[] = {{{}}};
    full_top_stepper stepper;
    full_top_state state, before;
    double v[3];
    if (!full_top_make(&stepper, p, {STEP:?})) return 1;
    full_top_velocity(&stepper, r, m, v);
    full_top_start(&stepper, &state, r, m, v);
    for (int i = 0; i < 300; i++) {{
        before = state;
        if (i == 100 && (!full_top_give(&stepper, &state, heavier) || memcmp(&before, &state, sizeof state))) return 2;
        if (i == 200) {{
            if (!full_top_give(&stepper, &state, turned)) return 3;
            {}
        }}
        if (!full_top_step(&stepper, &state)) return 6;
        if (i % 100 == 99) print(state.momentum, FULL_TOP_N), puts(\"\");
    }}
    return 0;
}}
",
            list(&numbers),
            list(&heavier),
            list(&turned),
            list(&attitude),
            list(&momentum),
            if sums == Sums::Compensated { errors } else { "" }
        );
        let folder = folder("give");
        compile(&folder, &format!("{text}{main}"), true);
        let run = Command::new(folder.join("step")).output().expect("a program");
        let found = String::from_utf8_lossy(&run.stdout).into_owned();
        assert_eq!((run.status.code(), found), (Some(0), expected), "{sums:?}");
        fs::remove_dir_all(folder).expect("the folder is there");
    }
}

/// A header is that of its text, and what has no compensated sums is told.
#[test]
fn what_has_none_is_told() {
    for sums in BOTH {
        let [text, header] = [c, header].map(|of| of(parsed(FullTop::DECLARATION), sums).expect("a text"));
        assert_eq!(header.contains("double errors["), sums == Sums::Compensated);
        assert!(text.starts_with(header.trim_end()), "{header}");
    }
    let disk = "#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2 * h))]
        struct Disk { J_d: NonstandardInertia }";
    let rolling = "#[nonholonomic(group = SO3, velocity = Omega, zero = a.dot(Omega))] struct Edge { a: Vector3<f64> }";
    let held = Declaration::sum(&[parsed(disk), parsed(rolling)]).expect("a sum");
    let refused = c(held, Sums::Compensated).expect_err("a refusal");
    assert_eq!(refused, LateError::Compensated { beside: "constraints on velocities" });
    assert!(refused.to_string().starts_with("sums aren't compensated beside constraints on velocities: "));
    assert!(c(held, Sums::Rounded).is_ok());
}
