//! Comparison of two effects that have to make the same steps.

use liestep::Stepper;
use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction};
use liestep::laws::samples::Random;
use liestep::mechanics::{Regular, WithKinetic};
use liestep::numbers::Entries;
use liestep_late::{Late, Slots};

fn bits<E: Entries<f64>>(value: &E) -> Vec<u64> {
    let mut list = Vec::new();
    value.each(&mut |entry: f64| list.push(entry.to_bits()));
    list
}

/// Asserts the same steps to the bit from a random start, forwards and backwards, up to a failure that both share.
pub(crate) fn assert_same<A, B>(compiled: &A, late: &B, seed: u64)
where
    A: Regular<Scalar = f64, Retraction = CayleyRetraction> + Clone,
    B: Regular<Scalar = f64, Retraction = CayleyRetraction, Group = A::Group, Advected = A::Advected> + Clone,
    A::Advected: Advected<A::Group>,
    CayleyRetraction: Retraction<A::Group>,
{
    let mut random = Random::new(seed);
    let mut vector = || -> <A::Group as LieGroup>::Vector { random.sample() };
    let (attitude, velocity) = (<CayleyRetraction as Retraction<A::Group>>::retract(&(vector() * 0.5)), vector());
    let mut made = 0;
    for h in [0.01, -0.01] {
        let one = Stepper::new(compiled.clone(), h).expect("a stepper");
        let other = Stepper::new(late.clone(), h).expect("a stepper");
        let mut first = one.start(attitude, velocity).expect("a start");
        let mut second = other.start(attitude, velocity).expect("a start");
        for step in 0..500 {
            let (report, same) = (one.step(&mut first), other.step(&mut second));
            assert_eq!(report, same, "step {step} of {}", late.derivation());
            if report.is_err() {
                break;
            }
            made += 1;
            assert_eq!(bits(&first.momentum()), bits(&second.momentum()), "momentum after step {step}");
            let attitudes = (bits(&first.attitude().matrix()), bits(&second.attitude().matrix()));
            assert_eq!(attitudes.0, attitudes.1, "attitude after step {step}");
            assert_eq!(bits(&first.advected()), bits(&second.advected()), "advected after step {step}");
        }
        assert_eq!(one.energy(&first).to_bits(), other.energy(&second).to_bits(), "energy");
    }
    // A random motion may fail earlier; both ends are compared.
    assert!(made > 100, "only {made} steps of {}", late.derivation());
}

/// Asserts that the declaration, read from its text and interpreted, makes the steps of the compiled effect.
pub(crate) fn assert_as_compiled<E>(compiled: &E, seed: u64)
where
    E: Regular<Scalar = f64, Retraction = CayleyRetraction> + Clone,
    E::Advected: Advected<E::Group> + Slots,
    CayleyRetraction: Retraction<E::Group>,
{
    let late = Late::<E::Group, E::Advected, WithKinetic>::like(compiled).expect("a declaration");
    assert_same(compiled, &late, seed);
}
