//! What mutated declarations compile to says what their `l_d` says.
//!
//! A mutation that is accepted is another Lagrangian. All of them become one crate, which rustc has to accept, and whose
//! momentum maps and diamond terms are compared with dual numbers of the `l_d` that it emits.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

use super::fuzz::{RICH, balanced, mutated, mutation, pieces};
use super::{HEAVY_TOP, expand, is_refused};

/// The items that the declarations are of, for every scalar.
const TOP: &str = "pub struct Top<T: Real> { pub J_d: NonstandardInertia<T>, pub m: T, pub g: T,
    pub rho: Vector3<T>, pub up: Vector3<T> }";
const RICH_ITEM: &str = "pub struct Rich<T: Real> { pub J_d: NonstandardInertia<T>, pub A: Matrix3<T>, pub k: T,
    pub rho: Vector3<T>, pub up: Vector3<T>, pub field: Vector3<T> }";

/// What is the same in the crate of every run.
const CRATE: &str = r#"#![allow(non_snake_case, unused)]
use liestep::mechanics::DiscreteLagrangian;
use liestep::{NonstandardInertia, SO3};
use nalgebra::{Matrix3, RealField, UnitQuaternion, Vector3, convert};
use num_dual::Dual64;

/// Advected parameters of vectors.
pub trait Vectors<T> {
    fn of(vectors: [Vector3<T>; 3]) -> Self;
}
impl<T> Vectors<T> for () {
    fn of(_: [Vector3<T>; 3]) {}
}
impl<T> Vectors<T> for Vector3<T> {
    fn of([a, ..]: [Vector3<T>; 3]) -> Self { a }
}
impl<T> Vectors<T> for (Vector3<T>, Vector3<T>) {
    fn of([a, b, _]: [Vector3<T>; 3]) -> Self { (a, b) }
}
impl<T> Vectors<T> for (Vector3<T>, Vector3<T>, Vector3<T>) {
    fn of([a, b, c]: [Vector3<T>; 3]) -> Self { (a, b, c) }
}

fn real<T: RealField>(value: f64) -> T { convert(value) }
fn vector<T: RealField>(x: f64, y: f64, z: f64) -> Vector3<T> { Vector3::new(x, y, z).map(convert) }
pub fn inertia<T: RealField + Copy>() -> NonstandardInertia<T> {
    NonstandardInertia::new(Matrix3::new(2.0, 0.3, -0.2, 0.3, 1.5, 0.1, -0.2, 0.1, 1.1).map(convert)).unwrap()
}

/// Compares at rotations small and large; returns how many had a value.
fn compare<L, D>(source: &str, l: &L, d: &D) -> usize
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected: Vectors<f64>>,
    D: DiscreteLagrangian<Scalar = Dual64, Group = SO3<Dual64>, Advected: Vectors<Dual64>>,
{
    let axes = [Vector3::new(0.3, -0.2, 0.1), Vector3::new(-0.05, 0.02, 0.04), Vector3::new(0.9, 0.4, -0.7)];
    let ws = [Vector3::new(0.4, -0.7, 0.6), Vector3::new(-0.3, 0.2, 0.8), Vector3::new(0.5, 0.1, -0.2)];
    let mut compared = 0;
    for axis in axes {
        let f = UnitQuaternion::from_scaled_axis(axis).to_rotation_matrix().into_inner();
        let (w, h) = (L::Advected::of(ws), 0.1);
        let at = |left: &Matrix3<Dual64>, right: &Matrix3<Dual64>, turn: &Matrix3<Dual64>| {
            let moved = D::Advected::of(ws.map(|w| turn * w.map(Dual64::from)));
            d.l_d(&(left * f.map(Dual64::from) * right), &moved, Dual64::from(h))
        };
        let still = Matrix3::identity();
        let value = at(&still, &still, &still).re;
        assert!(value.to_bits() == l.l_d(&f, &w, h).to_bits() || (value - l.l_d(&f, &w, h)).abs() < 1e-9 * value.abs()
            || value.is_nan(), "{source}");
        let (right, left) = (l.right_momentum(&f, &w, h), l.left_momentum(&f, &w, h));
        let (diamond, minus) = (l.diamond(&f, &w, h), l.legendre_minus(&f, &w, h));
        for k in 0..3 {
            let turn = still + Vector3::<f64>::ith(k, 1.0).cross_matrix().map(Dual64::from) * Dual64::new(0.0, 1.0);
            let said = [right[k], left[k], diamond[k], minus[k]];
            let declared = [
                at(&turn, &still, &still).eps,
                at(&still, &turn, &still).eps,
                -at(&still, &still, &turn).eps,
                at(&turn, &still, &turn).eps,
            ];
            if declared.iter().all(|x| x.is_finite()) && value.is_finite() {
                compared += 1;
                let scale = value.abs() + right.norm() + left.norm() + diamond.norm();
                for (said, declared) in said.into_iter().zip(declared) {
                    assert!((said - declared).abs() <= 1e-9 * scale, "{said} for {declared}: {source}");
                }
            }
        }
    }
    compared
}
"#;

/// What is written for each other and may still be a Lagrangian.
const ALIKE: [&[&str]; 7] = [
    &["+", "-", "*"],
    &["m", "g", "k", "h", "2.0", "0.5", "3.0", "1.5"],
    &["rho", "w", "up", "b", "field", "tip"],
    &["F", "I", "J_d", "A", "d"],
    &[".dot", ".cross", ".component_mul"],
    &[".sin", ".cos", ".exp", ".ln", ".sqrt", ".tanh"],
    &[".trace", ".norm_squared", ".transpose", ".norm"],
];

