//! Constraints on velocities in a file: Suslov's body beside its closed solution, and mistakes at their places.

use crate::called::{folder, printed, refused, rows};

/// Suslov's body; the inertia couples the axes so that its closed solution has one term.
const SUSLOV: &str = r#"title = "a body that can't turn about its third axis"
[body]
J = [[2, 0, 0], [0, 1.5, 0.4], [0, 0.4, 1]]
[nonholonomic]
zero = "a.dot(Omega)"
a = [0, 0, 2]
[start]
quaternion = [1, 0, 0, 0]
velocity = [-1.2, 0.7, 0]
[run]
duration = 3
[output]
columns = ["velocity", "energy"]
"#;

fn with_run(lines: &str) -> String {
    SUSLOV.replace("duration = 3\n", &format!("duration = 3\n{lines}"))
}

/// The error of the last row's velocity.
fn error(rows: &[Vec<f64>]) -> f64 {
    let (x, y) = (2.0_f64.sqrt() * -1.2, 1.5_f64.sqrt() * 0.7);
    let size = x.hypot(y);
    let u = (x / size).atanh() - 0.4 * size / (1.5 * 2.0_f64.sqrt()) * 3.0;
    let exact = [size * u.tanh() / 2.0_f64.sqrt(), size / u.cosh() / 1.5_f64.sqrt(), 0.0];
    let last = &rows.last().unwrap()[1..4];
    last.iter().zip(exact).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn suslovs_body_of_a_file_has_its_closed_solution() {
    let folder = folder("nonholonomic");
    let by = |lines: &str| rows(&folder, &with_run(lines));
    let errors = ["step = 0.05\n", "step = 0.025\n"].map(|lines| error(&by(lines)));
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 2.0).abs() < 0.02, "{errors:?} {order}");
    let all = by("step = 0.025\n");
    assert!(all.iter().all(|row| row[3].abs() < 1e-14));
    let composed = error(&by("step = 0.05\nmethod = { composition = \"Suzuki 4\" }\n"));
    assert!(composed < errors[1] / 50.0, "{composed:e} {errors:?}");
    let accurate = error(&by("accuracy = 1e-8\n"));
    assert!(accurate < 1e-7, "{accurate:e}");
}

#[test]
fn the_derivation_of_a_constraint_is_printed() {
    let folder = folder("nonholonomic-derivation");
    std::fs::write(folder.join("suslov.toml"), with_run("step = 0.05\n")).unwrap();
    let text = printed(&folder, &["derive", "suslov.toml"]);
    assert!(text.contains("U(F) = μ + k₀ + λ A") && text.contains("a step isn't symplectic"), "{text}");
    let c = printed(&folder, &["derive", "suslov.toml", "--c"]);
    assert!(c.contains("int rigid_body_nonholonomic_step(const rigid_body_nonholonomic_stepper *"), "{c}");
}

#[test]
fn mistakes_have_their_places() {
    let folder = folder("nonholonomic-mistakes");
    let step = with_run("step = 0.05\n");
    let said = |text: &str, place: &str, message: &str| {
        let found = refused(&folder, text);
        assert!(found.contains(place) && found.contains(message), "{found}");
    };
    said(&step.replace("a.dot(Omega)", "a.dot(Omega) + Omega.dot(Omega)"), "5:24", "linear in them");
    said(&step.replace("a.dot(Omega)", "a.dot(Omega) + 2"), "5:24", "linear in them");
    said(&step.replace("a.dot(Omega)", "a.norm()"), "5:9", "depends on no velocity");
    said(&step.replace("zero = \"a.dot(Omega)\"\n", ""), "4:", "has `zero`");
    said(&step.replace("0.7, 0]", "0.7, 0.3]"), "7:", "violates the constraint 0");
    let again = "[[nonholonomic]]\nzero = \"a.dot(Omega)\"\na = [0, 0, 2]\n";
    let several = |count: usize| {
        let one = "[nonholonomic]\nzero = \"a.dot(Omega)\"\na = [0, 0, 2]\n";
        step.replace(one, &again.repeat(count))
    };
    said(&several(2), "", "demands nothing that those before it don't");
    said(&several(3), "", "leave no motion on a group of dimension 3");
    said(&with_run("step = 0.05\nmethod = { splitting = \"Strang\" }\n"), "", "constraints on velocities leave none");
}
