//! The groups that a declaration can name: matrix size and generators, in the order of the run-time half.
//!
//! The run-time half declares the same generators; the compiler compares the two in every expansion.

use super::chart::{Chart, chart};
use crate::mathematics::symbolic::Rational;

/// A matrix Lie group by its generators.
#[derive(Clone, Debug)]
pub struct Group {
    /// The number of rows of the matrices.
    pub size: usize,
    /// `E_k`, by rows.
    pub generators: Vec<Vec<Rational>>,
    /// Whether `FᵀF = I` holds.
    pub orthogonal: bool,
    /// Whether the group is SO(3), with its own Cayley form and cross products.
    pub is_so3: bool,
    /// Whether the group is a factor of translations, whose increments are vectors that are added, and no matrices.
    pub is_added: bool,
    /// The factors of a product, with block-diagonal matrices; empty for any other group.
    factors: Vec<Group>,
}

impl Group {
    /// The product of several groups, as block-diagonal matrices.
    pub fn product(factors: Vec<Self>) -> Self {
        let size = factors.iter().map(|factor| factor.size).sum();
        let mut generators = Vec::new();
        let mut start = 0;
        for factor in &factors {
            let inside = |at: usize| (start..start + factor.size).contains(&at);
            generators.extend(factor.generators.iter().map(|own| {
                let entry = |place: usize| match (place / size, place % size) {
                    (row, column) if inside(row) && inside(column) => {
                        own.get((row - start) * factor.size + column - start).copied().unwrap_or(Rational::ZERO)
                    }
                    _ => Rational::ZERO,
                };
                (0..size * size).map(entry).collect()
            }));
            start += factor.size;
        }
        let orthogonal = factors.iter().all(|factor| factor.orthogonal);
        Self { size, generators, orthogonal, is_so3: false, is_added: false, factors }
    }

    /// The factors; a group that isn't a product is its only factor.
    pub fn factors(&self) -> &[Self] {
        if self.factors.is_empty() { std::slice::from_ref(self) } else { &self.factors }
    }

    pub fn is_product(&self) -> bool {
        !self.factors.is_empty()
    }

    /// Whether all factors are SO(3) or translations, whose Cayley map is implemented.
    pub fn rotates(&self) -> bool {
        self.factors().iter().all(|factor| factor.is_so3 || factor.is_added)
    }

    /// The factors whose increments are matrices.
    pub fn turning(&self) -> impl Iterator<Item = &Self> {
        self.factors().iter().filter(|factor| !factor.is_added)
    }

    /// The factor whose vectors `hat` takes: a rotation if there is one, else the first that isn't added.
    pub fn of_hat(&self) -> Option<usize> {
        let place = |of: &dyn Fn(&Self) -> bool| self.factors().iter().position(of);
        place(&|factor| factor.is_so3).or_else(|| place(&|factor| !factor.is_added))
    }

    /// The rows of `I`: those of the matrices; `None` where factors have matrices of several sizes, and `I` has that of the
    /// matrix it stands beside.
    pub fn rows_of_identity(&self) -> Option<usize> {
        let mut sizes = self.turning().map(|factor| factor.size);
        let first = sizes.next().unwrap_or(3);
        sizes.all(|size| size == first).then_some(first)
    }

    /// The factor with this index; the group itself if it isn't a product.
    pub fn factor(&self, factor: usize) -> &Self {
        self.factors().get(factor).unwrap_or(self)
    }

    /// The group as translations of a line, a plane or space, a factor of a product.
    pub fn added(self) -> Self {
        Self { is_added: true, ..self }
    }

    /// The rows and columns of an increment in the expression: a vector for a translation, else a matrix.
    pub fn shape(&self) -> (usize, usize) {
        if self.is_added { (self.dimension(), 1) } else { (self.size, self.size) }
    }

    /// The first row of a factor.
    pub fn row_of(&self, factor: usize) -> usize {
        self.factors().iter().take(factor).map(|before| before.size).sum()
    }

    /// The first component of a factor.
    pub fn component_of(&self, factor: usize) -> usize {
        self.factors().iter().take(factor).map(Self::dimension).sum()
    }

    /// The factor of a component, and the component's index in that factor.
    pub fn factor_of(&self, component: usize) -> (usize, usize) {
        let mut own = component;
        for (at, factor) in self.factors().iter().enumerate() {
            match own.checked_sub(factor.dimension()) {
                Some(rest) => own = rest,
                None => return (at, own),
            }
        }
        (0, component)
    }

    pub fn dimension(&self) -> usize {
        self.generators.len()
    }

