//! P1 with more digits than a double has: the maps are Poisson maps not to the order of some method or tolerance, but
//! beyond all doubt of rounding. The maps are those of this folder; that the library's are the same is seen where their
//! orders are measured.

use nalgebra::{Matrix6, Vector3, Vector6};

use super::collocation::{self, Tableau};
use super::heavy_top::Top;
use super::motion::Motion;
use super::{DoubleDouble, Matrix, Vector, coefficients, hat, long};
use crate::convergence::TOPS;
use liestep::methods::{CompositionScheme, ExactBody, Flow, ProcessedScheme};
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

#[test]
fn p1_the_step_is_a_poisson_map_to_twenty_digits() {
    let gammas = coefficients::refined(&CompositionScheme::KAHAN_LI_8);
    for (name, shares) in [("(3.13)", vec![long(1.0)]), ("Kahan-Li 8", gammas)] {
        let map = |z: &Phase| {
            let motion = top_at(z);
            let mut top = Top::at_start_of(&motion);
            for share in &shares {
                top.step(*share * long(0.1));
            }
            phase(&top.momentum, &top.w)
        };
        let defect = defect(map, &start());
        println!("{name}: {defect:.1e}");
        assert!(defect < 1e-20, "{name}: {defect:e}");
    }
}

#[test]
fn p1_collocation_is_a_poisson_map_to_twenty_digits() {
    for stages in [2, 4, 6, 8] {
        let tableau = Tableau::new(stages);
        let map = |z: &Phase| {
            let motion = top_at(z);
            let (attitude, velocity) = collocation::end(&tableau, &motion, long(0.1), 1);
            phase(&motion.moments.component_mul(&velocity), &(attitude.transpose() * motion.up))
        };
        let defect = defect(map, &start());
        println!("{stages} stages: {defect:.1e}");
        assert!(defect < 1e-20, "{stages} stages: {defect:e}");
    }
}

/// Out of the processor, a step of the kernel and back: its shares one by one.
fn process(scheme: &ProcessedScheme, h: DoubleDouble, top: &mut Top) {
    let mut make = |(flow, share, gradient): (Flow, f64, f64)| match flow {
        Flow::Drift => top.drift_by_series(h * long(share)),
        Flow::Kick => top.kick_with_gradient(h * long(share), h * h * h * long(gradient)),
    };
    let out: Vec<_> = scheme.processor().collect();
    out.iter().rev().for_each(|&(flow, share, gradient)| make((flow, -share, -gradient)));
    let kernel = scheme.kernel();
    kernel.shares().zip(kernel.gradients()).for_each(|((flow, share), gradient)| make((flow, share, gradient)));
    out.into_iter().for_each(make);
}

/// With the exact drift of an asymmetric body; and the library's step is that map.
#[test]
fn p1_processed_splittings_are_poisson_maps_to_twenty_digits() {
    for scheme in ProcessedScheme::ALL {
        let map = |z: &Phase| {
            let motion = top_at(z);
            let mut top = Top::at_start_of(&motion);
            process(&scheme, long(0.1), &mut top);
            phase(&top.momentum, &top.w)
        };
        let defect = defect(map, &start());
        println!("{}: {defect:.1e}", scheme.name());
        assert!(defect < 1e-20, "{}: {defect:e}", scheme.name());

        let end = map(&start()).map(DoubleDouble::rounded);
        let start = start().map(DoubleDouble::rounded);
        let top = declarations::Motion::read(TOPS[3]).top;
        let top = declarations::HeavyTop { up: start.fixed_rows::<3>(3).into_owned(), ..top };
        let flow = ExactBody::new(&top.ordinary_inertia());
        let stepper = Stepper::processed(top, 0.1, flow, scheme).unwrap();
        let mut state = stepper.start_with_momentum(SO3::identity(), start.fixed_rows::<3>(0).into_owned()).unwrap();
        stepper.step(&mut state).unwrap();
        let found = Vector6::from_iterator(state.momentum().iter().chain(state.advected().iter()).copied());
        assert!((found - end).norm() < 1e-14, "{}: {:e}", scheme.name(), (found - end).norm());
    }
}
