//! Tests that hold for all methods.

// Builds with debug assertions don't use wider vector instructions.
#![cfg(not(debug_assertions))]

use super::{ExactBody, ProcessedScheme, SplittingScheme};
use crate::effects::{Gravity, PrincipalBody};
use crate::groups::SO3;
use crate::mechanics::{DiagonalNonstandardInertia, Inertia, Sum};
use crate::motion::{Plan, State, StepReport, Stepper};
use crate::numbers::{Kernel, Vectors, dispatch};
use nalgebra::Vector3;

type Top = Sum<PrincipalBody, Gravity>;
type TopState<P> = State<SO3, ((), Vector3<f64>), <P as Plan<Top>>::Kept>;

/// A step compiled for vector registers of `WIDE` doubles.
struct Step<'a, P: Plan<Top>, const WIDE: usize>(&'a Stepper<Top, P>, &'a mut TopState<P>);

impl<P: Plan<Top>, const WIDE: usize> Kernel for Step<'_, P, WIDE> {
    type Output = StepReport;
    const VECTORS: Vectors = match WIDE {
        2 => Vectors::AsCompiled,
        4 => Vectors::Four,
        _ => Vectors::Eight,
    };

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self(stepper, state) = self;
        stepper.plan().step(stepper.scene(), &mut state.motion, &mut state.kept).unwrap()
    }
}

fn assert_same_digits<P: Plan<Top>>(stepper: &Stepper<Top, P>) {
    let start = || -> TopState<P> { stepper.start(SO3::identity(), Vector3::new(0.5, 2.0, 3.0)).unwrap() };
    let [mut two, mut four, mut eight, mut chosen] = [start(), start(), start(), start()];
    for step in 0..1000 {
        let here = dispatch(Step::<P, 2>(stepper, &mut two));
        let found = [
            dispatch(Step::<P, 4>(stepper, &mut four)),
            dispatch(Step::<P, 8>(stepper, &mut eight)),
            stepper.step(&mut chosen).unwrap(),
        ];
        assert!(found.iter().all(|found| *found == here), "step {step}");
        assert!([&four, &eight, &chosen].into_iter().all(|state| *state == two), "step {step}");
    }
}

/// The test compares different code only if the machine has wider vectors than the target's baseline.
#[test]
fn the_instructions_of_the_machine_change_no_digit() {
    let moments = Vector3::new(1.6, 2.6, 3.0);
    let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments).unwrap() };
    let (top, h) = (body + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.1, 0.2, 0.3), up: Vector3::z() }, 0.05);
    assert_same_digits(&Stepper::collocated::<1>(top, h).unwrap());
    assert_same_digits(&Stepper::collocated::<2>(top, h).unwrap());
    assert_same_digits(&Stepper::collocated::<3>(top, h).unwrap());
    assert_same_digits(&Stepper::collocated::<4>(top, h).unwrap());
    assert_same_digits(&Stepper::collocated::<8>(top, h).unwrap());
    let flow = ExactBody::new(&Inertia::from_principal_moments(moments).unwrap());
    // At the second step size drifts are longer than the range of the polynomials.
    for h in [h, 0.8] {
        assert_same_digits(&Stepper::split(top, h, flow, SplittingScheme::NYSTROM_14).unwrap());
        assert_same_digits(&Stepper::processed(top, h, flow, ProcessedScheme::SIX_A).unwrap());
    }
}
