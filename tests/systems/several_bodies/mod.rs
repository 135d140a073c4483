//! Several bodies on a product of groups, as they are declared: links that feel each other's velocities, bodies that feel
//! each other's attitudes alone, and bodies that are translated too; systems of many, chains of many links, and bodies held
//! together by joints.

mod casimirs;
mod declared;
mod edges;
mod forces;
mod joints;
mod lanes;
mod links;
mod many;
mod stiff;
mod translated;

use core::fmt::Debug;

use liestep::groups::{Advected, CayleyRetraction, LieGroup, Retraction};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::{ContinuousLagrangian, DiscreteLagrangian, Regular, Term};
use liestep::motion::RightHandSide;
use liestep::{SO3, Stepper};
use nalgebra::{Matrix3, SVector, Vector3};
use serde_json::Value;
use workbench::runge_kutta;

use declarations::motions::{matrix, number, read, vector};

/// Attitude and body velocity of one body.
type End = (Matrix3<f64>, Vector3<f64>);

/// The components of all bodies, one after the other.
fn stacked<const D: usize>(parts: &[Vector3<f64>]) -> SVector<f64, D> {
    SVector::from_fn(|k, _| parts[k / 3][k % 3])
}

/// Those of one body.
fn part<const D: usize>(of: &SVector<f64, D>, body: usize) -> Vector3<f64> {
    of.fixed_rows::<3>(3 * body).into_owned()
}

/// What a file has of all bodies.
fn all<R>(values: &Value, read: impl Fn(&Value) -> R) -> Vec<R> {
    values.as_array().unwrap().iter().map(read).collect()
}

fn attitudes_of(values: &Value) -> Vec<SO3> {
    all(values, |value| SO3::try_from(matrix(value)).unwrap())
}

fn momentum<const D: usize>(values: &Value) -> SVector<f64, D> {
    stacked(&all(values, vector))
}

/// The largest difference of an entry.
fn apart(attitudes: &[SO3], expected: &[SO3]) -> f64 {
    let differences = attitudes.iter().zip(expected).map(|(a, b)| (a.as_matrix() - b.as_matrix()).amax());
    differences.fold(0.0, f64::max)
}

/// Each error is a quarter of the one before.
fn order(errors: &[f64]) {
    println!("{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.02, "{order}");
    }
}

/// Errors of the first link's attitude and of the last one's velocity in the reference's chain after two seconds, at steps
/// of 0.02, 0.01, 0.005 and 0.0025 s: the order, and those of `tests/data/chain_steps.py`, which reduces and eliminates
/// nothing.
fn assert_reference(errors: &[(f64, f64); 4]) {
    let expected = all(&read("chain steps")["errors"], |of| [&of["attitude"], &of["velocity"]].map(number));
    assert_eq!(expected.len(), errors.len());
    for (found, expected) in errors.iter().zip(expected) {
        let off = [found.0 / expected[0] - 1.0, found.1 / expected[1] - 1.0];
        // Seven digits are written.
        assert!(off.iter().all(|off| off.abs() < 1e-6), "{found:?} {off:?}");
    }
    order(&errors.map(|error| error.0));
    order(&errors.map(|error| error.1));
}

/// To the bit where they are numbers: as texts, zeros of different signs differ.
fn assert_same<S: PartialEq + Debug>(found: &S, expected: &S) {
    assert_eq!(found, expected);
    assert_eq!(format!("{found:?}"), format!("{expected:?}"));
}

fn element<G, const D: usize>(xi: &SVector<f64, D>) -> G
where
    G: LieGroup<Scalar = f64, Vector = SVector<f64, D>>,
    CayleyRetraction: Retraction<G>,
{
    <CayleyRetraction as Retraction<G>>::retract(xi)
}

/// Momentum maps, diamond and momentum equation are derivatives of the declared expression, the Jacobian is that of the
/// momentum equation, and the limit that of small steps.
fn check_derived<L, const D: usize>(l: &L, random: &mut Random)
where
    L: DiscreteLagrangian<
            Scalar = f64,
            Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>,
            Advected: Advected<<L as Term>::Group>,
        >,
    CayleyRetraction: Retraction<<L as Term>::Group>,
{
    let h = 0.05;
    let axis = |k: usize, s: f64| element::<L::Group, D>(&SVector::from_fn(|i, _| if i == k { s } else { 0.0 }));
    for _ in 0..5 {
        let (small, far): (SVector<f64, D>, SVector<f64, D>) = (random.sample(), random.sample());
        let (f, g) = (element::<L::Group, D>(&(small * 0.3)), element::<L::Group, D>(&far));
        let w = l.advected().seen_from(&g);
        let value = |f: &L::Group, w: &L::Advected| l.l_d(&f.matrix(), w, h);
        let of = |function: &dyn Fn(&L::Group) -> f64| {
            SVector::<f64, D>::from_fn(|k, _| derivative(|s| function(&axis(k, s))))
        };
        // e·w is what an observer turned by e⁻¹ sees.
        let moved = |e: &L::Group| w.seen_from(&e.inverse());
        let right = of(&|e| value(&e.compose(&f), &w));
        let left = of(&|e| value(&f.compose(e), &w));
        let diamond = -of(&|e| value(&f, &moved(e)));
        let momentum = of(&|e| value(&e.compose(&f), &moved(e)));
        let m = f.matrix();
        let scale = l.momentum_jacobian(&m, &w, h).norm();
        for (name, found, expected) in [
            ("right", l.right_momentum(&m, &w, h), right),
            ("left", l.left_momentum(&m, &w, h), left),
            ("diamond", l.diamond(&m, &w, h), diamond),
            ("(2.7)", l.legendre_minus(&m, &w, h), momentum),
        ] {
            assert!((found - expected).norm() < 1e-10 * scale, "{name}: {found} {expected}");
        }
        for j in 0..D {
            let column = SVector::<f64, D>::from_fn(|k, _| {
                derivative(|t| l.legendre_minus(&axis(j, t).compose(&f).matrix(), &w, h)[k])
            });
            assert!((l.momentum_jacobian(&m, &w, h).column(j) - column).norm() < 1e-10 * scale, "column {j}");
        }
        let energy = -derivative(|s| l.l_d(&m, &w, h * (1.0 + s))) / h;
        assert!((l.discrete_energy(&m, &w, h) - energy).abs() < 1e-9 * scale / h);
        let limit = |xi: &SVector<f64, D>| {
            let at = |h: f64| l.l_d(&element::<L::Group, D>(&(xi * h)).matrix(), &w, h) / h;
            // Potentials are at the ends of a step.
            (8.0 * at(2.5e-4) - 6.0 * at(5e-4) + at(1e-3)) / 3.0
        };
        let xi: SVector<f64, D> = random.sample();
        let expected = 0.5 * xi.dot(&(l.inertia(&w) * xi)) - l.potential(&w);
        assert!((limit(&xi) - expected).abs() < 1e-7, "{} {expected}", limit(&xi));
    }
    assert!(L::SELF_ADJOINT);
}

