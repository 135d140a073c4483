//! P1 with more digits than a double has: the maps are Poisson maps far below the order of any method and any rounding.
//! The maps are those of this folder; a step of the library is compared with each, one of collocation where its order
//! is measured.

use core::ops::Div;

use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign, SMatrix, SVector, Scalar, Vector3, Vector6};
use num_traits::{One, Zero};

use super::collocation::{self, Tableau};
use super::heavy_top::Top;
use super::motion::Motion;
use super::{DoubleDouble, Matrix, Vector, hat, long};
use checks::order::TOPS;
use declarations::{FourthOrderBody, FreeBody, HeavyTop, SixthOrderBody};
use liestep::methods::{CompositionScheme, ExactBody, Flow, KineticFlow, ProcessedScheme, SplittingScheme};
use liestep::motion::Plan;
use liestep::{SO3, Stepper};

/// The momentum and the vertical.
type Phase = Vector6<DoubleDouble>;

/// The momentum, the advected vector, and further variables.
pub(crate) fn phase<T: Digits, const N: usize>(momentum: &Vector3<T>, w: &Vector3<T>, rest: &[T]) -> SVector<T, N> {
    SVector::from_fn(|i, _| [momentum.as_slice(), w.as_slice(), rest].concat()[i])
}

/// A number of 16 or of 32 digits.
pub(crate) trait Digits:
    Scalar + Copy + From<f64> + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign + Div<Output = Self>
{
}

impl Digits for f64 {}
impl Digits for DoubleDouble {}

/// The tensor `B = [[μ̂, ŵ], [ŵ, 0]]`, with `{t, −E_0} = 1` if time and energy follow.
fn tensor<T: Digits, const N: usize>(z: &SVector<T, N>) -> SMatrix<T, N, N> {
    let [momentum, w] = [0, 3].map(|at| hat(&Vector3::new(z[at], z[at + 1], z[at + 2])));
    SMatrix::from_fn(|i, j| match (i / 3, j / 3) {
        (0, 0) => momentum[(i, j)],
        (0, 1) | (1, 0) => w[(i % 3, j % 3)],
        _ if (i, j) == (6, 7) => T::zero() - T::one(),
        _ if (i, j) == (7, 6) => T::one(),
        _ => T::zero(),
    })
}

/// The distance of points for 32 digits: the error is some 10⁻²⁷ for functions that are smooth on the scale of one.
pub(crate) const APART: f64 = 1e-4;

/// The derivative at zero by ten points at this distance; its error is of the eleventh derivative.
pub(crate) fn derivative<T: Digits, const N: usize>(f: impl Fn(T) -> SVector<T, N>, apart: f64) -> SVector<T, N> {
    let odd = |(k, weight): (f64, f64)| {
        let at = T::from(k) * T::from(apart);
        (f(at) - f(T::zero() - at)) * T::from(weight)
    };
    let all = [(1.0, 2100.0), (2.0, -600.0), (3.0, 150.0), (4.0, -25.0), (5.0, 2.0)].map(odd);
    let sum = all.into_iter().fold(SVector::<T, N>::zeros(), |sum, one| sum + one);
    sum.map(|change| change / (T::from(2520.0) * T::from(apart)))
}

/// The defect `DΦ B(z) DΦᵀ − B(Φ(z))`, with [derivatives](derivative) by points at this distance.
pub(crate) fn defect<T: Digits, const N: usize>(
    map: impl Fn(&SVector<T, N>) -> SVector<T, N>,
    z: &SVector<T, N>,
    apart: f64,
) -> SMatrix<T, N, N> {
    let unit = |k: usize| SVector::<T, N>::from_fn(|i, _| if i == k { T::one() } else { T::zero() });
    let columns: [_; N] = core::array::from_fn(|k| derivative(|t| map(&(z + unit(k) * t)), apart));
    let tangent = SMatrix::<T, N, N>::from_columns(&columns);
    tangent * tensor(z) * tangent.transpose() - tensor(&map(z))
}

