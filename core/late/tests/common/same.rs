//! Comparison of two effects that have to make the same steps.

use liestep::Stepper;
use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction};
use liestep::laws::samples::Random;
use liestep::mechanics::{Regular, WithKinetic};
use liestep::motion::Propagator as _;
use liestep::numbers::Entries;
use liestep_derivation::ParameterKind;
use liestep_late::{Declaration, Interpreter, Late, LateError, Slots, Whole, WholeFamily, numbers};

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
    assert_whole(compiled, seed);
}

/// Asserts that the whole step as data makes the steps of the compiled effect, forwards and backwards: to the bit, but for
/// five rows and more, where pivots are taken on the diagonal.
fn assert_whole<E>(compiled: &E, seed: u64)
where
    E: Regular<Scalar = f64, Retraction = CayleyRetraction> + Clone,
    CayleyRetraction: Retraction<E::Group>,
{
    let declaration = Declaration::parse(E::DECLARATION).expect("a declaration");
    if declaration.energy.is_some() {
        // A pace changes the advected energy between steps, which a step as data doesn't.
        assert!(matches!(WholeFamily::<Interpreter>::of(declaration), Err(LateError::Pace)));
        return;
    }
    let family = WholeFamily::<Interpreter>::of(declaration).expect("a step");
    let is_exact = family.layout().factors.iter().all(|factor| factor.kind.rows() < 5);
    let described = numbers(compiled);
    let (mut rest, mut own) = (&described[..], Vec::new());
    for parameter in &declaration.parameters {
        // An effect describes a diagonal inertia by the nine entries of its tensor.
        let (length, stride) =
            if parameter.kind == ParameterKind::DiagonalInertia { (9, 4) } else { (parameter.kind.len(), 1) };
        let (value, behind) = rest.split_at(length);
        own.extend(value.iter().step_by(stride));
        rest = behind;
    }
    let mut random = Random::new(seed);
    let mut vector = || -> <E::Group as LieGroup>::Vector { random.sample() };
    let (attitude, velocity) = (<CayleyRetraction as Retraction<E::Group>>::retract(&(vector() * 0.5)), vector());
    let list = |value: &[u64]| value.iter().map(|bits| f64::from_bits(*bits)).collect::<Vec<_>>();
    for h in [0.01, -0.01] {
        let one = Stepper::new(compiled.clone(), h).expect("a stepper");
        let other = Whole::new(&family, &own, h).expect("a stepper");
        let mut first = one.start(attitude, velocity).expect("a start");
        let mut second = other.start(&list(&bits(&attitude.matrix())), &list(&bits(&velocity))).expect("a start");
        let layout = family.layout();
        for step in 0..300 {
            let (report, same) = (one.step(&mut first), other.step(&mut second));
            assert_eq!(report.is_err(), same.is_err(), "step {step} of {}: {report:?}, {same:?}", declaration.name);
            if report.is_err() {
                break;
            }
            let numbers = [bits(&first.attitude().matrix()), bits(&first.momentum()), bits(&first.advected())].concat();
            if is_exact {
                assert_eq!(report, same, "step {step} of {}", declaration.name);
                let found: Vec<u64> = second[..layout.memory().start].iter().map(|number| number.to_bits()).collect();
                assert_eq!(found, numbers, "step {step} of {}", declaration.name);
            } else {
                for (found, expected) in second.iter().zip(list(&numbers)) {
                    assert!((found - expected).abs() < 1e-10 * expected.abs().max(1.0), "{found} {expected}");
                }
            }
        }
        let (energy, same) = (one.energy(&first), other.energy(&second));
        assert!(
            (energy - same).abs() <= 1e-9 * energy.abs().max(1.0),
            "energy {energy} {same} of {}",
            declaration.name
        );
    }
}
