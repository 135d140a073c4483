//! The system of a file: its bodies, springs and joints.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

use liestep::effects::joints::{
    Armature, DryFriction, JointDamping, JointSpring, JointTorque, SliderArmature, SliderDamping, SliderFriction,
    SliderSpring,
};
use liestep::effects::{Rotor, Torque};
use liestep::groups::R3;
use liestep::mechanics::Inertia;
use liestep::methods::{Multibody, MultibodyStepper, Redundancy};
use liestep::motion::{Cost, Layout, Propagator, StepReport};
use liestep::with::Scheme;
use liestep::{NonstandardInertia, SO3, SetupError, StepError, lagrangian};
use nalgebra::{Vector3, Vector6};

use crate::file::body::Kinetic;
use crate::file::control::locked;
use crate::file::joint::{Joint, Number};
use crate::file::joint_kind::Kind;
use crate::file::orbit::Time;
use crate::file::part::{Between, SystemBody};
use crate::file::scene_file::SceneFile;
use crate::file::system::{Spring, System};
use crate::run::mechanism::{BodyInput, Mechanism};
use crate::run::nearest::BodyState;

/// A body with its weight. One of the three kinetic terms has the factor one, the others zero.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space)),
    l_d = {
        let xi = log(F);
        let tangent = vee(F - F.transpose()) / (1.0 + F.trace());
        (rigid * ((F - I) * J_d * (F - I).transpose()).trace()
            + geodesic * xi.dot(&(J * xi))
            + cayley * 4.0 * tangent.dot(&(J * tangent))
            + m * d.norm_squared()) / (2.0 * h)
            - 0.5 * h * m * g * (x + x + d).dot(&up)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeavyBody {
    /// Moment of inertia about the centre of mass, kg m².
    pub(crate) J: Inertia,
    pub(crate) J_d: NonstandardInertia,
    pub(crate) rigid: f64,
    pub(crate) geodesic: f64,
    pub(crate) cayley: f64,
    /// Mass, kg.
    pub(crate) m: f64,
    /// Acceleration of gravity, m/s².
    pub(crate) g: f64,
    pub(crate) up: Vector3<f64>,
}

/// A point mass with its weight.
#[lagrangian(
    group(d = R3),
    advected(x = d.seen_from(space)),
    l_d = m * d.norm_squared() / (2.0 * h) - 0.5 * h * m * g * (x + x + d).dot(&up),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeavyPoint {
    /// Mass, kg.
    m: f64,
    /// Acceleration of gravity, m/s².
    g: f64,
    up: Vector3<f64>,
}

/// A spring between a point of one body and a point of another, which mustn't meet.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = -0.25 * h * k * (((r + R_2 * at_2 - R_1 * at_1).norm() - length).powi(2)
        + ((r + d_2 - d_1 + R_2 * F_2 * at_2 - R_1 * F_1 * at_1).norm() - length).powi(2)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coil {
    /// Stiffness, N/m.
    k: f64,
    /// Length at rest, m.
    length: f64,
    /// The ends, from the centres of mass in the frames of the bodies, m.
    at_1: Vector3<f64>,
    at_2: Vector3<f64>,
}

/// A spring whose length at rest is zero: its ends may meet.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = -0.25 * h * k * ((r + R_2 * at_2 - R_1 * at_1).norm_squared()
        + (r + d_2 - d_1 + R_2 * F_2 * at_2 - R_1 * F_1 * at_1).norm_squared()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cord {
    /// Stiffness, N/m.
    k: f64,
    /// The ends, from the centres of mass in the frames of the bodies, m.
    at_1: Vector3<f64>,
    at_2: Vector3<f64>,
}

/// The pull of a mass far away on a body beside the one whose orbit a frame follows: the energy
/// `m k (|n|² |x|² − 3 (n·x)²) / 2`, with `n` towards the mass.
#[lagrangian(
    group(d = R3),
    advected(x = d.seen_from(space)),
    l_d = -0.25 * h * m * k * (n.norm_squared() * (x.norm_squared() + (x + d).norm_squared())
        - 3.0 * (n.dot(&x).powi(2) + n.dot(&(x + d)).powi(2))),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tide {
    /// Mass, kg.
    m: f64,
    /// Square of a rate, rad²/s².
    k: f64,
    n: Vector3<f64>,
}

impl System {
    /// The bodies with their joints and springs.
    fn parts(&self) -> Multibody {
        let (g, up) = self.gravity.unwrap_or((0.0, Vector3::z()));
        let mut system = Multibody::new();
        for body in &self.bodies {
            let is = |kinetic| f64::from(u8::from(body.kinetic == kinetic));
            let [rigid, geodesic, cayley] = [Kinetic::Rigid, Kinetic::Geodesic, Kinetic::Cayley].map(is);
            let m = body.m;
            match body.J {
                None => system.body(HeavyPoint { m, g, up }),
                Some(J) => system.body(HeavyBody { J, J_d: J.to_nonstandard(), rigid, geodesic, cayley, m, g, up }),
            };
        }
        for &Between { bodies, of: Spring { k, length, at: [at_1, at_2] } } in &self.springs {
            if length == 0.0 {
                system.between(bodies, Cord { k, at_1, at_2 });
            } else {
                system.between(bodies, Coil { k, length, at_1, at_2 });
            }
        }
        for &Between { bodies: [above, below], of: joint } in &self.joints {
            let below = below.unwrap_or_default();
            system.join(joint.constraint(), above, below);
            add_terms(&mut system, [above, Some(below)], &joint);
        }
        system
    }

    /// Adds what acts on the bodies of a file at a time, with what is held.
    fn act(
        &self,
        file: &SceneFile,
        system: &mut Multibody,
        now: Time<'_>,
        held: &[BodyInput],
    ) -> Result<(), SetupError> {
        for (number, body) in self.bodies.iter().enumerate() {
            let J = match &body.J {
                Some(J) => locked(J, &file.wheel, number),
                None => {
                    Inertia::from_principal_moments(Vector3::repeat(1.0)).map_err(|_| SetupError::NonFiniteConstant)?
                }
            };
            if let Some(J) = &body.J {
                body.effects.iter().for_each(|(_, effect)| effect.act_on(J, system, (number, now)));
            }
            if let Some(gradient) = file.gravity_gradient {
                let turning = gradient.effect(&J, now);
                system.on(number, Tide { m: body.m, k: turning.GM / turning.r.powi(3), n: turning.direction });
                if body.J.is_some() {
                    system.on(number, turning);
                }
            }
            let BodyInput { spin, torque } = held.get(number).copied().unwrap_or_default();
            if spin != Vector3::zeros() {
                system.on(number, Rotor { spin });
            }
            if torque != Vector3::zeros() {
                system.on(number, Torque { torque });
            }
        }
        Ok(())
    }

    /// The stepper of a file by a method and a step, s, and the functions of joints that are left out.
    pub(crate) fn multibody(
        &self,
        file: &SceneFile,
        method: Scheme,
        step: f64,
    ) -> Result<(MultibodyStepper, Vec<Redundancy>), SetupError> {
        let places: Vec<_> = self.given().into_iter().map(|(place, _)| place).collect();
        let (mut system, left_out) = self.parts().independent(&places)?;
        self.act(file, &mut system, file.at(0.0), &[])?;
        let stepper = system.stepper(step)?;
        let stepper = if let Scheme::Composition(scheme) = method { stepper.composed(scheme)? } else { stepper };
        Ok((stepper, left_out))
    }

    /// The file's initial configurations and velocities.
    fn given(&self) -> Vec<BodyState> {
        let of = |body: &SystemBody| {
            let (turn, shift) = (body.start.velocity, body.moving);
            let velocity = Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z);
            ((SO3::from(body.start.attitude), R3::from(body.position)), velocity)
        };
        self.bodies.iter().map(of).collect()
    }

    /// The initial state of the file. With `is_nearest`, it is the nearest state that satisfies the constraints.
    pub(crate) fn start(&self, stepper: &MultibodyStepper, is_nearest: bool) -> Result<Box<[f64]>, SetupError> {
        let (bodies, velocities): (Vec<_>, Vec<_>) = self.given().into_iter().unzip();
        let started = stepper.start(&bodies, &velocities);
        if !is_nearest {
            return started;
        }
        if started.is_ok() {
            return stepper.start_nearest(&bodies, &velocities);
        }
        let (bodies, velocities): (Vec<_>, Vec<_>) = self.shifted(self.given()).into_iter().unzip();
        stepper.start_nearest(&bodies, &velocities)
    }
}