/// The top of these variables. A parameter off the orbit of the vertical is the vertical of another top.
fn top_at(z: &Phase) -> Motion {
    let mut motion = Motion::read(TOPS[3]);
    let momentum = Vector3::new(z[0], z[1], z[2]);
    motion.velocity = motion.velocity_of(&momentum);
    motion.attitude = Matrix::identity();
    motion.up = Vector3::new(z[3], z[4], z[5]);
    motion
}

fn start() -> Phase {
    phase(&Vector3::new(2.0, -1.0, 1.5).map(long), &Vector3::new(0.6, 0.1, 0.8).map(long), &[])
}

/// The length of all steps here, s.
const H: f64 = 0.1;

/// An operation on a top as a map of its momentum and vertical.
fn moved(z: &Phase, act: impl Fn(&mut Top<'_>)) -> Phase {
    let motion = top_at(z);
    let mut top = Top::at_start_of(&motion);
    act(&mut top);
    phase(&top.momentum, &top.w, &[])
}

/// Checks that an operation on a top is a Poisson map, and that a step of the library agrees with it.
fn assert_poisson<P, E>(
    name: &str,
    act: impl Fn(&mut Top<'_>),
    library: impl Fn(HeavyTop) -> Result<Stepper<HeavyTop, P>, E>,
) where
    P: Plan<HeavyTop>,
    E: core::fmt::Debug,
{
    let map = |z: &Phase| moved(z, &act);
    let defect = defect(map, &start(), APART).map(DoubleDouble::rounded).amax();
    let [end, start] = [map(&start()), start()].map(|z| z.map(DoubleDouble::rounded));
    let [momentum, up] = [0, 3].map(|first| start.fixed_rows::<3>(first).into_owned());
    let stepper = library(HeavyTop { up, ..declarations::Motion::read(TOPS[3]).top }).unwrap();
    let mut state = stepper.start_with_momentum(SO3::identity(), momentum).unwrap();
    stepper.step(&mut state).unwrap();
    let found = Vector6::from_iterator(state.momentum().iter().chain(state.advected().iter()).copied());
    let apart = (found - end).norm();
    println!("{name}: {defect:.1e}, the library {apart:.1e} apart");
    assert!(defect < 1e-20, "{name}: {defect:e}");
    // The bound is the rounding of a step of numbers near one: five times the largest error.
    assert!(apart < 1e-14, "{name}: {apart:e}");
}

/// A drift or a kick, with its shares of the step and of the force gradient.
type Part = (Flow, f64, f64);

/// Applies the parts of a step one by one, with this drift.
fn make<'a>(parts: impl IntoIterator<Item = Part>, top: &mut Top<'a>, drift: impl Fn(&mut Top<'a>, DoubleDouble)) {
    for (flow, share, gradient) in parts {
        match flow {
            Flow::Drift => drift(top, long(H) * long(share)),
            Flow::Kick => top.kick_with_gradient(long(H) * long(share), long(H) * long(H) * long(H) * long(gradient)),
        }
    }
}

fn parts(scheme: SplittingScheme) -> impl Iterator<Item = Part> {
    scheme.shares().zip(scheme.gradients()).map(|((flow, share), gradient)| (flow, share, gradient))
}

#[test]
fn p1_the_step_and_its_compositions_are_poisson_maps_to_twenty_digits() {
    assert_poisson("(3.13)", |top| top.step(long(H)), |top| Stepper::new(top, H));
    for scheme in CompositionScheme::ALL {
        let act = |top: &mut Top<'_>| scheme.stages().for_each(|share| top.step(long(H) * long(share)));
        assert_poisson(scheme.name(), act, |top| Stepper::composed(top, H, scheme));
    }
}

#[test]
fn p1_collocation_is_a_poisson_map_to_twenty_digits() {
    for stages in [2, 4, 6, 8] {
        let tableau = Tableau::new(stages);
        let map = |z: &Phase| {
            let motion = top_at(z);
            let (attitude, velocity) = collocation::end(&tableau, &motion, long(H), 1);
            phase(&motion.moments.component_mul(&velocity), &(attitude.transpose() * motion.up), &[])
        };
        let defect = defect(map, &start(), APART).map(DoubleDouble::rounded).amax();
        println!("{stages} stages: {defect:.1e}");
        assert!(defect < 1e-20, "{stages} stages: {defect:e}");
    }
}

/// All splittings with the exact motion of an asymmetric body.
#[test]
fn p1_splittings_are_poisson_maps_to_twenty_digits() {
    for scheme in SplittingScheme::ALL {
        let act = |top: &mut Top<'_>| make(parts(scheme), top, Top::drift_by_series);
        assert_poisson(scheme.name(), act, |top| {
            let body = ExactBody::new(&top.ordinary_inertia());
            Stepper::split(top, H, body, scheme)
        });
    }
}

/// Checks a splitting whose motion of the free body isn't exact.
fn assert_poisson_with<K: KineticFlow<f64>>(
    name: &str,
    drift: impl Fn(&mut Top<'_>, DoubleDouble),
    flow: impl Fn(&HeavyTop) -> K,
) {
    let scheme = SplittingScheme::FORCE_GRADIENT_4;
    let act = |top: &mut Top<'_>| make(parts(scheme), top, &drift);
    assert_poisson(name, act, |top| {
        let flow = flow(&top);
        Stepper::split(top, H, flow, scheme)
    });
}

#[test]
fn p1_splittings_with_declared_flows_are_poisson_maps_to_twenty_digits() {
    let own = |top: &mut Top<'_>, h| top.drift_of_the_step(h);
    assert_poisson_with("(3.13)", own, |top| FreeBody { J_d: top.J_d.into() });
    let fourth = |top: &mut Top<'_>, h| top.drift_of_polynomial(h, |j, xi| polynomial(j, xi, 4));
    assert_poisson_with("K4", fourth, |top| FourthOrderBody { J: top.ordinary_inertia() });
    let sixth = |top: &mut Top<'_>, h| top.drift_of_polynomial(h, |j, xi| polynomial(j, xi, 6));
    assert_poisson_with("K6", sixth, |top| SixthOrderBody { J: top.ordinary_inertia() });
}

/// The kinetic energies `κ(ξ)` of orders 4 and 6.
fn polynomial(moments: &Vector, xi: &Vector, order: u32) -> DoubleDouble {
    let momentum = moments.component_mul(xi);
    let divided = |v: &Vector| v.zip_map(moments, |component, moment| component / moment);
    let a = divided(&momentum.cross(xi));
    let of = |v: &Vector| v.dot(&moments.component_mul(v));
    let fourth = of(xi) / long(2.0) - of(&a) / long(24.0);
    if order == 4 {
        return fourth;
    }
    let c = a.cross(xi);
    let b = moments.component_mul(&a).cross(xi) + momentum.cross(&a) + moments.component_mul(&c);
    fourth + (of(&c) + momentum.dot(&a.cross(&c))) / long(240.0) - of(&divided(&b)) / long(1440.0)
}

/// The inverse processor, a step of the kernel and the processor.
#[test]
fn p1_processed_splittings_are_poisson_maps_to_twenty_digits() {
    for scheme in ProcessedScheme::ALL {
        let out: Vec<Part> = scheme.processor().collect();
        let back = out.iter().rev().map(|&(flow, share, gradient)| (flow, -share, -gradient));
        let all: Vec<Part> = back.chain(parts(scheme.kernel())).chain(out.iter().copied()).collect();
        let act = |top: &mut Top<'_>| make(all.iter().copied(), top, Top::drift_by_series);
        assert_poisson(scheme.name(), act, |top| {
            let body = ExactBody::new(&top.ordinary_inertia());
            Stepper::processed(top, H, body, scheme)
        });
    }
}
