//! Springs between points of bodies: kicks at the ends of a step.

use liestep::groups::{CayleyRetraction, LieGroup as _, R3};
use liestep::mechanics::{
    Effect, Limit, Matrix, Parts, SceneVisitor, Square, Term, Vector, WhereAllAre, WithoutKinetic,
};
use liestep::numbers::{BlockDiagonal, Bodies};
use liestep::{SO3, SetupError};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::file::system::{Between, SPRINGS, Spring};

/// All springs of a file between `N` bodies, with the potential `V = Σ k (|y| − l)²/2`, where `y` connects the two
/// points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Springs<const N: usize>([Option<Between<Spring>>; SPRINGS]);

type FreeBody = (SO3, R3);
type Places<const N: usize> = WhereAllAre<FreeBody, N>;
type Kick<const N: usize> = Bodies<Vector6<f64>, N>;

impl<const N: usize> Springs<N> {
    pub(crate) fn of(springs: &[Between<Spring>]) -> Self {
        Self(std::array::from_fn(|place| springs.get(place).copied()))
    }

    fn all(&self) -> impl Iterator<Item = &Between<Spring>> {
        self.0.iter().flatten()
    }

    /// The forces and torques, the latter in the body frames, times `h/2`.
    fn kick(&self, places: &Places<N>, half_step: f64) -> Kick<N> {
        let mut kick = Bodies([Vector6::zeros(); N]);
        for between in self.all() {
            let along = between.along(places);
            let (Spring { k, length, at }, size) = (&between.of, along.norm());
            // A spring whose ends coincide has no direction.
            let tension = if size > 0.0 { along * (k * (1.0 - length / size) * half_step) } else { along };
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let Some(body) = between.bodies[side] else { continue };
                let force = tension * sign;
                let torque = at[side].cross(&places.0[body].0.tr_mul(&force));
                kick.0[body] += Vector6::new(torque.x, torque.y, torque.z, force.x, force.y, force.z);
            }
        }
        kick
    }
}

impl Between<Spring> {
    /// The vector from the first point to the second, in space.
    fn along<const N: usize>(&self, places: &Places<N>) -> Vector3<f64> {
        self.along_by(|body| FreeBody::from_matrix_unchecked(places.0[body]))
    }

    /// The vector from the first point to the second, in space, for bodies at these places.
    pub(crate) fn along_of(&self, places: &[FreeBody]) -> Vector3<f64> {
        self.along_by(|body| places[body])
    }

    fn along_by(&self, place: impl Fn(usize) -> FreeBody) -> Vector3<f64> {
        let [one, other] = [0, 1].map(|side| {
            let point = self.of.at[side];
            self.bodies[side].map_or(point, |body| {
                let (attitude, place) = place(body);
                attitude.as_matrix() * point + place.translation()
            })
        });
        other - one
    }
}

impl<const N: usize> Term for Springs<N> {
    type Scalar = f64;
    type Group = [FreeBody; N];
    type Advected = Places<N>;

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn advected(&self) -> Places<N> {
        Places::default()
    }
}

/// Springs are kicks only: they aren't in the equation that a step solves.
impl<const N: usize> Effect for Springs<N> {
    type Retraction = CayleyRetraction;
    type Kinetic = WithoutKinetic;
    type Constants = (Self, f64);
    type StepTerms = ();

    const PARTS: Parts = Parts { unknown: false, kick_before: true, kick_after: true };
    const INERTIA_IS_CONSTANT: bool = true;
    const IS_QUADRATIC: bool = true;
    const DERIVATION: &'static str = "springs between points of bodies, V = Σ k (|y| − l)²/2 of y from one point to the \
                                      other, half of them at either end of a step\n";

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        for Between { bodies, of: Spring { k, length, at } } in self.all() {
            visitor.term("spring");
            #[allow(clippy::cast_precision_loss)] // up to eight
            let numbers = bodies.map(|body| body.map_or(-1.0, |body| body as f64));
            for (name, &value) in numbers.iter().map(|of| ("body", of)).chain(at.iter().flatten().map(|of| ("at", of)))
            {
                visitor.parameter(name, value);
            }
            visitor.parameter("k", *k);
            visitor.parameter("length", *length);
        }
    }

    fn momentum_jacobian(&self, _: &Matrix<Self>, _: &Places<N>, _: f64) -> Square<Self> {
        BlockDiagonal([Matrix6::zeros(); N])
    }

    fn limit(&self, velocity: Option<&Vector<Self>>, places: &Places<N>) -> Limit<Self> {
        let of_one = |between: &Between<Spring>| {
            let stretch = between.along(places).norm() - between.of.length;
            0.5 * between.of.k * stretch * stretch
        };
        let zero = (BlockDiagonal([Matrix6::zeros(); N]), Bodies([Vector6::zeros(); N]));
        Limit::quadratic(velocity, zero.0, zero.1, self.all().map(of_one).sum::<f64>())
    }

    fn constants(&self, h: f64) -> (Self, f64) {
        (*self, 0.5 * h)
    }

    fn kick_before((springs, half_step): &(Self, f64), places: &Places<N>) -> Kick<N> {
        springs.kick(places, *half_step)
    }

    fn step_terms(_: &(Self, f64), _: &Kick<N>, _: &Places<N>) {}

    fn newton_system(_: &(Self, f64), (): &(), _: &Kick<N>) -> (Kick<N>, Square<Self>) {
        (Bodies([Vector6::zeros(); N]), BlockDiagonal([Matrix6::zeros(); N]))
    }

    fn kick_after((springs, half_step): &(Self, f64), _: &Matrix<Self>, next: &Places<N>) -> Kick<N> {
        springs.kick(next, *half_step)
    }
}