/// Adds the springs, the friction, the motor and its rotor of a joint.
fn add_terms(system: &mut Multibody, bodies: [Option<usize>; 2], joint: &Joint) {
    let (Joint { kind, at, axes, .. }, of) = (*joint, |number| joint.number(number));
    let (rest, friction) = (of(Number::Rest).unwrap_or(0.0), of(Number::Friction).zip(of(Number::Below)));
    if kind == Kind::Slider {
        let axis = axes[0];
        if joint.has(&[Number::Stiffness, Number::Effort]) {
            // The shift is between the points of both bodies, that of the term from the first body's centre.
            let (k, force) = (of(Number::Stiffness).unwrap_or(0.0), of(Number::Effort).unwrap_or(0.0));
            system.between(bodies, SliderSpring { k, rest: rest + axis.dot(&at[0]), force, axis, at_2: at[1] });
        }
        if let Some(c) = of(Number::Damping) {
            system.between(bodies, SliderDamping { c, axis, at_2: at[1] });
        }
        if let Some((force, speed)) = friction {
            system.between(bodies, SliderFriction { force, speed, axis, at_2: at[1] });
        }
        if let Some(a) = of(Number::Armature) {
            system.between(bodies, SliderArmature { a, axis, at_2: at[1] });
        }
        return;
    }
    if let Some(k) = of(Number::Stiffness) {
        system.between(bodies, JointSpring { k, rest: joint.attitude_at(rest) });
    }
    if let Some(torque) = of(Number::Effort) {
        let [axis_1, axis_2] = [axes[0], joint.zero.tr_mul(&axes[0])];
        system.between(bodies, JointTorque { torque, axis_1, axis_2 });
    }
    if let Some(c) = of(Number::Damping) {
        system.between(bodies, JointDamping { c });
    }
    if let Some((torque, rate)) = friction {
        system.between(bodies, DryFriction { torque, rate });
    }
    if let Some(a) = of(Number::Armature) {
        system.between(bodies, Armature { a });
    }
}

