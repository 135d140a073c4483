//! Bodies with joints: chains compared with the minimal form, a closed loop with Newton's and Euler's equations, a
//! pendulum on a pin with its recursion, and all of them with the principle that joints do no work; invariants and
//! errors.

mod chains;
mod driven;
mod friction;
mod kinds;
mod loops;

use core::array::from_fn;

use declarations::motions::number;
use declarations::{FallingBody, Strut};
use liestep::groups::{Advected as _, CayleyRetraction, LieGroup as _, R3, Retraction};
use liestep::laws::samples::derivative;
use liestep::mechanics::{DiscreteLagrangian, Each, Placement};
use liestep::methods::{Constraint, Joint, Multibody, MultibodyStepper, Place};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError};
use nalgebra::{DMatrix, DVector, Vector3, Vector6};
use serde_json::Value;

use super::{Body, six};

type Scene<const N: usize> = Placement<Each<N>, FallingBody, N>;

type Components<const N: usize> = [Vector6<f64>; N];

const EPSILON: f64 = f64::EPSILON;

/// The mass and the inertia of a body.
#[derive(Clone, Copy, Debug)]
struct MassAndInertia {
    m: f64,
    K: NonstandardInertia,
}

fn falling<const N: usize>(bodies: [MassAndInertia; N], g: f64, up: Vector3<f64>) -> [FallingBody; N] {
    bodies.map(|MassAndInertia { m, K }| FallingBody { m, J_d: K, g, up })
}

/// A joint between two bodies, or between space and a body.
#[derive(Clone, Copy, Debug)]
struct Connection<C> {
    joint: C,
    above: Option<usize>,
    below: usize,
}

impl<C> Connection<C> {
    const fn between(joint: C, above: usize, below: usize) -> Self {
        Self { joint, above: Some(above), below }
    }

    const fn to_space(joint: C, below: usize) -> Self {
        Self { joint, above: None, below }
    }
}

/// A joint that is added to a system.
trait JointOfTests: Copy {
    fn join(self, system: &mut Multibody, above: Option<usize>, below: usize);

    /// The functions, and zeros after them.
    fn gaps(&self, above: &Place, below: &Place) -> Vector6<f64>;
}

macro_rules! joins {
    ($($joint:ty: $functions:literal),+) => {$(
        impl JointOfTests for $joint {
            fn join(self, system: &mut Multibody, above: Option<usize>, below: usize) {
                system.join(self, above, below);
            }

            fn gaps(&self, above: &Place, below: &Place) -> Vector6<f64> {
                let gap = <Self as Constraint<$functions>>::gap(self, above, below);
                Vector6::from_fn(|row, _| gap.get(row).copied().unwrap_or(0.0))
            }
        }
    )+};
}

joins!(Joint: 6, Strut: 1);

/// A stepper of falling bodies in joints, and the bodies without them.
#[derive(Clone, Debug)]
struct Linkage<const N: usize> {
    bodies: [FallingBody; N],
    stepper: MultibodyStepper,
}

impl<const N: usize> core::ops::Deref for Linkage<N> {
    type Target = MultibodyStepper;

    fn deref(&self) -> &MultibodyStepper {
        &self.stepper
    }
}

impl<const N: usize> Linkage<N> {
    fn scene(&self) -> Scene<N> {
        Each::<N>::of(self.bodies)
    }

    fn attitudes(&self, state: &[f64]) -> [Body; N] {
        from_fn(|body| self.attitude(state, body))
    }

    fn turns(&self, state: &[f64]) -> [SO3; N] {
        self.attitudes(state).map(|body| body.0)
    }

    fn momenta(&self, state: &[f64]) -> Components<N> {
        from_fn(|body| self.momentum(state, body))
    }

    fn velocities(&self, state: &[f64]) -> Components<N> {
        from_fn(|body| self.velocity(state, body))
    }

    /// The momentum of all bodies, and their angular momentum about the origin.
    fn whole(&self, state: &[f64]) -> [Vector3<f64>; 2] {
        super::whole(&self.attitudes(state), &Bodies(self.momenta(state)))
    }

    /// Attitudes and momenta, for the check of the joints' work.
    fn motion(&self, state: &[f64]) -> ([Body; N], Components<N>) {
        (self.attitudes(state), self.momenta(state))
    }
}

/// The system of these bodies and joints.
fn system<C: JointOfTests, const N: usize>(bodies: [FallingBody; N], joints: &[Connection<C>]) -> Multibody {
    let mut system = Multibody::new();
    for body in bodies {
        system.body(body);
    }
    for &Connection { joint, above, below } in joints {
        joint.join(&mut system, above, below);
    }
    system
}

fn jointed<C: JointOfTests, const N: usize>(
    bodies: [FallingBody; N],
    joints: &[Connection<C>],
    h: f64,
) -> Result<Linkage<N>, SetupError> {
    system(bodies, joints).stepper(h).map(|stepper| Linkage { bodies, stepper })
}

