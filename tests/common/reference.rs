//! Reads `tests/data`.

// The letters of the field.
#![allow(non_snake_case)]

use liestep::{DiagonalNonstandardInertia, SO3};
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;

use crate::tops::HeavyTop;

/// A file of `tests/data`.
pub fn read(name: &str) -> Value {
    let path = format!("{}/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(&path).expect(&path)).expect(&path)
}

pub fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

/// A time, s; the round ones that are asked for are numbers in some files and strings in others.
fn time(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| number(value))
}

pub fn vector(value: &Value) -> Vector3<f64> {
    Vector3::from_fn(|i, _| number(&value[i]))
}

/// A matrix given by rows, or as nine numbers row by row.
pub fn matrix(value: &Value) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| number(if value[0].is_array() { &value[i][j] } else { &value[3 * i + j] }))
}

/// A motion with its states at some times.
pub struct Motion {
    pub top: HeavyTop,
    pub attitude: SO3,
    pub velocity: Vector3<f64>,
    states: Vec<(f64, Matrix3<f64>, Vector3<f64>)>,
}

impl Motion {
    pub fn read(name: &str) -> Self {
        let data = read(name);
        // The thesis' cases give their initial values apart, in angles too; elsewhere these are the state at zero.
        let apart = !data["initial"].is_null();
        let (m, g) = if apart { (number(&data["m"]), number(&data["g"])) } else { (number(&data["mg"]), 1.0) };
        let J_d = DiagonalNonstandardInertia::new(vector(&data["J_d"])).unwrap();
        let top = HeavyTop { J_d, m, g, rho: vector(&data["rho"]), up: Vector3::z() };
        let attitude = |state: &Value| matrix(if apart { &state["R"] } else { &state["R_row_major"] });
        let start = if apart { &data["initial"] } else { &data["states"][0] };
        let states = data["states"].as_array().unwrap().iter();
        Self {
            top,
            attitude: SO3::try_from(attitude(start)).unwrap(),
            velocity: vector(&start["Omega"]),
            states: states.map(|s| (time(&s["t"]), attitude(s), vector(&s["Omega"]))).collect(),
        }
    }

    /// Attitude and body velocity at the time `t`, which must be one of the file's.
    pub fn at(&self, t: f64) -> (Matrix3<f64>, Vector3<f64>) {
        let (_, attitude, velocity) =
            *self.states.iter().find(|state| (state.0 - t).abs() < 1e-9).expect("a time of the file");
        (attitude, velocity)
    }
}

/// The initial value of the thesis' first case, reading A: `φ̇ = 3`, `θ̇ = 0.5`, `ψ̇ = 10`, `θ = 0.8`.
pub fn looping() -> Motion {
    Motion::read("thesis_looping_A_Jd221")
}
