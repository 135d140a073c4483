//! A Lagrangian in a file: the same rows as by the library's effects, and mistakes at their places.

use std::fs;

use expect_test::expect;

use crate::called::{folder, printed, rows, simulate};

const RUN: &str = r#"
[start]
euler = [0, "45 deg", 0]
velocity = [0.1, 0, "60 rpm"]

[run]
step = "10 ms"
duration = 2
"#;

const TOP: &str = r#"title = "(3.13)"

[lagrangian]
advected = { w = "up" }
l_d = """
((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
    - 0.5 * h * m * g * w.dot(&(rho + F * rho))"""
J_d = { moments = [3, 3, 4] }
m = "1000 g"
g = 9.81
rho = [0, 0, "1 m"]
up = [0, 0, 1]
"#;

const BY_EFFECTS: &str = r#"title = "(3.13)"
[body]
moments = [3, 3, 4]
[gravity]
m = 1
g = 9.81
rho = [0, 0, 1]
up = [0, 0, 1]
"#;

/// By its own step and composed; of what is typed as `l`, to rounding.
#[test]
#[allow(clippy::float_cmp)] // to the bit
fn it_has_the_rows_of_the_librarys_effects() {
    let folder = folder("lagrangian");
    for method in ["", "method = { composition = \"Suzuki 4\" }\n"] {
        let run = format!("{RUN}{method}");
        let (own, library) = (rows(&folder, &(TOP.to_owned() + &run)), rows(&folder, &(BY_EFFECTS.to_owned() + &run)));
        // Energies are those of another sum.
        let motion = |rows: &[Vec<f64>]| rows.iter().map(|row| row[..4].to_vec()).collect::<Vec<_>>();
        assert_eq!((own.len(), motion(&own)), (201, motion(&library)));
    }
    let at = TOP.find("l_d = ").unwrap();
    let end = TOP.find("J_d = {").unwrap();
    let continuous = format!(
        "{}l = \"0.5 * (hat(Omega) * J_d * hat(Omega).transpose()).trace() - m * g * w.dot(&rho)\"\ndiscretise = \"trapezoid\"\n{}{RUN}",
        &TOP[..at],
        &TOP[end..]
    );
    let (own, library) = (rows(&folder, &continuous), rows(&folder, &(BY_EFFECTS.to_owned() + RUN)));
    let error = |(a, b): (&f64, &f64)| (a - b).abs();
    let worst = own.iter().flatten().zip(library.iter().flatten()).map(error).fold(0.0, f64::max);
    assert!(worst < 1e-10, "{worst:e}");
}

/// One of the fourth order, solved without its Jacobian; an ensemble that draws its parameters; what is derived.
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
    let last = rows(&folder, &format!("{fourth}{RUN}")).pop().unwrap();
    assert!((last[0] - 2.0).abs() < 1e-12 && last.iter().all(|number| number.is_finite()));
    let drawn = "[ensemble]\nmembers = 4\ndraw.lagrangian.g = { from = 9, to = 10 }\n";
    fs::write(folder.join("drawn.toml"), format!("{TOP}{RUN}{drawn}")).unwrap();
    assert!(printed(&folder, &["ensemble", "drawn.toml", "--out", "."]).contains('4'));
    assert!(printed(&folder, &["derive", "drawn.toml"]).contains("(R_F)* δl_d/δF = (1/h) (F J_d − J_d Fᵀ)^∨"));
}

#[test]
fn mistakes_have_places() {
    let folder = folder("lagrangian-mistakes");
    let messages = [
        ("w.dot(&(rho", "w.dot(&(roh"),
        ("- 0.5 * h", "- 0.5"),
        (".trace() / (2.0 * h)", " / (2.0 * h)"),
        ("((F - I)", "((F - I"),
        ("m = \"1000 g\"", "m = \"1000 stone\""),
        ("m = \"1000 g\"\n", ""),
        ("g = 9.81", "g = 9.81\nunused = 1"),
        ("g = 9.81", "g = true"),
        ("up = [0, 0, 1]", "up = [0, 1]"),
        ("moments = [3, 3, 4]", "moments = [3, 3, 40]"),
        ("moments = [3, 3, 4]", "diagonal = [3, 3, 4]"),
        ("w = \"up\"", "w = \"down\""),
        ("advected =", "group = \"SE3\"\nadvected ="),
        ("l_d = \"\"\"", "l = \"\"\""),
        ("up = [0, 0, 1]", "up = [0, 0, 1]\n[body]\nmoments = [1, 1, 1]"),
        ("up = [0, 0, 1]", "up = [0, 0, 1]\n[drag]\nc = 1"),
    ]
    .map(|(line, by)| {
        assert_eq!(TOP.matches(line).count(), 1, "{line}");
        fs::write(folder.join("top.toml"), format!("{}{RUN}", TOP.replace(line, by))).unwrap();
        let output = simulate(&folder, &["top.toml"]);
        assert!(!output.status.success() && output.stdout.is_empty(), "{by}");
        String::from_utf8(output.stderr).unwrap()
    });
    expect![[r#"
        error: top.toml:7:33: `roh` isn't known here; did you mean `rho`?
        error: top.toml:7:7: this goes like 1 as h → 0: a potential goes like `h`, as in `0.5 * h * …`
        error: top.toml:7:5: a scalar can't be subtracted from a 3 × 3 matrix: write `a * I` for a scalar `a`, or take the `.trace()` of the matrix
        error: top.toml:5:7: a bracket isn't closed or opened, or a sign has no meaning here
        error: top.toml:9:5: `stone` isn't a unit that is known here: take one of SI, or leave it out
        error: top.toml:7:17: `m` isn't known here: make it a field of the struct, or write its value
        known: F, I, h, w, J_d, g, rho, up
        error: top.toml:11:1: `unused` isn't used in the Lagrangian: remove the field, or use it
        error: top.toml:10:5: invalid type: boolean `true`, expected a number
        error: top.toml:12:6: a vector has three numbers, found 2
        error: top.toml:8:19: no body has this inertia: 40 > 3 + 3, and a principal moment is at most the sum of the others
        error: top.toml:8:9: unknown field `diagonal`, expected `moments` or `tensor`
        error: top.toml:3:2: the struct has no field `down`
        error: top.toml:4:9: a file's Lagrangian is on `SO3`; on other groups it is declared in a program
        error: top.toml:3:2: a Lagrangian has `l_d`, or `l` with `discretise`; it may have `advected`, as in `advected = { w = "up" }`, and has a key for each parameter
        error: top.toml:13:2: a `lagrangian` has its kinetic energy itself: leave `body` out
        error: top.toml:13:1: a `lagrangian` has all its terms in its text: write drag there
    "#]].assert_eq(&messages.concat());
}