/// Some of the words exchanged for their like, the choices numbers at random.
fn varied(text: &str, choices: &[(usize, usize)]) -> String {
    // A method apart from what it is called on; a number stays whole.
    let apart = |word: String| match word.split_once('.') {
        Some((value, method)) if value.starts_with(char::is_alphabetic) => vec![value.to_owned(), format!(".{method}")],
        _ => vec![word],
    };
    let mut all: Vec<String> = pieces(text).into_iter().flat_map(apart).collect();
    let start = all.iter().position(|word| word == "l_d").expect("the declaration has it");
    for &(place, choice) in choices {
        let length = all.len() - start;
        // The next word after the place that has its like.
        let found = (0..length).map(|step| start + (place + step) % length).find_map(|at| {
            let alike = ALIKE.iter().find(|alike| alike.contains(&all[at].as_str()))?;
            Some((at, alike[choice % alike.len()]))
        });
        if let Some((at, word)) = found {
            word.clone_into(&mut all[at]);
        }
    }
    balanced(&all)
}

/// The mutations of a seed that are accepted, without those accepted before.
fn accepted(seed: u64, count: usize) -> Vec<(String, &'static str)> {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    let any_mutations = proptest::collection::vec(mutation(), 1..3);
    let variations = proptest::collection::vec(any::<(usize, usize)>(), 1..4);
    let mut found: Vec<(String, &'static str)> = Vec::new();
    for number in 0..count {
        let (text, item) = if number % 2 == 0 { (HEAVY_TOP, TOP) } else { (RICH, RICH_ITEM) };
        let arguments = if number % 4 < 2 {
            varied(text, &variations.new_tree(&mut runner).expect("variations").current())
        } else {
            mutated(text, &any_mutations.new_tree(&mut runner).expect("mutations").current())
        };
        let Ok(tokens) = arguments.parse() else { continue };
        if found.iter().all(|(known, _)| *known != arguments)
            && !is_refused(&expand(tokens, &item.parse().expect("an item")))
        {
            found.push((arguments, item));
        }
    }
    found
}

/// The crate of them: a module and a comparison each.
fn source(accepted: &[(String, &str)]) -> String {
    let (mut modules, mut calls) = (String::new(), String::new());
    for (number, (arguments, item)) in accepted.iter().enumerate() {
        let (name, fields) = if *item == TOP {
            ("Top", "J_d: crate::inertia(), m: crate::real(1.3), g: crate::real(9.81)")
        } else {
            (
                "Rich",
                "J_d: crate::inertia(), A: Matrix3::new(0.1, 0.5, -0.3, 0.7, 0.2, 0.4, -0.6, 0.3, 0.9).map(nalgebra::convert), \
              k: crate::real(0.8), field: crate::vector(0.2, -0.4, 0.3)",
            )
        };
        writeln!(
            modules,
            "mod m{number} {{ use liestep::{{NonstandardInertia, SO3, lagrangian, numbers::Real}}; use nalgebra::{{Matrix3, Vector3}};
             #[lagrangian({arguments})] {item}
             pub fn made<T: Real + nalgebra::RealField>() -> {name}<T> {{
                 {name} {{ {fields}, rho: crate::vector(0.3, 0.1, 0.9), up: crate::vector(0.1, 0.2, 1.0) }} }} }}"
        )
        .expect("a string takes it");
        writeln!(calls, "compared += compare({arguments:?}, &m{number}::made(), &m{number}::made());")
            .expect("a string takes it");
    }
    format!("{CRATE}\n{modules}\nfn main() {{ let mut compared = 0;\n{calls}\nprintln!(\"{{compared}}\"); }}\n")
}

#[test]
#[ignore = "builds a crate of what it accepts, some minutes; LIESTEP_SEED and LIESTEP_COUNT say which and how many"]
fn accepted_mutants_are_what_they_declare() {
    let number = |name: &str, usual: u64| env::var(name).map_or(usual, |text| text.parse().expect("a whole number"));
    let (seed, count) = (number("LIESTEP_SEED", 1), number("LIESTEP_COUNT", 1_000));
    let accepted = accepted(seed, usize::try_from(count).expect("some"));
    assert!(!accepted.is_empty(), "no mutation is accepted");

    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let directory = env::temp_dir().join(format!("liestep-mutants-{}", std::process::id()));
    fs::create_dir_all(directory.join("src")).expect("a folder");
    let manifest = format!(
        "[package]\nname = \"mutants\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[dependencies]\nliestep = {{ path = {:?} }}\n\
         nalgebra = {{ version = \"0.35\", default-features = false, features = [\"std\"] }}\nnum-dual = \"0.15\"\n[workspace]\n",
        root.join("core")
    );
    fs::write(directory.join("Cargo.toml"), manifest).expect("a file");
    fs::copy(root.join("Cargo.lock"), directory.join("Cargo.lock")).expect("a file");
    fs::write(directory.join("src/main.rs"), source(&accepted)).expect("a file");
    let output = Command::new(env!("CARGO"))
        .args(["run", "--quiet", "--offline"])
        .current_dir(&directory)
        .env_remove("RUSTFLAGS")
        .output()
        .expect("cargo");
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "in {}:\n{errors}", directory.display());
    println!("seed {seed}: {} of {count} mutations are accepted, {} values compared", accepted.len(), said.trim());
    fs::remove_dir_all(directory).expect("the folder is ours");
}
