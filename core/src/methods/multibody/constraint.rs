//! Holonomic constraints on two bodies.

use core::fmt::Debug;

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::error::SetupError;

/// The place of a body: attitude and position. The place of space is the identity and the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The rotation from the body's axes to those of space.
    pub attitude: Matrix3<f64>,
    /// The origin of the body's axes in space, m.
    pub position: Vector3<f64>,
}

impl Place {
    /// The place of the frame of space.
    pub const SPACE: Self = Self {
        attitude: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        position: Vector3::new(0.0, 0.0, 0.0),
    };

    /// The position in space of a point of the body.
    #[must_use]
    pub fn of(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.position + self.attitude * point
    }
}

/// The derivatives of a constraint by the place of one body, in the axes of space: one row per function, along
/// `δR = η̂ R` and `δx = ξ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope<const K: usize> {
    /// The derivatives along `η`.
    pub turn: SMatrix<f64, K, 3>,
    /// The derivatives along `ξ`.
    pub shift: SMatrix<f64, K, 3>,
}

/// A holonomic constraint on two bodies, or on a body and space: `K` functions of their places, which vanish.
///
/// A [`Joint`](super::Joint) is a constraint. [`constraint`](macro@crate::constraint) declares another
/// by its functions, and derives its [`slope`](Self::slope). In an implementation by hand, as in
/// `examples/declarations/strut.rs`, nothing checks that the slope is the derivative of the [`gap`](Self::gap).
///
/// A [`Multibody`](super::Multibody) system takes joints of any types, with up to six functions each.
///
/// # Examples
///
/// A strut, a rod without mass between two points, is one function. A body hangs on it and is thrown sideways:
///
/// ```
/// use liestep::groups::R3;
/// use liestep::methods::Multibody;
/// use liestep::{NonstandardInertia, SO3, constraint, lagrangian};
/// use nalgebra::{Vector3, Vector6};
///
/// #[constraint(
///     group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
///     advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
///     zero = {
///         let along = r + R_2 * below - R_1 * above;
///         0.5 * (along.norm_squared() / length - length) // m
///     },
/// )]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Strut {
///     above: Vector3<f64>, // m, in the axes of its body
///     below: Vector3<f64>,
///     length: f64, // m
/// }
///
/// /// A body and its weight.
/// #[lagrangian(
///     group(F = SO3, d = R3),
///     advected(x = d.seen_from(space)),
///     l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
///         - 0.5 * h * m * g * (x + x + d)[2],
/// )]
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Heavy {
///     J_d: NonstandardInertia,
///     m: f64,
///     g: f64,
/// }
///
/// let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.09))?;
/// let strut = Strut { above: Vector3::zeros(), below: Vector3::x() * 0.2, length: 1.0 };
/// let start = [(SO3::identity(), R3::from(Vector3::new(-0.2, 0.0, -1.0)))];
/// let off = |h: f64, steps: u32| -> Result<f64, Box<dyn std::error::Error>> {
///     let mut system = Multibody::new();
///     let body = system.body(Heavy { J_d, m: 1.0, g: 9.81 });
///     system.join(strut, None, body);
///     let stepper = system.stepper(h)?;
///     let mut state = stepper.start(&start, &[Vector6::new(0.0, 0.0, 0.0, 0.0, 2.0, 0.0)])?;
///     let (energy, mut off) = (stepper.energy(&state), 0.0_f64);
///     for _ in 0..steps {
///         stepper.step(&mut state)?;
///         off = off.max((stepper.energy(&state) - energy).abs());
///     }
///     assert!(stepper.widest_gap(&state) < 1e-14);
///     Ok(off)
/// };
/// // Of second order: at half the step the energy is off by a quarter.
/// let ratio = off(0.01, 1000)? / off(0.005, 2000)?;
/// assert!((ratio - 4.0).abs() < 0.2, "{ratio}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no constraint on two bodies",
    label = "not a joint",
    note = "joints are `Joint::ball(…)` and its other kinds, and what `#[constraint(…)]` declares"
)]
pub trait Constraint<const K: usize>: Debug + Send + Sync + 'static {
    /// Checks the parameters.
    ///
    /// # Errors
    ///
    /// [`SetupError::Parameter`] names the first field with an invalid value.
    fn validate(&self) -> Result<(), SetupError>;

    /// The name, by which descriptions distinguish two kinds with the same parameters.
    fn name(&self) -> &'static str;

    /// The number of functions that are imposed, the first of the `K`; by default all. It doesn't change.
    fn functions(&self) -> usize {
        K
    }

    /// The functions, each in a unit of its own: m for lengths, 1 for cosines.
    fn gap(&self, above: &Place, below: &Place) -> SVector<f64, K>;

    /// The derivatives of the functions by the place of the body above, and of the body below: each row in the unit of
    /// its function per radian and per m.
    fn slope(&self, above: &Place, below: &Place) -> [Slope<K>; 2];

    /// The point of the body below, in its axes, m, about which [torques](super::MultibodyStepper::joint_forces) of the joint count; by
    /// default its origin.
    fn point(&self) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// Visits the parameters.
    fn describe(&self, visit: &mut dyn FnMut(&'static str, f64));
}
