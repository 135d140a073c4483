//! The kinds of joints, and what each leaves free.

use serde::Deserialize;

/// The kind of a joint, see [`liestep::methods::Joint`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Kind {
    Ball,
    Pin,
    Universal,
    Cylinder,
    Slider,
    Weld,
    Plane,
    Distance,
}

impl Kind {
    pub(crate) const ALL: [Self; 8] =
        [Self::Ball, Self::Pin, Self::Universal, Self::Weld, Self::Cylinder, Self::Slider, Self::Plane, Self::Distance];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball joint",
            Self::Pin => "pin",
            Self::Universal => "universal joint",
            Self::Cylinder => "cylinder",
            Self::Slider => "slider",
            Self::Weld => "weld",
            Self::Plane => "plane",
            Self::Distance => "distance",
        }
    }

    pub(crate) fn has_axes(self) -> bool {
        !matches!(self, Self::Ball | Self::Weld | Self::Distance)
    }

    /// Whether the axes of both bodies are parallel.
    pub(crate) fn has_one_axis(self) -> bool {
        self.has_axes() && self != Self::Universal
    }

    pub(crate) fn turns_about_axis(self) -> bool {
        matches!(self, Self::Pin | Self::Cylinder | Self::Plane)
    }

    pub(crate) fn turns(self) -> bool {
        !matches!(self, Self::Slider | Self::Weld | Self::Distance)
    }

    /// Whether a spring may be in it.
    pub(crate) fn springs(self) -> bool {
        self.turns() && self != Self::Plane
    }

    /// Whether its spring is at rest at an angle.
    pub(crate) fn rests(self) -> bool {
        self.turns_about_axis() && self != Self::Plane
    }

    pub(crate) fn shifts_along_axis(self) -> bool {
        matches!(self, Self::Slider | Self::Cylinder)
    }

    /// Whether points of both bodies coincide.
    pub(crate) fn has_one_point(self) -> bool {
        matches!(self, Self::Ball | Self::Pin | Self::Universal | Self::Weld)
    }

    /// Whether the functions are cosines in part.
    pub(crate) fn has_cosines(self) -> bool {
        !matches!(self, Self::Ball | Self::Distance)
    }

    /// Whether the coordinates of the joint give the place of one body by that of the other.
    pub(crate) fn places(self) -> bool {
        self != Self::Distance
    }
}