/// Where a solver of the continuous equations, which are those of the limit of `l_d`, comes from a start: attitude and
/// velocity after the time.
fn solved<L, const D: usize>(
    l: &L,
    (attitude, velocity): (L::Group, SVector<f64, D>),
    (time, steps): (f64, u32),
) -> (L::Group, SVector<f64, D>)
where
    L: ContinuousLagrangian<Scalar = f64, Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>> + Clone,
{
    let continuous = RightHandSide::new(l.clone()).unwrap();
    let momentum = l.momentum(&velocity, &l.advected().seen_from(&attitude));
    let mut state = continuous.state(&attitude, &momentum);
    runge_kutta::run(|y, rate| continuous.rate(y, rate).unwrap(), &mut state, time, steps);
    let (attitude, momentum) = continuous.parts(&state);
    let w = l.advected().seen_from(&attitude);
    (attitude, continuous.velocity(&momentum, &w).unwrap())
}

/// P1: a step keeps the symplectic form of attitudes and momenta, `ν·ξ' − ν'·ξ − ⟨μ, [ξ, ξ']⟩` for variations `δg = g ξ̂`
/// and `δμ = ν`, by differences of steps from places next to this one.
fn check_symplectic<L, const D: usize>(l: L, h: f64, attitude: L::Group, velocity: &SVector<f64, D>)
where
    L: Regular<Scalar = f64, Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>> + Clone,
    CayleyRetraction: Retraction<L::Group>,
{
    let stepper = Stepper::new(l, h).unwrap();
    let start = stepper.start(attitude, *velocity).unwrap();
    let stepped = |k: usize, s: f64| {
        let axis = |first: usize| SVector::from_fn(|i, _| if first + i == k { s } else { 0.0 });
        let (g, momentum) = (attitude.compose(&element::<L::Group, D>(&axis(0))), start.momentum() + axis(D));
        let mut state = stepper.start_with_momentum(g, momentum).unwrap();
        stepper.step(&mut state).unwrap();
        (state.attitude(), state.momentum())
    };
    let (end, momentum) = stepped(0, 0.0);
    let variation = |k: usize| {
        let turned = |s: f64| {
            let xi = CayleyRetraction::local_coordinates(&end.inverse().compose(&stepped(k, s).0));
            xi.unwrap()
        };
        [derivative(turned), derivative(|s| stepped(k, s).1)]
    };
    let form = |mu: &SVector<f64, D>, [xi, nu]: &[SVector<f64, D>; 2], [other, its]: &[SVector<f64, D>; 2]| {
        nu.dot(other) - its.dot(xi) - mu.dot(&L::Group::lie_bracket(xi, other))
    };
    let unit = |k: usize| [0, D].map(|first| SVector::from_fn(|i, _| f64::from(u8::from(first + i == k))));
    let ends: Vec<_> = (0..2 * D).map(variation).collect();
    let scale = ends.iter().flatten().map(nalgebra::Matrix::amax).fold(1.0, f64::max);
    let mut worst = 0.0_f64;
    for (j, first) in ends.iter().enumerate() {
        for (k, second) in ends.iter().enumerate() {
            let before = form(&start.momentum(), &unit(j), &unit(k));
            worst = worst.max((form(&momentum, first, second) - before).abs() / (scale * scale));
        }
    }
    println!("symplectic to {worst:.1e} of {scale:.1}");
    assert!(worst < 1e-11, "{worst:e}");
}

/// The means of each tenth of a hundred thousand numbers, and the largest of their sizes.
fn tenths(mut next: impl FnMut() -> f64) -> ([f64; 10], f64) {
    let mut most = 0.0_f64;
    let means = [(); 10].map(|()| {
        let mut sum = 0.0;
        for _ in 0..10_000 {
            let number = next();
            sum += number;
            most = most.max(number.abs());
        }
        sum / 10_000.0
    });
    (means, most)
}
