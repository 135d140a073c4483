//! The reference motions with all their digits.

use declarations::motions::read;
use nalgebra::Vector3;
use serde_json::Value;

use super::{DoubleDouble, Matrix, Vector, long};

/// A heavy top in principal axes, its initial state and its exact later states.
pub(crate) struct Motion {
    /// The nonstandard moments `J_d`, kg m².
    pub(crate) nonstandard: Vector,
    /// The moments of the ordinary inertia, kg m².
    pub(crate) moments: Vector,
    /// The lever `m g ρ`, N m.
    pub(crate) lever: Vector,
    /// The vertical, in space.
    pub(crate) up: Vector,
    pub(crate) attitude: Matrix,
    pub(crate) velocity: Vector,
    states: Vec<(f64, Matrix, Vector)>,
}

fn number(value: &Value) -> DoubleDouble {
    DoubleDouble::parse(value.as_str().unwrap())
}

fn vector(value: &Value) -> Vector {
    Vector3::from_fn(|i, _| number(&value[i]))
}

fn matrix(value: &Value) -> Matrix {
    Matrix::from_fn(|i, j| number(if value[0].is_array() { &value[i][j] } else { &value[3 * i + j] }))
}

fn time(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| number(value).rounded())
}

impl Motion {
    /// The motion of a file, as by [`declarations::Motion::read`] but with all digits.
    pub(crate) fn read(name: &str) -> Self {
        let data = read(name);
        let apart = !data["initial"].is_null();
        // The other files were computed with moments and a lever that are doubles.
        let parameter = |number: DoubleDouble| if apart { number } else { long(number.rounded()) };
        let weight = if apart { number(&data["m"]) * number(&data["g"]) } else { parameter(number(&data["mg"])) };
        let d = vector(&data["J_d"]).map(parameter);
        let moments = Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y).map(parameter);
        let attitude = |state: &Value| matrix(if apart { &state["R"] } else { &state["R_row_major"] });
        let start = if apart { &data["initial"] } else { &data["states"][0] };
        let states = data["states"].as_array().unwrap().iter();
        Self {
            nonstandard: moments.map(|moment| moments.sum() * long(0.5) - moment),
            moments,
            lever: vector(&data["rho"]).map(parameter) * weight,
            up: Vector::z(),
            attitude: attitude(start),
            velocity: vector(&start["Omega"]),
            states: states.map(|state| (time(&state["t"]), attitude(state), vector(&state["Omega"]))).collect(),
        }
    }

    /// Body momentum at the start.
    pub(crate) fn momentum(&self) -> Vector {
        self.moments.component_mul(&self.velocity)
    }

    /// The body velocity of a momentum.
    pub(crate) fn velocity_of(&self, momentum: &Vector) -> Vector {
        momentum.zip_map(&self.moments, |momentum, moment| momentum / moment)
    }

    /// The torque `τ(w) = m g w × ρ`.
    pub(crate) fn torque(&self, w: &Vector) -> Vector {
        w.cross(&self.lever)
    }

    /// The error of attitude and body velocity at the time `t`, relative to the sizes of both.
    pub(crate) fn error(&self, t: f64, attitude: &Matrix, velocity: &Vector) -> f64 {
        let (_, exact, exact_velocity) =
            self.states.iter().find(|state| (state.0 - t).abs() < 1e-9).expect("a time of the file");
        // Differences are computed with all digits; doubles suffice for the result.
        let rounded = |difference: Matrix| difference.map(DoubleDouble::rounded).norm();
        let attitude = rounded(attitude - exact) / rounded(*exact);
        let of_velocity = (velocity - exact_velocity).map(DoubleDouble::rounded).norm();
        attitude.hypot(of_velocity / exact_velocity.map(DoubleDouble::rounded).norm())
    }
}
