//! Motions with exact states: `tests/data/README.md` describes the validation of each.

use std::array::from_fn;

use liestep::mechanics::DiagonalNonstandardInertia;
use liestep::methods::{Chain, Link};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3};
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;
use workbench::heavy_top::declaration::HeavyTop;

/// A top or a free body, its initial state, and its exact later states.
#[derive(Clone)]
pub struct Motion {
    pub name: &'static str,
    pub top: HeavyTop,
    pub attitude: SO3,
    /// The body velocity in the body frame, rad/s.
    pub velocity: Vector3<f64>,
    states: Vec<(f64, End)>,
}

/// The attitude (body to space) and the body velocity.
pub type End = (Matrix3<f64>, Vector3<f64>);

/// The files of `tests/data`, under short names for tables.
macro_rules! files {
    ($($name:literal: $file:literal),+ $(,)?) => {
        const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../tests/data/", $file, ".json")))),+];
    };
}

files! {
    "looping A": "thesis_looping_A_Jd221",
    "cuspidal A": "thesis_cuspidal_A_Jd221",
    "third A": "thesis_unidirectional_A_Jd221",
    "looping B": "thesis_looping_B_J221",
    "cuspidal B": "thesis_cuspidal_B_J221",
    "third B": "thesis_unidirectional_B_J221",
    "chaotic": "chaotic_asymmetric_top",
    "free": "free_asymmetric_body",
    "sprung": "spring_asymmetric_top",
    "satellite": "fast_satellite",
    "free flip": "free_asymmetric_J123_intermediate",
    "free symmetric": "free_axisymmetric_Jd221",
    "golden steps": "golden_steps",
    "several bodies": "several_bodies",
    "chain steps": "chain_steps",
    "closed loop": "closed_loop",
}

/// The content of a file, by its name above.
pub fn read(name: &str) -> Value {
    serde_json::from_str(file(name).1).expect(name)
}

fn file(name: &str) -> (&'static str, &'static str) {
    *FILES.iter().find(|file| file.0 == name).expect(name)
}

/// A number that is stored as a text, to have all its digits.
pub fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

/// A time, s; round times are numbers in some files and strings in others.
fn time(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| number(value))
}

pub fn vector(value: &Value) -> Vector3<f64> {
    Vector3::from_fn(|i, _| number(&value[i]))
}

/// A matrix from its rows, or from nine numbers row by row.
pub fn matrix(value: &Value) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| number(if value[0].is_array() { &value[i][j] } else { &value[3 * i + j] }))
}

impl Motion {
    /// The motion of the file with the name above.
    pub fn read(name: &str) -> Self {
        let (name, data) = (file(name).0, read(name));
        // The thesis' cases have separate initial values, in angles too; in other files these are the state at zero.
        let apart = !data["initial"].is_null();
        let (m, g) = if apart { (number(&data["m"]), number(&data["g"])) } else { (number(&data["mg"]), 1.0) };
        let J_d = DiagonalNonstandardInertia::from_diagonal(vector(&data["J_d"])).unwrap();
        let top = HeavyTop { J_d, m, g, rho: vector(&data["rho"]), up: Vector3::z() };
        let end = |state: &Value| {
            let attitude = if apart { &state["R"] } else { &state["R_row_major"] };
            (matrix(attitude), vector(&state["Omega"]))
        };
        let (attitude, velocity) = end(if apart { &data["initial"] } else { &data["states"][0] });
        let states = data["states"].as_array().unwrap().iter();
        Self {
            name,
            top,
            attitude: SO3::try_from(attitude).unwrap(),
            velocity,
            states: states.map(|state| (time(&state["t"]), end(state))).collect(),
        }
    }

    /// The initial value of the thesis' first case, reading A: `φ̇ = 3`, `θ̇ = 0.5`, `ψ̇ = 10`, `θ = 0.8`.
    pub fn looping() -> Self {
        Self::read("looping A")
    }

    /// An asymmetric top in chaotic motion.
    pub fn chaotic() -> Self {
        Self::read("chaotic")
    }

    /// The three tops of the thesis, each in both readings.
    pub fn of_the_thesis() -> [Self; 6] {
        ["looping A", "cuspidal A", "third A", "looping B", "cuspidal B", "third B"].map(Self::read)
    }

    /// The attitude and body velocity at the time `t`, which must be one of the file's.
    pub fn at(&self, t: f64) -> End {
        self.states.iter().find(|(time, _)| (time - t).abs() < 1e-9).expect("a time of the file").1
    }

    /// All states of the file, with their times in s.
    pub fn states(&self) -> &[(f64, End)] {
        &self.states
    }
}

/// A link with this inertia about its centre of mass.
pub fn link(central: &Matrix3<f64>, m: f64, c: Vector3<f64>, rho: Vector3<f64>) -> Link {
    Link { J_d: NonstandardInertia::new(central + c * c.transpose() * m).unwrap(), m, c, rho }
}

/// The chain of three links of the reference.
pub fn chain3() -> Chain<3> {
    let data = &read("several bodies")["chain3"]["parameters"];
    let plain = |value: &Value| Vector3::from_fn(|k, _| value[k].as_f64().unwrap());
    let links = from_fn(|k| {
        let body = &data["bodies"][k];
        let moments = plain(&body["J_cm"]);
        let central = Matrix3::from_diagonal_element(0.5 * moments.sum()) - Matrix3::from_diagonal(&moments);
        link(&central, body["m"].as_f64().unwrap(), plain(&body["c"]), plain(&body["rho"]))
    });
    Chain { links, g: data["g"].as_f64().unwrap(), up: Vector3::z() }
}

/// The initial attitudes and body velocities of the reference of [`chain3`].
pub fn start3() -> ([SO3; 3], Bodies<Vector3<f64>, 3>) {
    let start = &read("several bodies")["chain3"]["states"][0]["bodies"];
    let attitudes = from_fn(|k| SO3::try_from(matrix(&start[k]["R"])).unwrap());
    (attitudes, Bodies(from_fn(|k| vector(&start[k]["Omega_body"]))))
}
