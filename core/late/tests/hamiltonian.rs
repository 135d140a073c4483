//! Hamiltonians that are texts: a sub-Riemannian geodesic beside its closed form, two spins, and a body beside its Lagrangian.

use liestep::motion::AnyStepper;
use liestep_late::{Declaration, Interpreter, stepper};

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn of(text: &str, numbers: &[f64], h: f64, method: &str) -> AnyStepper {
    stepper::<Interpreter>(Declaration::parse(text).unwrap(), numbers, h, method.parse().unwrap()).unwrap()
}

/// A geodesic on the Heisenberg group that moves along two of three directions: `h = ½ (μ_1² + μ_2²)` has no Lagrangian. The
/// momenta turn, and the curve in the plane is a circle.
const GEODESIC: &str = "#[hamiltonian(
    group = Nilpotent,
    generators = [
        [[0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    ],
    momentum = mu,
    h = c * ((mu[0]).powi(2) + (mu[1]).powi(2)),
)]
struct Geodesic { c: f64 }";

#[test]
fn a_sub_riemannian_geodesic_has_its_closed_form() {
    let (start, end) = ([0.8, -0.3, 1.5], 2.0_f64);
    // `μ_3 = k` is constant, and `(μ_1, μ_2)` turns with the rate `k`: `ẋ = μ_1`, `ẏ = μ_2`.
    let k = start[2];
    let exact = |t: f64| {
        let (sin, cos) = (k * t).sin_cos();
        let mu = [start[0] * cos - start[1] * sin, start[0] * sin + start[1] * cos];
        let place = [(start[0] * sin + start[1] * (cos - 1.0)) / k, (start[0] * (1.0 - cos) + start[1] * sin) / k];
        [mu[0], mu[1], place[0], place[1]]
    };
    for (method, order) in [("step", 2.0), ("composition Suzuki 4", 4.0), ("composition Suzuki 4, substeps 1", 4.0)] {
        let errors = [20_u32, 40, 80].map(|steps| {
            let stepper = of(GEODESIC, &[0.5], end / f64::from(steps), method);
            let mut state = stepper.start_with_momentum(&IDENTITY, &start).unwrap();
            let energy = stepper.energy(&state);
            stepper.run(&mut state, u64::from(steps)).unwrap();
            assert!((stepper.energy(&state) - energy).abs() < 1e-12, "{method}");
            let now = state.numbers();
            let found = [now[9], now[10], now[1], now[5]];
            let turned = exact(end);
            found.iter().zip(turned).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        });
        let found = (errors[1] / errors[2]).log2();
        println!("{method}: {errors:?} {found}");
        assert!((found - order).abs() < 0.1, "{method}: {errors:?} {found}");
    }
}

const TOP: &str = "#[hamiltonian(group = SO3, momentum = mu, advected(w = up),
    h = 0.5 * mu.dot(&(K * mu)) + m * g * w.dot(&rho))]
struct Top { K: Matrix3<f64>, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }";
const BY_LAGRANGIAN: &str = "#[lagrangian(group = SO3, velocity = Omega, advected(w = up),
    l = 0.5 * Omega.dot(&(J * Omega)) - m * g * w.dot(&rho), discretise = trapezoid(Cayley))]
struct Top { J: Inertia, m: f64, g: f64, rho: Vector3<f64>, up: Vector3<f64> }";

/// The steps of a Hamiltonian with a Lagrangian are those of its discretisation.
#[test]
fn a_top_has_the_steps_of_its_lagrangian() {
    let rest = [1.0, 9.81, 0.1, 0.0, 0.3, 0.0, 0.0, 1.0];
    let own = of(TOP, &[&[1.0 / 3.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.25][..], &rest].concat(), 0.02, "step");
    let other = of(BY_LAGRANGIAN, &[&[3.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 4.0][..], &rest].concat(), 0.02, "step");
    let momentum = [1.0, 2.0, 9.0];
    let mut states = [&own, &other].map(|stepper| stepper.start_with_momentum(&IDENTITY, &momentum).unwrap());
    own.run(&mut states[0], 500).unwrap();
    other.run(&mut states[1], 500).unwrap();
    let off = (0..15).map(|at| (states[0].numbers()[at] - states[1].numbers()[at]).abs()).fold(0.0_f64, f64::max);
    println!("top: {off:e}");
    assert!(off < 1e-11, "{off:e}");
    assert!((own.energy(&states[0]) - other.energy(&states[1])).abs() < 1e-11);
}

/// Two spins with an exchange that has another strength along the third axis: their lengths, and what turns about that axis,
/// are conserved to rounding, and the energy has no drift.
#[test]
fn spins_keep_their_lengths() {
    let spins = "#[hamiltonian(group(F_1 = SO3, F_2 = SO3), momentum(s_1, s_2),
        h = -s_1.dot(&(A * s_2)))] struct Spins { A: Matrix3<f64> }";
    let stepper = of(spins, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.4], 0.05, "step");
    let start = [0.6, 0.0, 0.8, -0.28, 0.96, 0.0];
    let mut state = stepper.start_with_momentum(&[IDENTITY, IDENTITY].concat(), &start).unwrap();
    let of_state = |state: &liestep::motion::AnyState| {
        let s = &state.numbers()[18..24];
        let length = |k: usize| s[k..k + 3].iter().map(|x| x * x).sum::<f64>();
        [length(0), length(3), s[2] + s[5]]
    };
    let (before, energy) = (of_state(&state), stepper.energy(&state));
    let mut band = 0.0_f64;
    for _ in 0..4_000 {
        stepper.run(&mut state, 5).unwrap();
        for (now, then) in of_state(&state).into_iter().zip(before) {
            assert!((now - then).abs() < 1e-11, "{now} {then}");
        }
        band = band.max((stepper.energy(&state) - energy).abs());
    }
    println!("spins: energy {band:e} of {energy}");
    assert!(band < 1e-2, "{band:e}");
}

