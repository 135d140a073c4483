//! Plans of declarations whose steps are data: those of the typed stepper, and known answers on other groups.

use liestep::effects::RigidBody;
use liestep::gradients::Plant as _;
use liestep::mechanics::Effect as _;
use liestep::motion::Propagator as _;
use liestep::with::Method;
use liestep_control::{Control, Target, Verdict};
use liestep_late::{Declaration, Whole, numbers};

use super::{body, slew, torques};

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

#[test]
fn a_plan_of_a_text_is_that_of_the_stepper() {
    let stepper = body([2.0, 3.0, 4.0], 0.05);
    let expected = slew(&stepper, 40, [0.7, -0.9, 0.4]).solve().expect("a task");
    let declaration = Declaration::parse(RigidBody::<f64>::DECLARATION).expect("a declaration");
    let values = declaration.described(&numbers(stepper.scene())).expect("numbers");
    let whole: Whole = Whole::of(declaration, &values, 0.05, Method::default()).expect("a stepper");
    let start = whole.start(&IDENTITY, &[0.0; 3]).expect("a start");
    let goal = super::turned([0.7, -0.9, 0.4]);
    let attitude = goal.as_matrix().transpose().as_slice().to_vec();
    let target = Target { attitude: Some(attitude), momentum: Some(vec![0.0; 3]) };
    let plan = Control::new(&whole, start, 40, target).solve().expect("a task");
    assert_eq!((&plan.verdict, &expected.verdict), (&Verdict::Converged, &Verdict::Converged));
    assert!((plan.cost / expected.cost - 1.0).abs() < 1e-12, "{} {}", plan.cost, expected.cost);
    for (found, expected) in plan.inputs.iter().zip(torques(&expected)) {
        let difference = found.iter().zip(expected.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(difference < 1e-8, "{difference:e}");
    }
}

/// The entries of a matrix that aren't zero.
type Matrix = [(usize, usize, f64)];
/// Name, rows, generators, metric, the direction of a motion, and its inertia.
type Case<'a> = (&'a str, usize, &'a [&'a Matrix], &'a [f64], usize, f64);

/// A group by its generators, and a metric `tr(E J Eᵀ)`.
struct FreeMotion {
    stepper: Whole,
    identity: Vec<f64>,
}

impl FreeMotion {
    fn on(n: usize, generators: &[&Matrix], h: f64, diagonal: &[f64]) -> Self {
        let row = |row: &[f64]| format!("{row:?}");
        let matrix = |entries: &&Matrix| {
            let mut matrix = vec![0.0; n * n];
            entries.iter().for_each(|&(i, j, entry)| matrix[i * n + j] = entry);
            format!("[{}]", matrix.chunks(n).map(row).collect::<Vec<_>>().join(", "))
        };
        let all = generators.iter().map(matrix).collect::<Vec<_>>().join(", ");
        let text = format!(
            "#[lagrangian(group = Own, generators = [{all}], l_d = ((F - I) * J * (F - I).transpose()).trace() / (2 * h))]
             struct Free {{ J: SMatrix<f64, {n}, {n}> }}"
        );
        let J: Vec<f64> = (0..n * n).map(|at| if at / n == at % n { diagonal[at / n] } else { 0.0 }).collect();
        let declaration = Declaration::parse(&text).expect("a declaration");
        let numbers = declaration.numbers(&[("J", &J)]).expect("numbers");
        let stepper = Whole::of(declaration, &numbers, h, Method::default()).expect("a stepper");
        let identity = (0..n * n).map(|at| f64::from(u8::from(at / n == at % n))).collect();
        Self { stepper, identity }
    }

    /// The state at rest at `exp ξ̂`.
    fn at(&self, xi: &[f64]) -> Box<[f64]> {
        let state = self.stepper.start(&self.identity, &vec![0.0; xi.len()]).expect("a start");
        self.stepper.displaced(&state, &[xi, &vec![0.0; xi.len()]].concat()).expect("a state")
    }
}

fn rotations_of_four() -> [&'static Matrix; 6] {
    [
        &[(0, 1, -1.0), (1, 0, 1.0)],
        &[(0, 2, -1.0), (2, 0, 1.0)],
        &[(0, 3, -1.0), (3, 0, 1.0)],
        &[(1, 2, -1.0), (2, 1, 1.0)],
        &[(1, 3, -1.0), (3, 1, 1.0)],
        &[(2, 3, -1.0), (3, 2, 1.0)],
    ]
}

/// The least effort from rest to rest along a one-parameter group with the inertia `J` is `6 J² θ²/T³`.
#[test]
fn the_least_effort_on_groups_of_texts() {
    let plane: [&Matrix; 3] = [&[(1, 0, 1.0), (0, 1, -1.0)], &[(0, 2, 1.0)], &[(1, 2, 1.0)]];
    let cases: [Case<'_>; 3] = [
        ("a rotation of four dimensions", 4, &rotations_of_four(), &[1.0; 4], 0, 2.0),
        ("a translation of the plane", 3, &plane, &[1.0, 1.0, 3.0], 1, 3.0),
        ("a turn of the plane", 3, &plane, &[1.0, 1.0, 3.0], 0, 2.0),
    ];
    for (name, n, generators, diagonal, along, inertia) in cases {
        let error = |steps: u32| {
            let free = FreeMotion::on(n, generators, 2.0 / f64::from(steps), diagonal);
            let mut xi = vec![0.0; generators.len()];
            xi[along] = 0.8;
            let (start, end) = (free.at(&vec![0.0; xi.len()]), free.at(&xi));
            let target = Target { attitude: Some(free.stepper.attitude(&end)), momentum: Some(vec![0.0; xi.len()]) };
            let plan = Control::new(&free.stepper, start, steps as usize, target).solve().expect("a task");
            assert_eq!(plan.verdict, Verdict::Converged, "{name}");
            plan.cost / (6.0 * inertia * inertia * 0.64 / 8.0) - 1.0
        };
        let [coarse, fine] = [20, 40].map(error);
        // A translation isn't discretised.
        let ratio = coarse / fine;
        assert!(fine.abs() < 2e-3 && (ratio - 4.0).abs() < 0.05, "{name}: {coarse:e} {fine:e}");
    }
}

/// The multipliers are the derivatives of the least cost by the target, on SO(4) with an asymmetric metric.
#[test]
fn multipliers_on_a_group_of_a_text() {
    let free = FreeMotion::on(4, &rotations_of_four(), 0.1, &[1.0, 1.3, 0.7, 2.0]);
    let xi = [0.3, -0.2, 0.4, 0.1, 0.5, -0.3];
    let end = free.at(&xi);
    let cost = |change: &[f64]| {
        let end = free.stepper.displaced(&end, change).expect("a state");
        let (attitude, momentum) = (free.stepper.attitude(&end), free.stepper.momentum(&end));
        let target = Target { attitude: Some(attitude), momentum: Some(momentum) };
        let plan = Control::new(&free.stepper, free.at(&[0.0; 6]), 20, target).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged);
        plan
    };
    let plan = cost(&[0.0; 12]);
    // Two turns and two momenta: each takes two plans.
    for k in [1, 4, 7, 10] {
        let beside = |by: f64| {
            let mut change = [0.0; 12];
            change[k] = by;
            cost(&change).cost
        };
        let slope = (beside(1e-4) - beside(-1e-4)) / 2e-4;
        let found = -plan.multipliers[k];
        assert!((found - slope).abs() < 1e-6 * (1.0 + slope.abs()), "{k}: {found}, not {slope}");
    }
}
