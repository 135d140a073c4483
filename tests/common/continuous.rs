//! The continuous systems, by their inertia and their potential as a function of the configuration in space.
//!
//! ```text
//! ġ = g ξ̂,     μ = J ξ,     μ̇ = ad*_ξ μ − dU(g exp(s E_k))/ds
//! ```
//!
//! The derivation isn't used: there is no advected parameter and no diamond, and inertia and potential are written by
//! hand.

use liestep::laws::samples::derivative;
use liestep::laws::samples::{MatrixLieGroup, along};
use nalgebra::{SMatrix, SVector};
use workbench::runge_kutta;

use crate::structure::axis;

/// A body on a group: its inertia in the basis of the algebra, and its potential at a configuration, in J.
pub struct Body<'a, const N: usize, const D: usize> {
    pub inertia: SMatrix<f64, D, D>,
    pub potential: &'a dyn Fn(&SMatrix<f64, N, N>) -> f64,
}

/// The configuration and the body momentum.
pub type Phase<const N: usize, const D: usize> = (SMatrix<f64, N, N>, SVector<f64, D>);

impl<const N: usize, const D: usize> Body<'_, N, D> {
    fn rate<G: MatrixLieGroup<N, D>>(&self, inverse: &SMatrix<f64, D, D>, (g, momentum): &Phase<N, D>) -> Phase<N, D> {
        let velocity = inverse * momentum;
        let force = SVector::<f64, D>::from_fn(|k, _| {
            -derivative(|s| (self.potential)(&(g * along::<G, N, D>(&axis(k, s), 1.0).matrix())))
        });
        (g * G::hat(&velocity), G::lie_bracket_transpose(&velocity, momentum) + force)
    }

    /// The solution after the time `t`, by the classical Runge–Kutta method.
    pub fn solution<G: MatrixLieGroup<N, D>>(&self, start: Phase<N, D>, t: f64, steps: u32) -> Phase<N, D> {
        let inverse = self.inertia.try_inverse().expect("an inertia");
        let numbers = |(g, momentum): Phase<N, D>| g.iter().chain(&momentum).copied().collect::<Vec<_>>();
        let phase = |y: &[f64]| (SMatrix::from_column_slice(&y[..N * N]), SVector::from_column_slice(&y[N * N..]));
        let mut state = numbers(start);
        let rate = |y: &[f64], rate: &mut [f64]| rate.copy_from_slice(&numbers(self.rate::<G>(&inverse, &phase(y))));
        runge_kutta::run(rate, &mut state, t, steps);
        phase(&state)
    }
}
