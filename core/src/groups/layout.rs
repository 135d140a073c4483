//! The factors of a group, with the names of their numbers in tables.

use alloc::borrow::ToOwned as _;
use alloc::format;
use alloc::string::{String, ToString as _};
use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Quaternion, UnitQuaternion};

/// A factor of a group: the kind of its elements, and the names of its components.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Factor {
    /// The kind of the factor's elements.
    pub kind: FactorKind,
    /// The names of algebra elements' and covectors' components, with the units of a velocity and of a momentum, such as
    /// `x`, `rad/s` and `kg m²/s`; an unknown unit is empty. In a product a name ends with the place of the factor, `x_1`.
    pub components: Vec<(String, [&'static str; 2])>,
    /// The number of rows and columns of the block in which elements of the group turn; below it they are the identity, and behind
    /// it they have places.
    pub head: usize,
    /// Whether each component is one of a translation: its generator has entries behind the head alone.
    pub translates: Vec<bool>,
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

    /// The entries of an element's matrix, row by row, from its [columns](Self::columns) in a table.
    #[must_use]
    pub fn entries(self, columns: &[f64]) -> Vec<f64> {
        let column = |place: usize| columns.get(place).copied().unwrap_or(f64::NAN);
        match self {
            Self::Rotation => {
                let quaternion = Quaternion::new(column(0), column(1), column(2), column(3));
                let rotation = UnitQuaternion::new_normalize(quaternion).to_rotation_matrix().into_inner();
                rotation.transpose().as_slice().to_vec()
            }
            Self::Translation(rows) => {
                let entry = |row: usize, at: usize| {
                    let is_place = at + 1 == rows && row + 1 < rows;
                    if is_place { column(row) } else { f64::from(u8::from(row == at)) }
                };
                (0..rows * rows).map(|at| entry(at / rows, at % rows)).collect()
            }
            Self::Matrix(rows) => (0..rows * rows).map(column).collect(),
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
        let (head, translates) = match kind {
            FactorKind::Translation(rows) => (rows - 1, true),
            _ => (kind.rows(), false),
        };
        let components = (0..dimension).map(named).collect();
        Self { kind, components, head, translates: vec![translates; dimension] }
    }

    /// The factor with the head and the translations of these generators, entries row by row.
    #[must_use]
    pub fn with_generators(mut self, generators: &[Vec<f64>]) -> Self {
        let rows = self.kind.rows().max(1);
        let entries = |generator: &Vec<f64>| -> Vec<usize> {
            generator.iter().enumerate().filter_map(|(at, entry)| (*entry != 0.0).then_some(at)).collect()
        };
        let entries: Vec<_> = generators.iter().map(entries).collect();
        let head = entries.iter().flatten().map(|at| at / rows + 1).max().unwrap_or(rows);
        self.translates = entries.iter().map(|entries| entries.iter().all(|at| at % rows >= head)).collect();
        self.head = head;
        self
    }

    /// Whether its elements are translations.
    #[must_use]
    pub fn is_translation(&self) -> bool {
        matches!(self.kind, FactorKind::Translation(_))
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
