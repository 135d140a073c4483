//! The cost of the derivatives of a heavy top's steps, in plain steps of the same method.
//!
//! The methods are (3.13), a splitting with force gradients and a processed one with outputs after each step, each for
//! a general body and for a symmetric one. The parameters are the three of the attitude and of the momentum at the
//! start, three moments, `m g` and three of the centre of mass, together with `up` and, for the exact flow, the turns
//! of its axes. An `adjoint` has a cost at the end of the run, `costs` has one at each step.

use core::hint::black_box;
use std::rc::Rc;

use liestep::gradients::{Cotangent, Linearisable, Tape};
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia};
use liestep::methods::{ExactBody, ProcessedScheme, SplittingScheme, SymmetricBody};
use liestep::{SO3, Stepper, lagrangian};
use nalgebra::{UnitQuaternion, Vector3};

use crate::kernel::{Effort, Failure, Group, Kernel};

/// (3.13) in principal axes.
#[lagrangian(
    group = SO3,
    advected(w = up),
    gradients,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * weight * w.dot(&(rho + F * rho)),
)]
#[derive(Clone)]
struct Top {
    J_d: DiagonalNonstandardInertia,
    weight: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

const NAMES: [&str; 7] = ["step", "transition", "columns", "adjoint", "costs", "checkpoints", "backwards"];
const EFFORT: Effort = Effort { batch: 1_000, rounds: 100, counted: 2_000 };

pub(crate) fn groups() -> Result<Vec<Group>, Failure> {
    let mut groups = Vec::new();
    for (kind, moments) in [("", Vector3::new(2.0, 3.0, 4.5)), ("symmetric ", Vector3::new(2.0, 2.0, 3.5))] {
        let J_d = DiagonalNonstandardInertia::from_principal_moments(moments)?;
        let top = Top { J_d, weight: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() };
        let inertia = Inertia::from_principal_moments(moments)?;
        let h = black_box(0.01);
        let (gradient, processed) = (SplittingScheme::FORCE_GRADIENT_5, ProcessedScheme::SIX_A);
        let [split, outputs] = ["gradient", "processed"].map(|way| format!("{kind}{way}"));
        if kind.is_empty() {
            let flow = ExactBody::new(&inertia);
            groups.push(group("(3.13)".to_owned(), Stepper::new(top.clone(), h)?));
            groups.push(group(split, Stepper::split(top.clone(), h, flow, gradient)?));
            groups.push(group(outputs, Stepper::processed(top, h, flow, processed)?));
        } else {
            let flow = SymmetricBody::new(&inertia)?;
            groups.push(group(split, Stepper::split(top.clone(), h, flow, gradient)?));
            groups.push(group(outputs, Stepper::processed(top, h, flow, processed)?));
        }
    }
    Ok(groups)
}

/// A method's steps, alone and with each kind of derivatives.
fn group<P: Linearisable<Top> + 'static>(name: String, stepper: Stepper<Top, P>) -> Group {
    let stepper = Rc::new(stepper);
    let kernel = |name: &'static str| {
        let stepper = Rc::clone(&stepper);
        Kernel::new(name, move || {
            let stepper = Rc::clone(&stepper);
            Ok(move |steps| {
                run(&stepper, name, u64::from(steps))?;
                Ok(0)
            })
        })
    };
    Group::new(name, EFFORT, NAMES.map(kernel))
}

fn run<P: Linearisable<Top>>(stepper: &Stepper<Top, P>, name: &str, steps: u64) -> Result<(), Failure> {
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let mut state = black_box(stepper.start(attitude, Vector3::new(0.5, 2.0, 6.0))?);
    let linear = stepper.linearised()?;
    let cost = |n: u64, _: &_| {
        if n == steps || name == "costs" {
            Cotangent { attitude: Vector3::x(), momentum: Vector3::z() }
        } else {
            Cotangent::zero()
        }
    };
    match name {
        "step" => {
            for _ in 0..steps {
                stepper.step(&mut state)?;
            }
        }
        "transition" | "columns" => {
            // The moments are those of the flow, if there is one, otherwise the diagonal; then weight and centre of
            // mass.
            let moments = linear.numbers(1, "moment").map_or(vec![0, 4, 8], Iterator::collect);
            let all: Vec<_> = moments.into_iter().chain(9..13).collect();
            let mut tangent = linear.tangent(if name == "columns" { &all } else { &[] });
            for _ in 0..steps {
                linear.step(&mut state, &mut tangent)?;
            }
            black_box(tangent);
        }
        "adjoint" | "costs" | "checkpoints" => {
            let tape = if name == "checkpoints" { Tape::SquareRoot } else { Tape::All };
            black_box(linear.adjoint(&mut state, steps, tape, cost)?);
        }
        _ => {
            black_box(linear.backwards()?.adjoint(&mut state, steps, cost)?);
        }
    }
    black_box(state);
    Ok(())
}