    /// Linear forms that are the components of `Σ x_k E_k`, each a sum of terms `(k, row, column, factor)` in its entries.
    pub fn dual(&self) -> Vec<(usize, usize, usize, Rational)> {
        let (places, dimension) = (self.size * self.size, self.dimension());
        // Each generator is extended by a unit vector, which records the combination that elimination subtracts.
        let mut basis = Subspace::default();
        for (k, generator) in self.generators.iter().enumerate() {
            basis.extend([generator.clone(), unit(k, dimension)].concat());
        }
        let of_entry = |place: usize| {
            let taken = basis.rest(unit(place, places + dimension)).split_off(places);
            let terms = taken.into_iter().enumerate().filter(|(_, factor)| !factor.is_zero());
            terms.map(move |(k, factor)| (k, place / self.size, place % self.size, -factor))
        };
        (0..places).flat_map(of_entry).collect()
    }

    /// Whether the elements are affine maps in homogeneous coordinates: their last row is that of the identity.
    pub fn is_affine(&self) -> bool {
        let last_row = self.size * self.size.saturating_sub(1);
        !self.is_product()
            && self.generators.iter().all(|generator| generator.iter().skip(last_row).all(|entry| entry.is_zero()))
    }

    /// A group that a user declares.
    pub fn declared(size: usize, generators: Vec<Vec<Rational>>) -> Self {
        let skew = |generator: &Vec<Rational>| {
            (0..size * size).all(|at| {
                let (row, column) = (at / size, at % size);
                let mirrored = generator.get(column * size + row).copied().unwrap_or(Rational::ZERO);
                generator.get(at).copied() == Some(-mirrored)
            })
        };
        let orthogonal = generators.iter().all(skew);
        Self { size, generators, orthogonal, is_so3: false, is_added: false, factors: Vec::new() }
    }

    /// Coordinates of increments that stay in the group; the index of a generator that has none. Those of a product are those
    /// of its factors, and Cayley's if all factors have these.
    pub fn chart(&self) -> Result<Chart, usize> {
        if self.is_product() {
            let mut chart = Chart::Cayley;
            for (at, factor) in self.factors.iter().enumerate() {
                if factor.chart().map_err(|k| self.component_of(at) + k)? == Chart::Product {
                    chart = Chart::Product;
                }
            }
            return Ok(chart);
        }
        let numbers = self.generators.iter().map(|one| one.iter().map(|entry| entry.to_f64()).collect());
        chart(&numbers.collect::<Vec<Vec<f64>>>())
    }

    /// The defect of generators that aren't a basis of a Lie algebra, in exact arithmetic; `None` if its range is too
    /// small.
    pub fn defect(&self) -> Option<Defect> {
        let mut basis = Subspace::default();
        for (k, generator) in self.generators.iter().enumerate() {
            if generator.iter().all(|entry| entry.is_zero()) {
                return Some(Defect::Zero(k));
            }
            if !basis.extend(generator.clone()) {
                return Some(Defect::Dependent(k));
            }
        }
        let count = self.generators.len();
        let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        let mut brackets = pairs.map(|(i, j)| (i, j, self.bracket(&self.generators[i], &self.generators[j])));
        brackets.find(|(_, _, bracket)| !basis.contains(bracket.clone())).map(|(i, j, _)| Defect::Open(i, j))
    }

    /// `AB − BA`.
    fn bracket(&self, a: &[Rational], b: &[Rational]) -> Vec<Rational> {
        let size = self.size;
        let product = |a: &[Rational], b: &[Rational], at: usize| {
            let terms = (0..size).map(|k| a[at / size * size + k] * b[k * size + at % size]);
            terms.fold(Rational::ZERO, |sum, term| sum + term)
        };
        (0..size * size).map(|at| product(a, b, at) - product(b, a, at)).collect()
    }
}

/// The reason why matrices are no basis of a Lie algebra, by their indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// A matrix is zero.
    Zero(usize),
    /// A matrix is a combination of those before.
    Dependent(usize),
    /// The bracket of two isn't a combination of all.
    Open(usize, usize),
}

/// A basis of a vector space in echelon form: each vector with the index of its first nonzero entry, which is one.
#[derive(Default)]
struct Subspace(Vec<(usize, Vec<Rational>)>);

impl Subspace {
    /// The rest of a vector after elimination by the basis.
    fn rest(&self, mut vector: Vec<Rational>) -> Vec<Rational> {
        for (at, basis) in &self.0 {
            let factor = vector[*at];
            for (entry, &other) in vector.iter_mut().zip(basis) {
                *entry = *entry - factor * other;
            }
        }
        vector
    }

