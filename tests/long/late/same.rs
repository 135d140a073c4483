//! Comparison of the steps of a compiled effect with those of its text.

use liestep::Stepper;
use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction};
use liestep::laws::samples::Random;
use liestep::mechanics::Regular;
use liestep::motion::{Integrator as _, Propagator as _};
use liestep::numbers::Entries;
use liestep::with::Method;
use liestep_late::{Declaration, Whole, numbers};

use crate::slopes::assert_gradient;

/// Asserts that the declaration, read from its text, makes the steps of the compiled effect.
pub(crate) fn assert_as_compiled<E>(compiled: &E, seed: u64)
where
    E: Regular<Scalar = f64, Retraction = CayleyRetraction> + Clone,
    E::Advected: Advected<E::Group>,
    CayleyRetraction: Retraction<E::Group>,
{
    assert_whole(compiled, Declaration::like(compiled).expect("a declaration").0, seed);
}

/// Declarations whose guesses use a longer history in the library, so that steps agree to rounding.
const WITH_HISTORY: [&str; 1] = ["PacedTop"];

/// Numbers agree, to the bit or to rounding.
fn assert_near(found: &[f64], expected: &[f64], is_exact: bool, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size = 1.0 + expected.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
    let tolerance = if is_exact { 0.0 } else { 1e-9 * size };
    let is_near =
        |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance || a.is_nan() && b.is_nan() || a.to_bits() == b.to_bits();
    assert!(found.iter().zip(expected).all(is_near), "{what}: {found:?} {expected:?}");
}

/// The entries of a value; those of a matrix row by row.
pub(crate) fn list<E: Entries<f64>>(value: &E) -> Vec<f64> {
    let mut list = Vec::new();
    value.each(&mut |entry: f64| list.push(entry));
    list
}

/// Asserts that the whole step of the declaration, whose states are slices, makes the steps of the compiled effect, also if
/// they are so long that a solve needs care or has no solution: the same numbers, reports, errors and parts of steps; and that
/// its gradients are those of differences.
pub(crate) fn assert_whole<E>(compiled: &E, declaration: &'static Declaration, seed: u64)
where
    E: Regular<Scalar = f64, Retraction = CayleyRetraction> + Clone,
    E::Advected: Advected<E::Group>,
    CayleyRetraction: Retraction<E::Group>,
{
    let mut random = Random::new(seed);
    let mut vector = || -> <E::Group as LieGroup>::Vector { random.sample() };
    let (attitude, velocity) = (<CayleyRetraction as Retraction<E::Group>>::retract(&(vector() * 0.5)), vector());
    let values = declaration.described(&numbers(compiled)).expect("numbers");
    if declaration.energy.is_none() {
        assert_gradient(declaration, &values, &list(&attitude.matrix()), &list(&velocity));
    }
    let rows = declaration.factors.iter().map(|factor| factor.generators[0].len().isqrt()).max();
    // In a sum the tangent of the retraction is taken after the sum.
    let has_one_tangent = declaration.in_increment && declaration.name.contains(" + ");
    let is_exact = rows < Some(5) && !has_one_tangent && !WITH_HISTORY.contains(&declaration.name.as_str());
    // Attitudes are restored every 1,024 steps.
    let short = [(0.01, 1100), (-0.01, 200)];
    let long = [(0.15, 150), (0.4, 150), (1.5, 50)];
    let mut made = 0;
    for (h, steps) in short.into_iter().chain(long.into_iter().filter(|_| is_exact)) {
        let what = format!("{} by {h} s", declaration.name);
        let one = Stepper::new(compiled.clone(), h).expect("a stepper");
        let whole: Whole = Whole::of(declaration, &values, h, Method::default()).expect("a whole step");
        let mut expected = one.start(attitude, velocity).expect("a start");
        let mut state = whole.start(&list(&attitude.matrix()), &list(&velocity)).expect("a start");
        let layout = whole.layout();
        let motion = |state: &[f64]| state[..layout.memory().start].to_vec();
        let of = |attitude: &E::Group, momentum: &<E::Group as LieGroup>::Vector, w: &E::Advected| {
            [list(&attitude.matrix()), list(momentum), list(w)].concat()
        };
        for step in 0..steps {
            if step % 100 == 7 {
                let (a, b) = (one.part(&expected, 0.3), whole.part(&state, 0.3));
                match (a, b) {
                    (Ok(a), Ok(b)) => {
                        let a = of(&a.attitude(), &a.momentum(), &a.advected());
                        assert_near(&motion(&b), &a, is_exact, &format!("part after {step} of {what}"));
                    }
                    (a, b) => assert_eq!(a.err(), b.err(), "part after {step} of {what}"),
                }
            }
            let before = state.clone();
            let (report, found) = (one.step(&mut expected), whole.step(&mut state));
            if is_exact {
                assert_eq!(found, report, "step {step} of {what}");
            } else if report.is_err() || found.is_err() {
                break;
            }
            if report.is_err() {
                assert_eq!(before, state, "an error leaves the state");
                break;
            }
            made += 1;
            let now = of(&expected.attitude(), &expected.momentum(), &expected.advected());
            assert_near(&motion(&state), &now, is_exact, &format!("step {step} of {what}"));
        }
        let mut found = vec![0.0; layout.components()];
        whole.velocity(&state, &mut found);
        assert_near(&found, &list(&one.velocity(&expected)), is_exact, "velocity");
        whole.spatial_momentum(&state, &mut found);
        assert_near(&found, &list(&expected.spatial_momentum()), false, "momentum in space");
        assert_near(&[whole.energy(&state)], &[one.energy(&expected)], is_exact, &format!("energy of {what}"));
        let defects = [whole.defect(&state), expected.orthogonality_defect()];
        // The defect is compared to the rounding of squares of entries.
        let entries = list(&expected.attitude().matrix());
        let size = 1.0 + entries.iter().map(|entry| entry * entry).sum::<f64>();
        assert!((defects[0] - defects[1]).abs() < 1e-12 * size, "{what}: {defects:?}");
    }
    // A random motion may fail earlier; both ends are compared.
    assert!(made > 100, "only {made} steps of {}", declaration.name);
}
