//! P1 with more digits than a double has: the maps are Poisson maps not to the order of some method or tolerance, but
//! beyond all doubt of rounding. The maps are those of this folder; a step of the library is compared with each, one of
//! collocation where its order is measured.

use nalgebra::{Matrix6, Vector3, Vector6};

use super::collocation::{self, Tableau};
use super::heavy_top::Top;
use super::motion::Motion;
use super::{DoubleDouble, Matrix, Vector, hat, long};
use checks::order::TOPS;
use declarations::{FourthOrderBody, FreeBody, HeavyTop, SixthOrderBody};
use liestep::methods::{CompositionScheme, ExactBody, Flow, KineticFlow, ProcessedScheme, SplittingScheme};
use liestep::motion::Plan;
use liestep::{SO3, Stepper};

/// Momentum and vertical.
type Phase = Vector6<DoubleDouble>;

fn phase(momentum: &Vector, w: &Vector) -> Phase {
    Phase::from_fn(|i, _| if i < 3 { momentum[i] } else { w[i - 3] })
}

/// `B = [[μ̂, ŵ], [ŵ, 0]]`
fn tensor(z: &Phase) -> Matrix6<DoubleDouble> {
    let (momentum, w) = (hat(&Vector3::new(z[0], z[1], z[2])), hat(&Vector3::new(z[3], z[4], z[5])));
    Matrix6::from_fn(|i, j| match (i < 3, j < 3) {
        (true, true) => momentum[(i, j)],
        (false, false) => long(0.0),
        _ => w[(i % 3, j % 3)],
    })
}

/// The largest entry of `DΦ B(z) DΦᵀ − B(Φ(z))`.
fn defect(map: impl Fn(&Phase) -> Phase, z: &Phase) -> f64 {
    // Of six points so far apart a smooth map leaves some 10⁻²⁶, by the seventh derivative and by rounding.
    let d = 1e-5;
    let column = |k: usize| {
        let at = |steps: f64| map(&Phase::from_fn(|i, _| if i == k { z[i] + long(steps) * long(d) } else { z[i] }));
        let odd = |steps: f64| at(steps) - at(-steps);
        (odd(1.0) * long(45.0) - odd(2.0) * long(9.0) + odd(3.0)).map(|change| change / (long(60.0) * long(d)))
    };
    let columns: Vec<_> = (0..6).map(column).collect();
    let tangent = Matrix6::from_columns(&columns);
    let defect = tangent * tensor(z) * tangent.transpose() - tensor(&map(z));
    defect.iter().map(|entry| entry.rounded().abs()).fold(0.0, f64::max)
}

/// A parameter off the orbit of the vertical is that of another top, whose vertical it is.
fn top_at(z: &Phase) -> Motion {
    let mut motion = Motion::read(TOPS[3]);
    let momentum = Vector3::new(z[0], z[1], z[2]);
    motion.velocity = motion.velocity_of(&momentum);
    motion.attitude = Matrix::identity();
    motion.up = Vector3::new(z[3], z[4], z[5]);
    motion
}

fn start() -> Phase {
    phase(&Vector3::new(2.0, -1.0, 1.5).map(long), &Vector3::new(0.6, 0.1, 0.8).map(long))
}

/// Of all steps here, s.
const H: f64 = 0.1;

/// What is done to a top, as a map of its momentum and vertical.
fn moved(z: &Phase, act: impl Fn(&mut Top<'_>)) -> Phase {
    let motion = top_at(z);
    let mut top = Top::at_start_of(&motion);
    act(&mut top);
    phase(&top.momentum, &top.w)
}

/// What is done to a top is a Poisson map, and a step of the library does just that.
fn assert_poisson<P, E>(
    name: &str,
    act: impl Fn(&mut Top<'_>),
    library: impl Fn(HeavyTop) -> Result<Stepper<HeavyTop, P>, E>,
) where
    P: Plan<HeavyTop>,
    E: core::fmt::Debug,
{
    let map = |z: &Phase| moved(z, &act);
    let defect = defect(map, &start());
    let [end, start] = [map(&start()), start()].map(|z| z.map(DoubleDouble::rounded));
    let [momentum, up] = [0, 3].map(|first| start.fixed_rows::<3>(first).into_owned());
    let stepper = library(HeavyTop { up, ..declarations::Motion::read(TOPS[3]).top }).unwrap();
    let mut state = stepper.start_with_momentum(SO3::identity(), momentum).unwrap();
    stepper.step(&mut state).unwrap();
    let found = Vector6::from_iterator(state.momentum().iter().chain(state.advected().iter()).copied());
    let apart = (found - end).norm();
    println!("{name}: {defect:.1e}, the library {apart:.1e} apart");
    assert!(defect < 1e-20, "{name}: {defect:e}");
    // Roundings of a step of numbers near one: five times what the longest of these has.
    assert!(apart < 1e-14, "{name}: {apart:e}");
}

/// Drift or kick, and the shares of the step and of the force gradient.
type Part = (Flow, f64, f64);

/// Parts of a step one by one, with the drift given.
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
            phase(&motion.moments.component_mul(&velocity), &(attitude.transpose() * motion.up))
        };
        let defect = defect(map, &start());
        println!("{stages} stages: {defect:.1e}");
        assert!(defect < 1e-20, "{stages} stages: {defect:e}");
    }
}

/// With the exact motion of an asymmetric body, all of them.
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

/// A splitting with a motion of the free body that isn't exact.
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

/// `κ(ξ)` of the kinetic energies of orders 4 and 6.
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

/// Out of the processor, a step of the kernel and back.
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
