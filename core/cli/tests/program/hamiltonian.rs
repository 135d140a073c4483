//! Hamiltonians in a file: a sub-Riemannian geodesic beside its closed form, spins, and mistakes at their places.

use crate::called::{folder, printed, refused, rows};

/// A geodesic on the Heisenberg group that moves along two of three directions.
const GEODESIC: &str = r#"title = "along two of three directions"
[hamiltonian]
group = "Heisenberg"
h = "c * (mu[0].powi(2) + mu[1].powi(2))"
c = 0.5
[start]
momentum = [0.8, -0.3, 1.5]
[run]
step = 0.05
duration = 2
[output]
columns = ["attitude", "momentum", "energy"]
"#;

/// Two spins with an exchange that has another strength along the third axis.
const SPINS: &str = r#"title = "two spins"
[hamiltonian]
group = { F_1 = "SO3", F_2 = "SO3" }
momentum = ["s", "r"]
h = "-s.dot(A * r)"
A = [[1, 0, 0], [0, 1, 0], [0, 0, 1.4]]
[start]
F_1 = { euler = [0, 0, 0], momentum = [0.6, 0, 0.8] }
F_2 = { euler = [0, 0, 0], momentum = [-0.28, 0.96, 0] }
[run]
step = 0.05
duration = 50
[output]
columns = ["momentum", "energy"]
"#;

/// The distance of the last row from the closed form: `μ_3 = k` is constant, `(μ_1, μ_2)` turns with the rate `k`, and
/// `ẋ = μ_1`, `ẏ = μ_2`.
fn error(rows: &[Vec<f64>]) -> f64 {
    let (sin, cos) = 3.0_f64.sin_cos();
    let turned = [0.8 * cos + 0.3 * sin, 0.8 * sin - 0.3 * cos];
    let place = [(0.8 * sin - 0.3 * (cos - 1.0)) / 1.5, (0.8 * (1.0 - cos) - 0.3 * sin) / 1.5];
    let last = rows.last().unwrap();
    // A row has the time, and a matrix of three rows.
    let found = [last[10], last[11], last[2], last[6]];
    let exact = [turned[0], turned[1], place[0], place[1]];
    found.iter().zip(exact).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn a_geodesic_of_a_file_has_its_closed_form() {
    let folder = folder("hamiltonian");
    let by = |step: &str| rows(&folder, &GEODESIC.replace("step = 0.05", step));
    let [coarse, fine] = ["step = 0.05", "step = 0.025"].map(by);
    let order = (error(&coarse) / error(&fine)).log2();
    assert!((order - 2.0).abs() < 0.05, "{order}");
    assert!(fine.iter().all(|row| (row[13] - 0.365).abs() < 1e-13));
    let composed = error(&by("step = 0.05\nmethod = { composition = \"Suzuki 4\" }"));
    assert!(composed < error(&fine) / 50.0, "{composed:e}");
}

#[test]
fn spins_of_a_file_keep_their_lengths() {
    let all = rows(&folder("hamiltonian-spins"), SPINS);
    let of = |row: &[f64]| {
        let length = |at: usize| row[at..at + 3].iter().map(|x| x * x).sum::<f64>();
        [length(1), length(4), row[3] + row[6]]
    };
    assert_eq!(all.len(), 1001);
    for row in &all {
        let (now, before) = (of(row), of(&all[0]));
        assert!(now.iter().zip(before).all(|(now, before)| (now - before).abs() < 1e-12), "{now:?} {before:?}");
        assert!((row[7] - all[0][7]).abs() < 1e-2);
    }
}

#[test]
fn a_hamiltonian_is_printed_and_swept() {
    let folder = folder("hamiltonian-derivation");
    std::fs::write(folder.join("geodesic.toml"), GEODESIC).unwrap();
    let text = printed(&folder, &["derive", "geodesic.toml"]);
    assert!(text.contains("mu"), "{text}");
    std::fs::write(folder.join("sweep.toml"), format!("{GEODESIC}[sweep]\nhamiltonian.c = [0.5, 1]\n")).unwrap();
    printed(&folder, &["sweep", "sweep.toml", "--out", "."]);
    let table = std::fs::read_to_string(folder.join("sweep.sweep.csv")).unwrap();
    assert!(table.starts_with("hamiltonian.c") && table.lines().count() == 3, "{table}");
}

#[test]
fn mistakes_have_their_places() {
    let folder = folder("hamiltonian-mistakes");
    let said = |text: &str, place: &str, message: &str| {
        let found = refused(&folder, text);
        assert!(found.contains(place) && found.contains(message), "{found}");
    };
    let with = |from: &str, to: &str| GEODESIC.replace(from, to);
    said(&with("mu[0].powi(2)", "nu[0].powi(2)"), "4:11", "`nu`");
    said(&with("h = \"c * (mu[0].powi(2) + mu[1].powi(2))\"\n", ""), "2:", "a Hamiltonian has `h`");
    said(&with("momentum = [", "velocity = ["), "6:", "starts with a momentum");
    said(&with("step = 0.05\n", ""), "8:", "give the run a `step`");
    let method = "step = 0.05\nmethod = { collocation = 4 }";
    said(&with("step = 0.05", method), "10:10", "leave it out");
    let times = "c = { times = [0, 3], values = [1, 2], between = \"lines\" }";
    said(&with("c = 0.5", times), "5:", "don't change with time");
    let body = "[lagrangian]\nl_d = \"((F - I) * J_d * (F - I).transpose()).trace() / (2 * h)\"\nJ_d = { moments = [3, 3, 4] }\n";
    for other in [body, "[gravity]\nm = 1\ng = 9.81\nrho = [0, 0, 1]\nup = [0, 0, 1]\n"] {
        said(&format!("{GEODESIC}{other}"), "13:", "has all its terms in its text");
    }
}
