//! The programs of the continuous limit `l(ξ, w)`, which is `½ ξ·Jξ + s·ξ − V` at rest and where it is quadratic.

use super::matrix::Matrix;
use super::solved::Pattern;
use super::values::{Value, Words};
use super::writer::Writer;
use crate::staged::{Array, Program};

/// Programs of the parameters and of what is advected, some of a velocity or a momentum, too.
pub(super) struct Limit {
    /// The inertia `J` at rest.
    pub(super) inertia: Program,
    /// The determinants of `J`.
    pub(super) safe: Program,
    /// The velocity at rest, `J⁻¹(μ − s)`.
    pub(super) velocity: Program,
    /// The momentum `∂l/∂ξ`.
    pub(super) momentum: Program,
    /// `∂²l/∂ξ²`, where `l` isn't quadratic.
    pub(super) hessian: Option<Program>,
    /// The energy `ξ·∂l/∂ξ − l`.
    pub(super) energy: Program,
}

impl Writer<'_> {
    pub(super) fn limit(&self) -> Limit {
        let (mut words, n) = (Words::default(), self.dimension());
        let stages = &self.staged.programs;
        let at_rest = words.append(&stages.at_rest, Value::Input);
        let (inertia, bias, potential) = (&at_rest[..n * n], &at_rest[n * n..n * n + n], at_rest[n * n + n]);
        let matrix = Matrix { rows: n, columns: n, entries: inertia.to_vec() };
        let determinants = self.pattern.factorise(&mut words, &matrix).determinants;
        let whole = Pattern::whole(n);
        let factorisation = whole.factorise(&mut words, &matrix);
        let rest = words.subtracted(&Value::inputs(Array::Momentum, n), bias);
        let velocity = whole.solve(&mut words, &factorisation.factors, factorisation.determinants[0][0], &rest);
        let xi = Value::inputs(Array::Velocity, n);
        let (momentum, energy) = if let Some([l, momentum, _]) = &stages.at_velocity {
            let l = words.append(l, Value::Input)[0];
            let momentum = words.append(momentum, Value::Input);
            let power = words.dot(&xi, &momentum);
            (momentum, words.subtract(power, l))
        } else {
            let image: Vec<Value> = (0..n).map(|i| words.dot(matrix.row(i), &xi)).collect();
            let square = words.dot(&xi, &image);
            let kinetic = words.multiply(square, Value::of(0.5));
            (words.added(&image, bias), words.add(kinetic, potential))
        };
        Limit {
            inertia: words.program(inertia),
            safe: words.program(determinants.as_flattened()),
            velocity: words.program(&velocity),
            momentum: words.program(&momentum),
            hessian: stages.at_velocity.as_ref().map(|[.., hessian]| hessian.clone()),
            energy: words.program(&[energy]),
        }
    }
}
