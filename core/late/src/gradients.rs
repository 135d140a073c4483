//! The derivatives of a step, run by a back end.

use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction};
use liestep::mechanics::{KineticPart, SecondDerivatives, StepDerivatives, StepPoint};
use liestep::numbers::{Coordinates as _, real};
use liestep_derivation::Array;

use crate::carried::Slots;
use crate::code::Backend;
use crate::effect::{Square, Vector, alone, square, vector};
use crate::term::{Late, entries};

impl<G, W, K, B> Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    B: Backend<G::Scalar>,
{
    /// The outputs of one of the programs, with these weights; none if the derivatives weren't derived.
    fn derived<R>(
        &self,
        program: usize,
        StepPoint { increment, w, h }: StepPoint<'_, G, W>,
        [start, end]: [&Vector<G>; 2],
        make: impl FnOnce(&[G::Scalar]) -> R,
    ) -> R {
        let Some(programs) = &self.derivatives else { return make(&[]) };
        let given = [
            (Array::Step, &[h][..]),
            (Array::Parameters, &self.numbers),
            (Array::Advected, &entries(w)),
            (Array::Increment, &entries(increment)),
            (Array::InverseIncrement, &entries(&G::inverse_increment(increment))),
            (Array::Target, &entries(start)),
            (Array::Velocity, &entries(end)),
        ];
        make(&alone::<_, B, _>(&programs[program], given))
    }
}

/// Derivatives by the parameters are missing, as the type doesn't know the number of parameters.
impl<G, W, K, B> SecondDerivatives for Late<G, W, K, B>
where
    G: LieGroup,
    W: Advected<G> + Slots,
    K: KineticPart,
    B: Backend<G::Scalar>,
    CayleyRetraction: Retraction<G>,
{
    const PARAMETERS: usize = 0;

    fn are_derived(&self) -> bool {
        self.derivatives.is_some()
    }

    fn step_derivatives(&self, at: StepPoint<'_, G, W>) -> StepDerivatives<Square<G>> {
        let zero = Vector::<G>::zero();
        self.derived(0, at, [&zero; 2], |outputs| {
            let mut blocks = outputs.chunks(G::DIMENSION * G::DIMENSION);
            let mut next = || square::<G>(blocks.next().unwrap_or_default());
            let [start_by_turn, end_by_turn, start_by_place, end_by_place] = [(); 4].map(|()| next());
            StepDerivatives { start_by_turn, end_by_turn, start_by_place, end_by_place }
        })
    }

    fn by_parameters(&self, _: StepPoint<'_, G, W>, _: &mut impl FnMut(usize, Vector<G>, Vector<G>)) {}

    fn by_advected(&self, at: StepPoint<'_, G, W>, visit: &mut impl FnMut(usize, Vector<G>, Vector<G>)) {
        let zero = Vector::<G>::zero();
        self.derived(3, at, [&zero; 2], |outputs| {
            for (number, both) in outputs.chunks(2 * G::DIMENSION).enumerate() {
                visit(number, vector(both), vector(both.get(G::DIMENSION..).unwrap_or_default()));
            }
        });
    }

    fn carried_parameters(_: &mut impl FnMut(usize, usize)) {}

    fn adjoint_system(&self, at: StepPoint<'_, G, W>, at_end: &Vector<G>) -> (Square<G>, Vector<G>) {
        self.derived(1, at, [at_end; 2], |outputs| {
            (square::<G>(outputs), vector(outputs.get(G::DIMENSION * G::DIMENSION..).unwrap_or_default()))
        })
    }

    fn adjoint_gradient(
        &self,
        at: StepPoint<'_, G, W>,
        ends: [&Vector<G>; 2],
        _: &mut impl FnMut(usize, G::Scalar),
    ) -> (Vector<G>, W) {
        self.derived(2, at, ends, |outputs| {
            let mut by_advected = outputs.iter().skip(G::DIMENSION).copied();
            (vector(outputs), W::from_entries(&mut || by_advected.next().unwrap_or_else(|| real(0.0))))
        })
    }
}
