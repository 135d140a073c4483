//! The factors of a group, with the names of their numbers in tables.

use alloc::borrow::ToOwned as _;
use alloc::format;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;

/// A factor of a group: the kind of its elements, and the names of its components.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Factor {
    /// The kind of the factor's elements.
    pub kind: FactorKind,
    /// The names of algebra elements' and covectors' components, with the units of a velocity and of a momentum, such as
    /// `x`, `rad/s` and `kg m²/s`; an unknown unit is empty. In a product a name ends with the place of the factor, `x_1`.
    pub components: Vec<(String, [&'static str; 2])>,
}

/// The kind of a group's elements, by which an attitude is written to a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorKind {
    /// SO(3): a matrix of three rows in a state, a unit quaternion in a table.
    Rotation,
    /// Translations: homogeneous matrices of this many rows in a state, coordinates in a table.
    Translation(usize),
    /// Matrices of this many rows, in states and tables.
    Matrix(usize),
}

impl FactorKind {
    /// The number of rows of a matrix.
    #[must_use]
    pub const fn rows(self) -> usize {
        match self {
            Self::Rotation => 3,
            Self::Translation(rows) | Self::Matrix(rows) => rows,
        }
    }

    /// The number of columns of an element in a table.
    #[must_use]
    pub const fn columns(self) -> usize {
        match self {
            Self::Rotation => 4,
            Self::Translation(rows) => rows - 1,
            Self::Matrix(rows) => rows * rows,
        }
    }
}

impl Factor {
    /// The only factor of a group. Its components are `x`, `y`, `z` on SO(3), on other groups numbers from one.
    #[must_use]
    pub fn of(kind: FactorKind, dimension: usize) -> Self {
        let named = |component: usize| match kind {
            FactorKind::Rotation => (["x", "y", "z"][component % 3].to_owned(), ["rad/s", "kg m²/s"]),
            _ => ((component + 1).to_string(), [""; 2]),
        };
        Self { kind, components: (0..dimension).map(named).collect() }
    }

    /// The factor at a place of a product, from one: its names end with the place.
    #[must_use]
    pub fn at(mut self, place: usize) -> Self {
        for (name, _) in &mut self.components {
            *name = format!("{name}_{place}");
        }
        self
    }

    /// The columns of an element in a table, each with a name and a unit: of SO(3) its unit quaternion, of translations `x`,
    /// `y` and `z`, of other groups the entries of the matrix, row by row: `g_12`, or `g_1_12` for ten rows or more.
    #[must_use]
    pub fn columns(&self) -> Vec<(String, &'static str)> {
        let first = self.components.first().map_or("", |(name, _)| name.as_str());
        let place = first.find('_').map_or("", |end| &first[end..]);
        let named = |name: &str, unit| (format!("{name}{place}"), unit);
        match self.kind {
            FactorKind::Rotation => ["q_w", "q_x", "q_y", "q_z"].map(|name| named(name, "1")).into(),
            FactorKind::Translation(rows) => {
                ["x", "y", "z"].into_iter().take(rows - 1).map(|name| named(name, "m")).collect()
            }
            FactorKind::Matrix(rows) => {
                // The separator keeps 1, 11 and 11, 1 apart.
                let between = if rows > 9 { "_" } else { "" };
                let name = |entry| format!("g_{}{between}{}", entry / rows + 1, entry % rows + 1);
                (0..rows * rows).map(|entry| named(&name(entry), "")).collect()
            }
        }
    }
}