/// The ends of a rod of one metre, from its centre.
const LEFT: Vector3<f64> = Vector3::new(-0.5, 0.0, 0.0);
const RIGHT: Vector3<f64> = Vector3::new(0.5, 0.0, 0.0);

fn rod(m: f64) -> MassAndInertia {
    MassAndInertia { m, K: NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.1) * m).unwrap() }
}

fn ball(above: Vector3<f64>, below: Vector3<f64>) -> Joint {
    Joint::ball([above, below])
}

/// Rods one after the other, the first from the origin.
fn chained<const N: usize>() -> [Connection<Joint>; N] {
    from_fn(|k| match k {
        0 => Connection::to_space(ball(Vector3::zeros(), LEFT), 0),
        _ => Connection::between(ball(RIGHT, LEFT), k - 1, k),
    })
}

/// Makes steps; returns the largest distance of the energy from this one, J, and the widest gap of a joint, m.
fn watched(stepper: &MultibodyStepper, state: &mut [f64], energy: f64, steps: u32) -> [f64; 2] {
    (0..steps).fold([0.0_f64; 2], |[off, gap], _| {
        stepper.step(state).unwrap();
        [off.max((stepper.energy(state) - energy).abs()), gap.max(stepper.widest_gap(state))]
    })
}

fn place(body: &Body) -> Place {
    Place { attitude: *body.0.as_matrix(), position: body.1.translation() }
}

/// Links of one metre in a row from the origin, each tilted about the y axis by its angle, and the end of the last.
fn row<const N: usize>(tilts: [f64; N]) -> ([Body; N], Vector3<f64>) {
    let mut corner = Vector3::zeros();
    let places = tilts.map(|tilt| {
        let attitude = SO3::exp(Vector3::y() * tilt);
        let along = attitude.as_matrix() * Vector3::x();
        corner += along;
        (attitude, R3::from(corner - along * 0.5))
    });
    (places, corner)
}

fn plain(value: &Value) -> Vector3<f64> {
    Vector3::from_fn(|k, _| number(&value[k]))
}

/// The configuration turned or shifted along one of six axes: turned in its own axes, shifted in those of space.
fn moved(body: &Body, k: usize, s: f64) -> Body {
    let axis = Vector3::ith(k % 3, s);
    if k < 3 {
        (body.0.compose(&<CayleyRetraction as Retraction<SO3>>::retract(&axis)), body.1)
    } else {
        (body.0, R3::from(body.1.translation() + axis))
    }
}

/// The part of an impulse on bodies in this configuration that isn't in the span of the joints' slopes, by differences
/// of the constraints: it does work on motions that leave the joints closed.
fn working<C: JointOfTests, const N: usize>(
    joints: &[Connection<C>],
    bodies: &[Body; N],
    impulse: &Components<N>,
) -> f64 {
    const K: usize = 6;
    let gap = |joined: &Connection<C>, bodies: &[Body; N]| {
        let above = joined.above.map_or(Place::SPACE, |above| place(&bodies[above]));
        joined.joint.gaps(&above, &place(&bodies[joined.below]))
    };
    let mut slopes = DMatrix::zeros(6 * N, K * joints.len());
    for ((j, joined), k) in joints.iter().enumerate().flat_map(|joint| (0..6 * N).map(move |k| (joint, k))) {
        for row in 0..K {
            slopes[(k, K * j + row)] = derivative(|s| {
                let mut changed = *bodies;
                changed[k / 6] = moved(&bodies[k / 6], k % 6, s);
                gap(joined, &changed)[row]
            });
        }
    }
    let impulse = DVector::from_fn(6 * N, |k, _| impulse[k / 6][k % 6]);
    let multipliers = slopes.clone().svd(true, true).solve(&impulse, 1e-9).unwrap();
    (impulse - slopes * multipliers).amax()
}

/// Checks D'Alembert's principle: the joints' impulses before and after a step do no work on motions that leave the
/// joints closed. Half of the step's force is applied at either end.
fn assert_no_work<S, C: JointOfTests, const N: usize>(
    (l, h): (&S, f64),
    joints: &[Connection<C>],
    given: &Components<N>,
    [(start, before), (end, after)]: [([Body; N], Components<N>); 2],
) where
    S: DiscreteLagrangian<Scalar = f64, Group = [Body; N]>,
{
    let f: [Body; N] = from_fn(|k| start[k].inverse().compose(&end[k]));
    let (w, f) = (l.advected().seen_from(&start), f.matrix());
    let half = Bodies(*given) * (0.5 * h);
    let taken = (Bodies(before) + half - l.legendre_minus(&f, &w, h)).0;
    let left = (l.legendre_plus(&f, &w, h) + half - Bodies(after)).0;
    let size = taken.iter().map(Vector6::amax).fold(0.0, f64::max);
    let work = [working(joints, &start, &taken), working(joints, &end, &left)];
    println!("of {size:.1e} these work: {work:?}");
    assert!(size > 1e-3 && work.iter().all(|&work| work < 1e-9 * size.max(1.0)), "{work:?} of {size}");
}
