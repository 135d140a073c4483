//! Motions with exact states, those of the tests.
//!
//! `tests/data/README.md` says how each was validated.

use declarations::HeavyTop;
use liestep::{DiagonalNonstandardInertia, SO3};
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;

use crate::row::Failure;

/// A top, its start, and where it is later.
pub(crate) struct Motion {
    pub(crate) name: &'static str,
    pub(crate) top: HeavyTop,
    pub(crate) attitude: SO3,
    /// Body frame, rad/s.
    pub(crate) velocity: Vector3<f64>,
    states: Vec<(f64, End)>,
}

/// Attitude (body to space) and body velocity.
pub(crate) type End = (Matrix3<f64>, Vector3<f64>);

macro_rules! data {
    ($name:literal) => {
        include_str!(concat!("../../tests/data/", $name, ".json"))
    };
}

impl Motion {
    /// The looping top of the thesis, reading A.
    pub(crate) fn looping() -> Result<Self, Failure> {
        Self::read("looping A", data!("thesis_looping_A_Jd221"))
    }

    /// An asymmetric top in chaotic motion.
    pub(crate) fn chaotic() -> Result<Self, Failure> {
        Self::read("chaotic", data!("chaotic_asymmetric_top"))
    }

    /// The three tops of the thesis, each in both readings.
    pub(crate) fn of_the_thesis() -> Result<Vec<Self>, Failure> {
        [
            ("looping A", data!("thesis_looping_A_Jd221")),
            ("cuspidal A", data!("thesis_cuspidal_A_Jd221")),
            ("third A", data!("thesis_unidirectional_A_Jd221")),
            ("looping B", data!("thesis_looping_B_J221")),
            ("cuspidal B", data!("thesis_cuspidal_B_J221")),
            ("third B", data!("thesis_unidirectional_B_J221")),
        ]
        .into_iter()
        .map(|(name, text)| Self::read(name, text))
        .collect()
    }

    fn read(name: &'static str, text: &str) -> Result<Self, Failure> {
        let data: Value = serde_json::from_str(text)?;
        // The thesis' cases give their initial values apart; elsewhere these are the state at zero.
        let apart = !data["initial"].is_null();
        let (m, g) = if apart { (number(&data["m"])?, number(&data["g"])?) } else { (number(&data["mg"])?, 1.0) };
        let end = |state: &Value| -> Result<End, Failure> {
            let attitude = if apart { &state["R"] } else { &state["R_row_major"] };
            Ok((matrix(attitude)?, vector(&state["Omega"])?))
        };
        let list = data["states"].as_array().ok_or("a reference without states")?;
        let states: Result<_, Failure> = list.iter().map(|state| Ok((number(&state["t"])?, end(state)?))).collect();
        let (attitude, velocity) = end(if apart { &data["initial"] } else { &list[0] })?;
        #[allow(non_snake_case)] // the letter of the field
        let J_d = DiagonalNonstandardInertia::new(vector(&data["J_d"])?)?;
        let top = HeavyTop { J_d, m, g, rho: vector(&data["rho"])?, up: Vector3::z() };
        Ok(Self { name, top, attitude: SO3::try_from(attitude)?, velocity, states: states? })
    }

    /// The exact state at a time of the reference, s.
    pub(crate) fn at(&self, t: f64) -> Result<&End, Failure> {
        let state = self.states.iter().find(|(time, _)| (time - t).abs() < 1e-9);
        state.map(|(_, end)| end).ok_or_else(|| format!("no reference at {t} s").into())
    }
}

fn number(value: &Value) -> Result<f64, Failure> {
    match value {
        Value::String(text) => Ok(text.parse()?),
        other => other.as_f64().ok_or_else(|| format!("not a number: {other}").into()),
    }
}

fn vector(value: &Value) -> Result<Vector3<f64>, Failure> {
    Ok(Vector3::new(number(&value[0])?, number(&value[1])?, number(&value[2])?))
}

/// A matrix given by rows, or as nine numbers row by row.
fn matrix(value: &Value) -> Result<Matrix3<f64>, Failure> {
    let entry = |i: usize, j: usize| if value[0].is_array() { &value[i][j] } else { &value[3 * i + j] };
    let mut matrix = Matrix3::zeros();
    for i in 0..3 {
        for j in 0..3 {
            matrix[(i, j)] = number(entry(i, j))?;
        }
    }
    Ok(matrix)
}
