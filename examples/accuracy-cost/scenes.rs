//! The five scenes, with their exact states.
//!
//! The references are those of the tests, to 25 digits and more; `tests/data/README.md` says how each was validated.

use std::error::Error;

use declarations::{FourthOrderBody, FourthOrderTop, FreeBody, HeavyTop, SixthOrderBody, SixthOrderTop};
use liestep::{DiagonalNonstandardInertia, Inertia, SO3};
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;
use workbench::top_equations::{Equations, State};

/// A body, its start, and where it is later.
pub struct Scene {
    pub name: &'static str,
    /// For names of files and columns.
    pub short: &'static str,
    pub kind: Kind,
    /// Principal moments of the ordinary inertia, kg m².
    pub moments: Vector3<f64>,
    nonstandard: DiagonalNonstandardInertia,
    /// `m g`, N.
    pub weight: f64,
    /// Centre of mass from the pivot, body frame, m.
    pub rho: Vector3<f64>,
    /// At the start, body to space.
    pub attitude: Matrix3<f64>,
    /// At the start, body frame, rad/s.
    pub velocity: Vector3<f64>,
    states: Vec<(f64, End)>,
}

/// Attitude (body to space) and body velocity at the end of a run.
pub type End = (Matrix3<f64>, Vector3<f64>);

/// What methods a scene allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A symmetric body under gravity along its axis.
    SymmetricTop,
    /// Any body under gravity.
    Top,
    /// Nothing acts on it.
    Free,
}

macro_rules! data {
    ($name:literal) => {
        include_str!(concat!("../../tests/data/", $name, ".json"))
    };
}

impl Scene {
    /// All five.
    pub fn all() -> Result<Vec<Self>, Box<dyn Error>> {
        let symmetric = Kind::SymmetricTop;
        [
            ("looping top", "looping", symmetric, data!("thesis_looping_A_Jd221")),
            ("cuspidal top", "cuspidal", symmetric, data!("thesis_cuspidal_A_Jd221")),
            ("third top of the thesis", "third", symmetric, data!("thesis_unidirectional_A_Jd221")),
            ("chaotic asymmetric top", "chaotic", Kind::Top, data!("chaotic_asymmetric_top")),
            ("asymmetric free body", "free", Kind::Free, data!("free_asymmetric_body")),
        ]
        .into_iter()
        .map(|(name, short, kind, text)| Self::read(name, short, kind, &serde_json::from_str(text)?))
        .collect()
    }

    fn read(name: &'static str, short: &'static str, kind: Kind, data: &Value) -> Result<Self, Box<dyn Error>> {
        let apart = !data["initial"].is_null();
        let weight = if apart { number(&data["m"])? * number(&data["g"])? } else { number(&data["mg"])? };
        let end = |state: &Value| -> Result<End, Box<dyn Error>> {
            let attitude = if apart { &state["R"] } else { &state["R_row_major"] };
            Ok((matrix(attitude)?, vector(&state["Omega"])?))
        };
        let list = data["states"].as_array().ok_or("a reference without states")?;
        let states: Result<Vec<_>, Box<dyn Error>> =
            list.iter().map(|state| Ok((number(&state["t"])?, end(state)?))).collect();
        let (attitude, velocity) = end(if apart { &data["initial"] } else { &list[0] })?;
        let nonstandard = DiagonalNonstandardInertia::new(vector(&data["J_d"])?)?;
        let d = nonstandard.diagonal();
        let moments = Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y);
        let rho = vector(&data["rho"])?;
        Ok(Self { name, short, kind, moments, nonstandard, weight, rho, attitude, velocity, states: states? })
    }

    /// A body that something else than gravity acts on, with its states at the times of the runs.
    pub fn bare(
        name: &'static str,
        nonstandard: DiagonalNonstandardInertia,
        attitude: Matrix3<f64>,
        velocity: Vector3<f64>,
        states: Vec<(f64, End)>,
    ) -> Self {
        let (weight, rho, d) = (0.0, Vector3::zeros(), nonstandard.diagonal());
        let moments = Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y);
        Self { name, short: name, kind: Kind::Top, moments, nonstandard, weight, rho, attitude, velocity, states }
    }

    /// The exact state at a time of the reference, s.
    pub fn reference(&self, t: f64) -> Option<&End> {
        self.states.iter().find(|(time, _)| (time - t).abs() < 1e-9).map(|(_, end)| end)
    }

    /// In the variables of the rivals.
    pub fn equations(&self) -> Equations {
        Equations::new(self.moments.into(), (self.rho * self.weight).into())
    }

    /// Where the rivals start.
    pub fn start(&self) -> State {
        let q = SO3::from_matrix_unchecked(self.attitude).to_quaternion();
        let p = self.moments.component_mul(&self.velocity);
        [q.w, q.i, q.j, q.k, p.x, p.y, p.z]
    }

    /// The body with the kinetic term of (3.13) under gravity.
    pub fn top(&self) -> HeavyTop {
        HeavyTop { J_d: self.nonstandard, m: 1.0, g: self.weight, rho: self.rho, up: Vector3::z() }
    }

    /// The body with the kinetic term of (3.13) alone.
    pub fn free_body(&self) -> FreeBody {
        FreeBody { J_d: self.nonstandard.into() }
    }

    /// The top by the Lagrangian of order 4.
    pub fn fourth_order_top(&self) -> FourthOrderTop {
        FourthOrderTop { J: self.inertia(), weight: self.weight, rho: self.rho, up: Vector3::z() }
    }

    /// The top by the Lagrangian of order 6.
    pub fn sixth_order_top(&self) -> SixthOrderTop {
        SixthOrderTop { J: self.inertia(), weight: self.weight, rho: self.rho, up: Vector3::z() }
    }

    /// The body by the Lagrangian of order 4.
    pub fn fourth_order_body(&self) -> FourthOrderBody {
        FourthOrderBody { J: self.inertia() }
    }

    /// The body by the Lagrangian of order 6.
    pub fn sixth_order_body(&self) -> SixthOrderBody {
        SixthOrderBody { J: self.inertia() }
    }

    /// The nonstandard inertia.
    pub fn nonstandard(&self) -> DiagonalNonstandardInertia {
        self.nonstandard
    }

    /// The ordinary inertia.
    pub fn inertia(&self) -> Inertia {
        liestep::NonstandardInertia::from(self.nonstandard).to_inertia()
    }
}

/// The error of attitude and body velocity together, each relative to the size of the exact one.
pub fn error(end: &End, exact: &End) -> f64 {
    let attitude = (end.0 - exact.0).norm() / exact.0.norm();
    attitude.hypot((end.1 - exact.1).norm() / exact.1.norm())
}

fn number(value: &Value) -> Result<f64, Box<dyn Error>> {
    match value {
        Value::String(text) => Ok(text.parse()?),
        other => other.as_f64().ok_or_else(|| format!("not a number: {other}").into()),
    }
}

fn vector(value: &Value) -> Result<Vector3<f64>, Box<dyn Error>> {
    Ok(Vector3::new(number(&value[0])?, number(&value[1])?, number(&value[2])?))
}

/// A matrix given by rows, or as nine numbers row by row.
fn matrix(value: &Value) -> Result<Matrix3<f64>, Box<dyn Error>> {
    let entry = |i: usize, j: usize| if value[0].is_array() { &value[i][j] } else { &value[3 * i + j] };
    let mut matrix = Matrix3::zeros();
    for i in 0..3 {
        for j in 0..3 {
            matrix[(i, j)] = number(entry(i, j))?;
        }
    }
    Ok(matrix)
}