/// Several bodies with laws and wheels, along an orbit, or with values over time.
pub(crate) struct Bodies {
    /// The file, whose values over time are those of the last step.
    file: RefCell<SceneFile>,
    /// The bodies with joints and springs; none where these, gravity or inertias change with time.
    parts: Option<Multibody>,
    /// The stepper at the time zero, whose joints are those of all.
    first: MultibodyStepper,
    /// The last stepper, with its time and what was held.
    last: RefCell<Option<LastStepper>>,
}

/// A stepper with its span of time, s, and what is held in it.
type LastStepper = ([f64; 2], Vec<BodyInput>, Rc<MultibodyStepper>);

impl Bodies {
    /// The bodies of a file, with steps of `h`, s.
    pub(crate) fn new(file: &SceneFile, system: &Arc<System>, h: f64) -> Result<Self, SetupError> {
        let (first, _) = system.multibody(file, Scheme::Step, h)?;
        let is_constant = !file.over_time.iter().any(|one| match one.table.as_str() {
            "body" => SystemBody::is_inertial(&one.key),
            table => ["joint", "spring", "gravity"].contains(&table),
        });
        let parts = is_constant.then(|| system.parts());
        Ok(Self { file: RefCell::new(file.clone()), parts, first, last: RefCell::default() })
    }
}

impl Mechanism for Bodies {
    type Numbers = Rc<MultibodyStepper>;

    fn layout(&self) -> &Layout {
        self.first.layout()
    }

    fn numbers(&self, [start, length]: [f64; 2], held: &[BodyInput]) -> Option<Rc<MultibodyStepper>> {
        let mut last = self.last.borrow_mut();
        if let Some((span, known, stepper)) = &*last
            && (span, &known[..]) == (&[start, length], held)
        {
            return Some(Rc::clone(stepper));
        }
        let mut file = self.file.borrow_mut();
        let is_known = file.set_over([start, length]);
        let of_file = file.system.as_ref().filter(|_| is_known)?;
        let mut system = self.parts.clone().unwrap_or_else(|| of_file.parts());
        of_file.act(&file, &mut system, file.at(start + length * 0.5), held).ok()?;
        let length_of_step = if length == 0.0 { self.first.step_size() } else { length };
        let stepper = Rc::new(self.first.with(system, length_of_step).ok()?);
        *last = Some(([start, length], held.to_vec(), Rc::clone(&stepper)));
        Some(stepper)
    }

    fn start(
        &self,
        stepper: &Rc<MultibodyStepper>,
        attitude: &[f64],
        velocity: &[f64],
    ) -> Result<Box<[f64]>, SetupError> {
        Propagator::start(&**stepper, attitude, velocity)
    }

    fn step(
        &self,
        _: usize,
        stepper: &Rc<MultibodyStepper>,
        length: f64,
        state: &mut Vec<f64>,
    ) -> Result<StepReport, StepError> {
        // The memory of a state is that of equal steps.
        if length.to_bits() != self.first.step_size().to_bits() {
            *state = stepper.adopt(state).into();
        }
        stepper.step(state)
    }

    fn forget(&self, state: &mut Vec<f64>) {
        *state = self.first.adopt(state).into();
    }

    fn velocity(&self, stepper: &Rc<MultibodyStepper>, state: &[f64]) -> Vec<f64> {
        let mut velocity = vec![0.0; self.layout().components()];
        Propagator::velocity(&**stepper, state, &mut velocity);
        velocity
    }

    fn energy(&self, stepper: &Rc<MultibodyStepper>, state: &[f64]) -> f64 {
        stepper.energy(state)
    }

    fn push(&self, stepper: &Rc<MultibodyStepper>, state: &mut [f64], impulses: &[f64]) -> Result<(), StepError> {
        stepper.push(state, &impulses.chunks(6).map(Vector6::from_column_slice).collect::<Vec<_>>())
    }

    fn project(&self, stepper: &Rc<MultibodyStepper>, state: &mut [f64]) -> Result<(), StepError> {
        stepper.push(state, &vec![Vector6::zeros(); stepper.bodies()])
    }

    fn spatial_momentum(&self, state: &[f64], momentum: &mut [f64]) {
        self.first.spatial_momentum(state, momentum);
    }

    fn defect(&self, state: &[f64]) -> f64 {
        self.first.defect(state)
    }

    fn gap(&self, state: &[f64]) -> f64 {
        self.first.widest_gap(state)
    }

    fn cost(&self) -> Option<Cost> {
        self.first.cost()
    }

    fn joint_forces(&self, stepper: &Rc<MultibodyStepper>, state: &[f64]) -> Result<Vec<[Vector3<f64>; 2]>, StepError> {
        stepper.joint_forces(&stepper.adopt(state))
    }
}
