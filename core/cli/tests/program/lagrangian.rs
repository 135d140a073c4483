//! A Lagrangian in a file: the rows agree with the library's effects, and mistakes have their places.

use std::f64::consts::{FRAC_PI_4, TAU};
use std::fs;

use liestep::prelude::*;
use liestep::with::densities;

use crate::called::{apart, folder, printed, rows};

const TOP: &str = include_str!("scenes/lagrangian.toml");
const BY_EFFECTS: &str = include_str!("scenes/by_effects.toml");

/// Rows agree to the bit by the scene's own step and by a composition, and to rounding for a continuous `l`.
#[test]
#[allow(clippy::float_cmp)] // to the bit
fn it_has_the_rows_of_the_librarys_effects() {
    let folder = folder("lagrangian");
    for method in ["", "method = { composition = \"Suzuki 4\" }\n"] {
        let [own, library] = [TOP, BY_EFFECTS].map(|text| rows(&folder, &format!("{text}{method}")));
        // Energies are compared to rounding, as they are summed in another order.
        let motion = |rows: &[Vec<f64>]| rows.iter().map(|row| row[..4].to_vec()).collect::<Vec<_>>();
        assert_eq!((own.len(), motion(&own)), (201, motion(&library)));
    }
    let at = TOP.find("l_d = ").unwrap();
    let end = TOP.find("J_d = {").unwrap();
    let continuous = format!(
        "{}l = \"0.5 * (hat(Omega) * J_d * hat(Omega).transpose()).trace() - m * g * w.dot(&rho)\"\ndiscretise = \"trapezoid\"\n{}",
        &TOP[..at],
        &TOP[end..]
    );
    let worst = apart(&rows(&folder, &continuous), &rows(&folder, BY_EFFECTS));
    assert!(worst < 1e-10, "{worst:e}");
}

/// A Lagrangian of fourth order, solved without its Jacobian; an ensemble that draws its parameters; its derivation.
#[test]
fn it_is_a_scene_as_any_other() {
    let folder = folder("lagrangian-scene");
    let fourth = r#"title = "of order four"
[lagrangian]
l_d = """{
    let xi = log(F);
    let x = 2.0 * vee(F) / (1.0 + F.trace()).sqrt();
    let f = (J * x).cross(&x) / h.powi(2);
    xi.dot(&(J * xi)) / (2.0 * h) - (h.powi(3) / 24.0) * f.dot(&(inverse(J) * f))
}"""
J = { tensor = [[2, 0.1, 0], [0.1, 3, 0], [0, 0, 4]] }
"#;
    let last = rows(&folder, &format!("{fourth}{}", &TOP[TOP.find("[start]").unwrap()..])).pop().unwrap();
    assert!((last[0] - 2.0).abs() < 1e-12 && last.iter().all(|number| number.is_finite()));
    let drawn = "[ensemble]\nmembers = 4\ndraw.lagrangian.g = { from = 9, to = 10 }\n";
    fs::write(folder.join("drawn.toml"), format!("{TOP}{drawn}")).unwrap();
    assert!(printed(&folder, &["ensemble", "drawn.toml", "--out", "."]).contains('4'));
    assert!(printed(&folder, &["derive", "drawn.toml"]).contains("(R_F)* δl_d/δF = (1/h) (F J_d − J_d Fᵀ)^∨"));
    let written = |form: &str, part: &str| {
        for (of, name) in [("drawn.toml", "lagrangian"), ("principal-body", "principal_body")] {
            let text = printed(&folder, &["derive", of, form]);
            assert!(text.contains(&part.replace("NAME", name)), "{form}: {text}");
        }
    };
    written("--latex", r"\begin{align*}");
    written("--rust", "pub fn newton_system(constants: &[f64]");
    written("--c", "int NAME_step(const NAME_stepper *stepper, NAME_state *state) {");
    written("--header", "int NAME_step(const NAME_stepper *stepper, NAME_state *state);");
    written("--gpu", "LIESTEP_KERNEL NAME_run(");
    let text = printed(&folder, &["derive", "principal-body", "--c", "--compensated"]);
    assert!(text.contains("Sums are compensated") && text.contains("double errors["), "{text}");
    written("--js", "function step(stepper, state) {");
}

