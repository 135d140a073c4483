//! The parts of a system: its bodies, and what is between two of them.

use liestep::mechanics::Inertia;
use nalgebra::Vector3;

use crate::file::body::Kinetic;
use crate::file::start::Start;

#[derive(Clone)]
pub(crate) struct SystemBody {
    pub(crate) name: String,
    pub(crate) m: f64,
    pub(crate) J: Inertia,
    /// A kinetic term of second order.
    pub(crate) kinetic: Kinetic,
    pub(crate) position: Vector3<f64>,
    pub(crate) moving: Vector3<f64>,
    pub(crate) start: Start,
}

/// A joint or a spring between two bodies, by their numbers; `None` is space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Between<T> {
    pub(crate) bodies: [Option<usize>; 2],
    pub(crate) of: T,
}

/// The joint's name in the file, and whether its bodies stand there in the other order.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointName {
    pub(crate) name: Option<String>,
    pub(crate) is_swapped: bool,
}
