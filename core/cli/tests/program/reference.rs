//! Euler–Poincaré equations on any matrix group by Runge–Kutta steps, which share no code with the library, and what
//! tests of scenes on groups need.

use liestep_scene::{Run, Sample, Scene};
use nalgebra::{DMatrix, DVector};

pub(crate) type Generators = Vec<DMatrix<f64>>;

/// A motion by `μ' = ad*_ξ μ − dV(g E_k)`, `μ = K ξ + b`, `g' = g ξ̂`.
pub(crate) struct Reference<'a> {
    pub(crate) generators: &'a Generators,
    pub(crate) kinetic: DMatrix<f64>,
    pub(crate) bias: DVector<f64>,
    pub(crate) potential: &'a dyn Fn(&DMatrix<f64>) -> f64,
}

impl<'a> Reference<'a> {
    pub(crate) fn free(generators: &'a Generators, kinetic: DMatrix<f64>) -> Self {
        let bias = DVector::zeros(generators.len());
        Self { generators, kinetic, bias, potential: &|_| 0.0 }
    }

    fn hat(&self, xi: &DVector<f64>) -> DMatrix<f64> {
        let n = self.generators[0].nrows();
        self.generators.iter().zip(xi.iter()).fold(DMatrix::zeros(n, n), |sum, (generator, xi)| sum + generator * *xi)
    }

    /// The components of a matrix of the algebra.
    fn vee(&self, matrix: &DMatrix<f64>) -> DVector<f64> {
        let n = self.generators.len();
        let gram = DMatrix::from_fn(n, n, |i, j| self.generators[i].dot(&self.generators[j]));
        gram.lu().solve(&DVector::from_fn(n, |k, _| self.generators[k].dot(matrix))).unwrap()
    }

    fn velocity(&self, mu: &DVector<f64>) -> DVector<f64> {
        self.kinetic.clone().lu().solve(&(mu - &self.bias)).unwrap()
    }

    fn rates(&self, (g, mu): (&DMatrix<f64>, &DVector<f64>)) -> (DMatrix<f64>, DVector<f64>) {
        const SMALL: f64 = 1e-4;
        let hat = self.hat(&self.velocity(mu));
        let of = |part: f64, generator: &DMatrix<f64>| (self.potential)(&(g + g * generator * part));
        let rate = DVector::from_fn(self.generators.len(), |k, _| {
            let generator = &self.generators[k];
            let bracket = &hat * generator - generator * &hat;
            let slope = |part: f64| (of(part, generator) - of(-part, generator)) / (2.0 * part);
            // Richardson's extrapolation.
            mu.dot(&self.vee(&bracket)) - (4.0 * slope(SMALL) - slope(2.0 * SMALL)) / 3.0
        });
        (g * hat, rate)
    }

    /// Attitude and velocity after a time, by steps of fourth order.
    pub(crate) fn end(&self, g: DMatrix<f64>, xi: &[f64], time: f64, steps: u32) -> (DMatrix<f64>, DVector<f64>) {
        let mut now = (g, &self.kinetic * DVector::from_column_slice(xi) + &self.bias);
        let h = time / f64::from(steps);
        for _ in 0..steps {
            let at =
                |rate: &(DMatrix<f64>, DVector<f64>), part: f64| (&now.0 + &rate.0 * part, &now.1 + &rate.1 * part);
            let a = self.rates((&now.0, &now.1));
            let middle = at(&a, h / 2.0);
            let b = self.rates((&middle.0, &middle.1));
            let middle = at(&b, h / 2.0);
            let c = self.rates((&middle.0, &middle.1));
            let last = at(&c, h);
            let d = self.rates((&last.0, &last.1));
            now.0 += (a.0 + (b.0 + c.0) * 2.0 + d.0) * (h / 6.0);
            now.1 += (a.1 + (b.1 + c.1) * 2.0 + d.1) * (h / 6.0);
        }
        let velocity = self.velocity(&now.1);
        (now.0, velocity)
    }
}

pub(crate) fn one(text: &str) -> Scene {
    liestep_scene::Scene::parse("group.toml", text).unwrap_or_else(|mistake| panic!("{mistake}\n{text}"))
}

pub(crate) fn last(run: &Run) -> &Sample {
    run.samples().last().unwrap()
}

/// The velocity among the numbers of a sample, of a group of this dimension.
pub(crate) fn velocity(sample: &Sample, dimension: usize) -> &[f64] {
    let columns = sample.numbers.len() - 3 * dimension - 2;
    &sample.numbers[columns..columns + dimension]
}

/// The momentum in space.
pub(crate) fn in_space(sample: &Sample, dimension: usize) -> &[f64] {
    let end = sample.numbers.len() - 2;
    &sample.numbers[end - dimension..end]
}

