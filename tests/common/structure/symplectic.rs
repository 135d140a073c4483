//! Property 1 of section 1.4: a step preserves the symplectic form of attitudes and momenta.

use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::derivative;
use liestep::motion::DiscreteLiePoisson;
use nalgebra::DMatrix;

use super::numbers::numbers;
use super::{Group as _, System, Vector, axis, step};

/// One step on `T*G`, left-trivialised.
pub fn map<L: System>(flow: &DiscreteLiePoisson<L>, g: &L::Group, momentum: &Vector<L>) -> (L::Group, Vector<L>) {
    let step = step(flow, momentum, &flow.scene().advected().seen_from(g));
    (g.advance(&step.increment), step.momentum)
}

/// The largest entry of `Φ*ω − ω` for `ω((η, ν), (η', ν')) = ⟨ν', η⟩ − ⟨ν, η'⟩ + ⟨μ, [η, η']⟩`, and with the opposite
/// sign of the bracket; both relative to the square of the largest entry of the tangent map, or to one.
pub fn defects<L: System>(flow: &DiscreteLiePoisson<L>, g: &L::Group, momentum: &Vector<L>) -> [f64; 2] {
    let dimension = L::Group::DIMENSION;
    let (next, after) = map(flow, g, momentum);
    let back = next.inverse();
    let mut tangent = DMatrix::zeros(2 * dimension, 2 * dimension);
    for k in 0..2 * dimension {
        let column = derivative(|s| {
            let (turn, push) = if k < dimension { (s, 0.0) } else { (0.0, s) };
            let turned = g.compose(&L::Group::turn(k % dimension, turn));
            let (h, nu) = map(flow, &turned, &(*momentum + axis(k % dimension, push)));
            // To first order g exp(ξ̂) is g + g ξ̂.
            numbers(&(L::Group::vee(&back.compose(&h).increment()), nu))
        });
        tangent.set_column(k, &column);
    }
    let form = |momentum: &Vector<L>, sign: f64| {
        DMatrix::from_fn(2 * dimension, 2 * dimension, |i, j| match (i < dimension, j < dimension) {
            (true, true) => -sign * L::Group::lie_poisson_bracket(momentum, &axis(i, 1.0), &axis(j, 1.0)),
            (true, false) => f64::from(u8::from(i + dimension == j)),
            (false, true) => -f64::from(u8::from(j + dimension == i)),
            (false, false) => 0.0,
        })
    };
    let scale = tangent.amax().max(1.0).powi(2);
    [1.0, -1.0].map(|sign| (tangent.transpose() * form(&after, sign) * &tangent - form(momentum, sign)).amax() / scale)
}