/// A force in a file agrees with the library's torque, beside a body and beside a Lagrangian; an ensemble draws its
/// parameters.
#[test]
fn a_force_of_its_own() {
    let folder = folder("force");
    let force = "[force]\nwork = \"h * tau.dot(eta + eta_next) / 2\"\ntau = [0.1, 0.2, \"300 mN m\"]\n";
    let torque = rows(&folder, &format!("{BY_EFFECTS}[torque]\ntorque = [0.1, 0.2, 0.3]\n"));
    for own in [BY_EFFECTS, TOP] {
        let worst = apart(&rows(&folder, &format!("{own}{force}")), &torque);
        assert!(torque.len() == 201 && worst < 1e-11, "{worst:e}");
    }
    let drawn = "[ensemble]\nmembers = 4\ndraw.force.tau = [0, 0, { from = 0, to = 1 }]\n";
    fs::write(folder.join("drawn.toml"), format!("{BY_EFFECTS}{force}{drawn}")).unwrap();
    assert!(printed(&folder, &["ensemble", "drawn.toml", "--out", "."]).contains('4'));
    // The C code of a step with all terms is one text.
    let c = printed(&folder, &["derive", "drawn.toml", "--c"]);
    assert!(c.starts_with("/* A step of PrincipalBody + Gravity + Force on SO3."), "{c}");
    assert!(printed(&folder, &["derive", "drawn.toml"]).contains("gravity\n"));
}

/// Steps of a transformed time: rows have the physical time, and the energy is conserved.
#[test]
fn it_has_a_pace() {
    let folder = folder("lagrangian-pace");
    let paced = TOP.replace("advected =", "pace = \"1.0 / (1.0 + w.dot(&rho).powi(2))\"\nadvected =");
    let rows = rows(&folder, &paced);
    let end = &rows[rows.len() - 1];
    let lengths = rows.windows(2).map(|pair| pair[1][0] - pair[0][0]);
    let [least, most] = lengths.fold([1.0, 0.0], |[least, most], h| [f64::min(least, h), f64::max(most, h)]);
    assert!(end[0] >= 2.0 && end[0] < 2.0 + most && most > 1.01 * least && most < 0.01, "{least} {most} {}", end[0]);
    assert!((end[7] - rows[0][7]).abs() < 1e-3 * rows[0][7].abs(), "{end:?}");
}

/// Steps of varying length agree with those of the library.
#[test]
fn it_has_a_density() {
    let folder = folder("lagrangian-density");
    let varying = |text: &str| {
        let text = text.replace("step =", "density = { turn = \"6 rpm\" }\nstep =");
        text.replace("duration = 2", "duration = 4").replace("\"60 rpm\"", "0.4")
    };
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    let top = RigidBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::new(top, 0.01).unwrap().with_density(densities::turn(top, TAU / 10.0));
    for text in [TOP, BY_EFFECTS] {
        let rows = rows(&folder, &varying(text));
        let start = stepper.start(SO3::from_euler_angles(0.0, FRAC_PI_4, 0.0), Vector3::new(0.1, 0.0, 0.4));
        let mut state = start.unwrap();
        let mut lengths = [f64::MAX, 0.0];
        for (row, next) in rows.iter().zip(rows.iter().skip(1)) {
            let velocity = stepper.velocity(&state);
            let off = velocity
                .iter()
                .zip(&row[1..])
                .fold(stepper.time(&state) - row[0], |off, (a, b)| off.max((a - b).abs()));
            assert!(off.abs() < 1e-10, "{off:e} at {} s", row[0]);
            lengths = [lengths[0].min(next[0] - row[0]), lengths[1].max(next[0] - row[0])];
            stepper.step(&mut state).unwrap();
        }
        let end = rows[rows.len() - 1][0];
        assert!(end >= 4.0 && end < 4.0 + lengths[1] && lengths[1] > 2.0 * lengths[0], "{lengths:?} {end}");
    }
}
