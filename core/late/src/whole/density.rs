//! A density of steps in which a body turns by about the same angle.

use std::sync::Arc;

use liestep::SetupError;
use liestep_derivation::Array;
use liestep_derivation::whole::Form;
use nalgebra::Vector3;

use super::linear::{dot, solution};
use super::step::StepCodes;
use super::stepper::{Whole, WholeError};
use super::varied::Varied;
use crate::code::Backend;
use crate::declaration::ready_each;

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

impl<B: Backend<f64>> Whole<B> {
    /// Steps in which a body on SO(3) turns by about the same angle, `h ∝ (|Ω|² + ω²)^{-1/2}`, with a `floor` `ω`, rad/s, of
    /// the velocity that limits the length of a step. The first step is about `h`, see
    /// [`with_density`](Self::with_density) and [`densities::turn`](liestep::with::densities::turn).
    ///
    /// # Errors
    ///
    /// [`SetupError::Method`] on another group.
    pub fn turning_evenly(&self, floor: f64) -> Result<Varied<B>, WholeError> {
        let is_rotation = matches!(&self.codes.factors[..], [only] if only.form == Form::Rotation);
        if !is_rotation {
            let cause = "has a density of equal turns, which is that of a motion on `SO3`: leave it out";
            return Err(SetupError::Method { cause }.into());
        }
        // The diamond of the Lagrangian at the identity for `h = 1` is the torque at rest, [RDAE, (1.12)].
        let declaration = self.declaration();
        let diamond = match &declaration.programs.lagrangian {
            Some(terms) => ready_each::<B>(&[&terms[3]])?.pop(),
            None => None,
        };
        let (codes, numbers) = (Arc::clone(&self.codes), Arc::clone(&self.numbers));
        let rate = move |state: &[f64], velocity: &[f64]| {
            let sizes = &codes.sizes;
            let (momentum, advected) =
                (&state[sizes.momentum()..sizes.advected()], &state[sizes.advected()..sizes.history()]);
            let mut torque = vec![0.0; sizes.n];
            if let Some(program) = &diamond {
                let given = [
                    (Array::Step, &[1.0][..]),
                    (Array::Parameters, &numbers),
                    (Array::Advected, advected),
                    (Array::Element, &IDENTITY),
                    (Array::Inverse, &IDENTITY),
                ];
                B::run(&program.code, &[], given, &mut torque);
            }
            let [momentum, angular] = [momentum, velocity].map(Vector3::from_column_slice);
            let rate = momentum.cross(&angular) + Vector3::from_column_slice(&torque);
            let inertia = StepCodes::of(&codes, &numbers).limit(advected).inertia();
            dot(velocity, &solution(&inertia, rate.as_slice())) / (dot(velocity, velocity) + floor * floor)
        };
        Ok(self.with_density(rate))
    }
}