    /// Whether the vector is in the space, or out of the range of exact arithmetic.
    fn contains(&self, vector: Vec<Rational>) -> bool {
        let rest = self.rest(vector);
        rest.iter().all(|entry| entry.is_zero()) || rest.iter().any(|entry| entry.is_overflow())
    }

    /// Adds a vector; false if it is in the space already.
    fn extend(&mut self, vector: Vec<Rational>) -> bool {
        let rest = self.rest(vector);
        let Some(at) = rest.iter().position(|entry| !entry.is_zero()) else { return false };
        let scale = rest[at].inverse();
        self.0.push((at, rest.into_iter().map(|entry| entry * scale).collect()));
        true
    }
}

/// Row `k` of the identity.
fn unit(k: usize, dimension: usize) -> Vec<Rational> {
    (0..dimension).map(|j| if j == k { Rational::ONE } else { Rational::ZERO }).collect()
}

/// The nonzero entries of a matrix: row, column, numerator, denominator.
type Sparse<'a> = &'a [(usize, usize, i128, i128)];

/// The names that [`built_in`] knows.
pub const NAMES: [&str; 11] = ["SO2", "SE2", "SO3", "SE3", "SE23", "SU2", "SL2", "Heisenberg", "R1", "R2", "R3"];

/// The group of that name.
pub fn built_in(name: &str) -> Option<Group> {
    let (size, generators): (usize, &[Sparse]) = match name {
        "SO2" => (2, &[&[(0, 1, -1, 1), (1, 0, 1, 1)]]),
        "SE2" => (3, &[&[(0, 1, -1, 1), (1, 0, 1, 1)], &[(0, 2, 1, 1)], &[(1, 2, 1, 1)]]),
        "SO3" => (3, &ROTATIONS),
        "SE3" => (4, &[ROTATIONS[0], ROTATIONS[1], ROTATIONS[2], &[(0, 3, 1, 1)], &[(1, 3, 1, 1)], &[(2, 3, 1, 1)]]),
        "SE23" => (
            5,
            &[
                ROTATIONS[0],
                ROTATIONS[1],
                ROTATIONS[2],
                &[(0, 3, 1, 1)],
                &[(1, 3, 1, 1)],
                &[(2, 3, 1, 1)],
                &[(0, 4, 1, 1)],
                &[(1, 4, 1, 1)],
                &[(2, 4, 1, 1)],
            ],
        ),
        // Half the left multiplications by i, j and k, on (1, i, j, k).
        "SU2" => (
            4,
            &[
                &[(0, 1, -1, 2), (1, 0, 1, 2), (2, 3, -1, 2), (3, 2, 1, 2)],
                &[(0, 2, -1, 2), (1, 3, 1, 2), (2, 0, 1, 2), (3, 1, -1, 2)],
                &[(0, 3, -1, 2), (1, 2, -1, 2), (2, 1, 1, 2), (3, 0, 1, 2)],
            ],
        ),
        "SL2" => (2, &[&[(0, 0, 1, 2), (1, 1, -1, 2)], &[(0, 1, 1, 2), (1, 0, 1, 2)], &[(0, 1, -1, 2), (1, 0, 1, 2)]]),
        "Heisenberg" => (3, &[&[(0, 1, 1, 1)], &[(1, 2, 1, 1)], &[(0, 2, 1, 1)]]),
        "R1" => (2, &[&[(0, 1, 1, 1)]]),
        "R2" => (3, &[&[(0, 2, 1, 1)], &[(1, 2, 1, 1)]]),
        "R3" => (4, &[&[(0, 3, 1, 1)], &[(1, 3, 1, 1)], &[(2, 3, 1, 1)]]),
        _ => return None,
    };
    let full = |sparse: &Sparse| {
        let mut entries = vec![Rational::ZERO; size * size];
        for &(row, column, numerator, denominator) in *sparse {
            if let Some(entry) = entries.get_mut(row * size + column) {
                *entry = Rational::new(numerator, denominator);
            }
        }
        entries
    };
    let is_so3 = name == "SO3";
    Some(Group { is_so3, ..Group::declared(size, generators.iter().map(full).collect()) })
}

const ROTATIONS: [Sparse; 3] =
    [&[(1, 2, -1, 1), (2, 1, 1, 1)], &[(0, 2, 1, 1), (2, 0, -1, 1)], &[(0, 1, -1, 1), (1, 0, 1, 1)]];