pub(crate) fn apart(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The largest change of the momentum in space, relative to it, and of the distance from the group.
pub(crate) fn drifts(run: &Run, dimension: usize) -> [f64; 2] {
    let first = in_space(&run.samples()[0], dimension);
    let size = first.iter().map(|part| part * part).sum::<f64>().sqrt();
    let most = |of: &dyn Fn(&Sample) -> f64| run.samples().iter().map(of).fold(0.0, f64::max);
    [
        most(&|sample| apart(in_space(sample, dimension), first)) / size,
        most(&|sample| sample.numbers[sample.numbers.len() - 1]),
    ]
}

/// A second of a scene by a method and a number of steps; its text has no table `run`.
pub(crate) fn second(text: &str, method: &str, steps: u32) -> Run {
    let step = 1.0 / f64::from(steps);
    let method = if method.is_empty() { String::new() } else { format!("method = {{ composition = \"{method}\" }}\n") };
    one(&format!("title = \"group\"\n{text}\n[run]\nstep = {step:?}\nduration = 1\n{method}")).run().unwrap()
}

/// Asserts the order of the scene's own step and of a composition by the velocity after a second, whose value is given.
pub(crate) fn assert_orders(name: &str, text: &str, exact: &DVector<f64>) {
    let error =
        |method: &str, steps| apart(velocity(last(&second(text, method, steps)), exact.len()), exact.as_slice());
    let order = (error("", 100) / error("", 200)).log2();
    let (coarse, fine) = (error("Suzuki 4", 16), error("Suzuki 4", 32));
    let fourth = (coarse / fine).log2();
    println!("{name}: {order:.4}, {fourth:.4}, off by {:.1e} and {fine:.1e}", error("", 200));
    assert!((order - 2.0).abs() < 0.01, "{name}: order {order}");
    assert!((fourth - 4.0).abs() < 0.1 || fine < 1e-11, "{name}: order {fourth} at {coarse:e}, {fine:e}");
}

pub(crate) fn unit(n: usize, entries: &[(usize, usize, f64)]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(n, n);
    for &(i, j, entry) in entries {
        matrix[(i, j)] = entry;
    }
    matrix
}

pub(crate) fn special_linear() -> Generators {
    let places = (0..3).flat_map(|i| (0..3).filter(move |&j| i != j).map(move |j| (i, j)));
    let mut list: Generators = places.map(|(i, j)| unit(3, &[(i, j, 1.0)])).collect();
    list.extend((0..2).map(|k| unit(3, &[(k, k, 1.0), (k + 1, k + 1, -1.0)])));
    list
}

pub(crate) fn orthogonal(n: usize) -> Generators {
    (0..n).flat_map(|i| (i + 1..n).map(move |j| unit(n, &[(i, j, -1.0), (j, i, 1.0)]))).collect()
}

pub(crate) fn symplectic() -> Generators {
    let pairs = (0..2).flat_map(|i| (0..2).map(move |j| (i, j)));
    let mut list: Generators = pairs.map(|(i, j)| unit(4, &[(i, j, 1.0), (2 + j, 2 + i, -1.0)])).collect();
    for (row, column) in [(0, 2), (2, 0)] {
        list.push(unit(4, &[(row, column, 1.0)]));
        list.push(unit(4, &[(row + 1, column + 1, 1.0)]));
        list.push(unit(4, &[(row, column + 1, 1.0), (row + 1, column, 1.0)]));
    }
    list
}

pub(crate) fn affine(n: usize) -> Generators {
    (0..n).flat_map(|i| (0..=n).map(move |j| unit(n + 1, &[(i, j, 1.0)]))).collect()
}

pub(crate) fn turns() -> Generators {
    [(1, 2), (2, 0), (0, 1)].iter().map(|&(a, b)| unit(3, &[(a, b, -1.0), (b, a, 1.0)])).collect()
}

/// Turns with as many vectors as rows beyond three: `SE(3)`, `SE_2(3)`.
pub(crate) fn poses(rows: usize) -> Generators {
    let mut list: Generators =
        turns().iter().map(|turn| blocks(&[turn, &DMatrix::zeros(rows - 3, rows - 3)])).collect();
    list.extend((0..3 * (rows - 3)).map(|k| unit(rows, &[(k % 3, 3 + k / 3, 1.0)])));
    list
}

/// A block-diagonal matrix.
pub(crate) fn blocks(parts: &[&DMatrix<f64>]) -> DMatrix<f64> {
    let n = parts.iter().map(|part| part.nrows()).sum();
    let (mut all, mut at) = (DMatrix::zeros(n, n), 0);
    for part in parts {
        all.view_mut((at, at), part.shape()).copy_from(*part);
        at += part.nrows();
    }
    all
}

/// The generators of a product, as block-diagonal matrices.
pub(crate) fn product(factors: &[Generators]) -> Generators {
    let sizes: Vec<usize> = factors.iter().map(|factor| factor[0].nrows()).collect();
    let zeros: Generators = sizes.iter().map(|n| DMatrix::zeros(*n, *n)).collect();
    let place = |at: usize, generator: &DMatrix<f64>| {
        let parts: Vec<_> = zeros.iter().enumerate().map(|(k, zero)| if k == at { generator } else { zero }).collect();
        blocks(&parts)
    };
    factors
        .iter()
        .enumerate()
        .flat_map(|(at, factor)| factor.iter().map(move |one| (at, one)))
        .map(|(at, one)| place(at, one))
        .collect()
}

/// A matrix as TOML, of whole numbers where the entries are.
pub(crate) fn written(matrix: &DMatrix<f64>) -> String {
    let rows =
        matrix.row_iter().map(|row| format!("[{}]", row.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")));
    format!("[{}]", rows.collect::<Vec<_>>().join(", "))
}

/// A symmetric positive matrix.
pub(crate) fn metric(n: usize) -> DMatrix<f64> {
    let small = |number: usize| f64::from(u8::try_from(number).unwrap());
    DMatrix::from_fn(n, n, |i, j| if i == j { 1.0 + 0.1 * small(i) } else { 0.05 / (1.0 + small(i + j)) })
}

pub(crate) fn moving(dimension: usize) -> Vec<f64> {
    (0..dimension).map(|k| 0.3 * (f64::from(u8::try_from(k).unwrap()) * 1.7).sin() + 0.1).collect()
}

/// The metric `tr(E_i J E_jᵀ)`.
pub(crate) fn of_traces(generators: &Generators, J: &DMatrix<f64>) -> DMatrix<f64> {
    let n = generators.len();
    DMatrix::from_fn(n, n, |i, j| (&generators[i] * J * generators[j].transpose()).trace())
}