/// Zeitlin's fluid on a sphere for `N = 3`: SU(3) in real matrices of six rows, with the rotations `A` as vorticity of degree
/// one and `iS` of degree two. The Hamiltonian is the vorticity's product with its stream function, by `l (l + 1)`.
#[test]
fn zeitlins_fluid_keeps_its_casimirs() {
    type Complex = [[[f64; 3]; 3]; 2];
    let zero = [[0.0; 3]; 3];
    let pair = |i: usize, j: usize, sign: f64| {
        let mut m = zero;
        (m[i][j], m[j][i]) = (1.0, sign);
        m
    };
    let diagonal = |a: [f64; 3]| [[a[0], 0.0, 0.0], [0.0, a[1], 0.0], [0.0, 0.0, a[2]]];
    let pairs = [(1, 2), (2, 0), (0, 1)];
    let mut basis: Vec<Complex> = pairs.iter().map(|&(i, j)| [pair(i, j, -1.0), zero]).collect();
    basis.extend(pairs.iter().map(|&(i, j)| [zero, pair(i, j, 1.0)]));
    basis.extend([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]].map(|a| [zero, diagonal(a)]));
    // `a + ib` as `[a, −b; b, a]`.
    let real = |[a, b]: &Complex| -> Vec<Vec<f64>> {
        let entry = |i: usize, j: usize| match (i < 3, j < 3) {
            (true, false) => -b[i][j - 3],
            (false, true) => b[i - 3][j],
            _ => a[i % 3][j % 3],
        };
        (0..6).map(|i| (0..6).map(|j| entry(i, j)).collect()).collect()
    };
    let generators: Vec<Vec<Vec<f64>>> = basis.iter().map(real).collect();
    let pairing = |x: &Complex, y: &Complex| -> f64 {
        x.iter().flatten().flatten().zip(y.iter().flatten().flatten()).map(|(a, b)| a * b).sum()
    };
    let gram = nalgebra::SMatrix::<f64, 8, 8>::from_fn(|i, j| pairing(&basis[i], &basis[j]));
    let inverse = gram.try_inverse().unwrap();
    let stream = nalgebra::SMatrix::<f64, 8, 8>::from_fn(|i, j| inverse[(i, j)] / if i < 3 { 2.0 } else { 6.0 });
    let text = format!(
        "#[hamiltonian(group = SU3, generators = {generators:?}, momentum = mu, h = 0.5 * mu.dot(&(K * mu)))]
        struct Fluid {{ K: SMatrix<f64, 8, 8> }}"
    );
    let fluid = of(&text, stream.as_slice(), 0.05, "step");
    let start = [0.5, -0.2, 0.9, 0.3, 0.7, -0.4, 0.2, 0.6];
    let identity: Vec<f64> = (0..36).map(|at| f64::from(u8::from(at % 7 == 0))).collect();
    let mut state = fluid.start_with_momentum(&identity, &start).unwrap();
    // The vorticity `W` with `⟨W, E_k⟩ = μ_k`; traces of `W²` and of `i W³`.
    let casimirs = |mu: &[f64]| {
        let components = inverse * nalgebra::SVector::<f64, 8>::from_row_slice(mu);
        let w = nalgebra::Matrix3::<nalgebra::Complex<f64>>::from_fn(|i, j| {
            basis.iter().zip(&components).map(|([a, b], x)| nalgebra::Complex::new(a[i][j], b[i][j]) * *x).sum()
        });
        [(w * w).trace().re, (w * w * w).trace().im]
    };
    let momentum = |state: &liestep::motion::AnyState| state.numbers()[36..44].to_vec();
    let (before, energy) = (casimirs(&momentum(&state)), fluid.energy(&state));
    let turned = fluid.spatial_momentum(&state);
    let mut band = 0.0_f64;
    for _ in 0..200 {
        fluid.run(&mut state, 5).unwrap();
        for (now, then) in casimirs(&momentum(&state)).into_iter().zip(before) {
            assert!((now - then).abs() < 1e-11, "{now} {then}");
        }
        band = band.max((fluid.energy(&state) - energy).abs());
    }
    let moved = momentum(&state).iter().zip(start).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max);
    let off = fluid.spatial_momentum(&state).iter().zip(turned).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max);
    println!("fluid: energy {band:e} of {energy}, moved {moved}, momentum in space {off:e}");
    assert!(band < 1e-3 * energy && moved > 0.1 && off < 1e-11, "{band:e} {moved} {off:e}");
}

#[test]
fn mistakes_are_said() {
    let other = Declaration::parse(BY_LAGRANGIAN).unwrap();
    let sum = Declaration::sum(&[Declaration::parse(TOP).unwrap(), other]).unwrap_err().to_string();
    assert!(sum.contains("has all its terms in its text"), "{sum}");
    let stepper = of(GEODESIC, &[0.5], 0.1, "step");
    let moving = stepper.start(&IDENTITY, &[1.0, 0.0, 0.0]).map(|_| ()).unwrap_err().to_string();
    assert!(moving.contains("give a `momentum`"), "{moving}");
    let collocated = liestep_late::stepper::<Interpreter>(
        Declaration::parse(TOP).unwrap(),
        &[0.0; 17],
        0.1,
        "collocation 4".parse().unwrap(),
    );
    assert!(collocated.unwrap_err().to_string().contains("a composition of it"));
}
