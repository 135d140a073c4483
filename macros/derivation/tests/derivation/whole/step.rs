//! Whole steps of declarations: a motion that conserves what it has to, and refusals.

use liestep_derivation::whole::{StepRefusal, WholeStep};
use liestep_derivation::{Action, Array, Program, StagedDeclaration, Variance, staged};

use super::common::{Generators, Numbers, affine, carried, declared, sl3, sp4};
use crate::common::{HEAVY_TOP, top};

fn parsed(text: &str) -> StagedDeclaration {
    staged(&text.parse().expect("tokens"), u64::MAX).expect("a declaration").0
}

fn heavy_top() -> StagedDeclaration {
    parsed(&format!("#[lagrangian({HEAVY_TOP})] {}", top("NonstandardInertia")))
}

/// `E₁`, `E₂` and so on as a text.
fn listed(generators: &Generators) -> String {
    let n = generators[0].len().isqrt();
    let matrix = |e: &Vec<f64>| e.chunks(n).map(|row| format!("{row:?}")).collect::<Vec<_>>().join(", ");
    generators.iter().map(|e| format!("[{}]", matrix(e))).collect::<Vec<_>>().join(", ")
}

/// A free body on a group by generators, whose discrete Lagrangian is symmetric in time.
fn free(generators: &Generators) -> StagedDeclaration {
    let n = generators[0].len().isqrt();
    let half = |d: &str| format!("(({d}) * J * ({d}).transpose()).trace()");
    parsed(&format!(
        "#[lagrangian(group = Own, generators = [{}], l_d = ({} + {}) / (4.0 * h))] struct Body {{ J: SMatrix<f64, {n}, {n}> }}",
        listed(generators),
        half("F - I"),
        half("I - inverse(F)"),
    ))
}

fn size(x: &[f64]) -> f64 {
    x.iter().fold(0.0_f64, |size, x| size.max(x.abs()))
}

/// A step by its programs alone, with Newton's iteration to the end; returns the state after it.
fn stepped(step: &WholeStep, numbers: &Numbers<f64>, state: &[f64]) -> Vec<f64> {
    let (s, programs) = (&step.sizes, &step.programs);
    let numbers = numbers
        .with(Array::Attitude, &state[..s.entries])
        .with(Array::Momentum, &state[s.momentum()..s.advected()])
        .with(Array::Advected, &state[s.advected()..s.history()])
        .with(Array::History, &state[s.history()..s.guess()]);
    let target = numbers.run(&programs.target);
    let numbers = numbers.with(Array::Target, &target[..s.n]);
    let mut half = state[s.guess()..s.guess() + s.n].to_vec();
    for iteration in 0.. {
        let found = numbers.with(Array::Half, &half).run(&programs.iterate);
        half = found[..s.n].to_vec();
        if found[s.n] <= found[s.n + 1] * 1e-27 {
            break;
        }
        assert!(iteration < 12, "Newton's iteration converges");
    }
    let mut end = numbers.with(Array::Half, &half).run(&programs.finish);
    end.truncate(s.state() - 1);
    end
}

/// Ten steps with these parameters: the initial state, and that after them.
fn run(
    declaration: &StagedDeclaration,
    parameters: &[f64],
    velocity: &[f64],
) -> (WholeStep, Numbers<f64>, [Vec<f64>; 2]) {
    let step = WholeStep::of(declaration).expect("a step");
    let (s, programs) = (&step.sizes, &step.programs);
    let h = 0.02;
    let numbers = Numbers(vec![(Array::Step, vec![h]), (Array::Parameters, parameters.to_vec())]);
    let constants = numbers.run(&programs.constants);
    let identity = |n: usize| (0..n * n).map(move |at| f64::from(u8::from(at / n == at % n)));
    let attitude: Vec<f64> = step.factors.iter().flat_map(|f| identity(f.size())).collect();
    let numbers = numbers.with(Array::Constants, &constants);
    let advected = numbers.with(Array::Attitude, &attitude).run(&programs.seen);
    let momentum = numbers.with(Array::Velocity, velocity).with(Array::Advected, &advected).run(&programs.momentum);
    let half: Vec<f64> = velocity.iter().map(|v| v * h / 2.0).collect();
    let start = [attitude, momentum, advected, half.clone(), vec![0.0; s.n], half].concat();
    let mut state = start.clone();
    for _ in 0..10 {
        state = stepped(&step, &numbers, &state);
    }
    (step, numbers, [start, state])
}

#[test]
fn free_bodies_keep_their_momentum_in_space_and_their_group() {
    for (name, generators) in [("SL(3)", sl3()), ("Sp(4)", sp4()), ("planar affine", affine(2))] {
        let n = generators[0].len().isqrt();
        let J: Vec<f64> = (0..n * n)
            .map(|at| if at / n == at % n { 1.0 + 0.2 * f64::from(u8::try_from(at % n).expect("small")) } else { 0.1 })
            .collect();
        let velocity: Vec<f64> = (0..generators.len()).map(|k| [0.4, -0.7, 0.2, 0.6][k % 4]).collect();
        let (step, numbers, states) = run(&free(&generators), &J, &velocity);
        let s = &step.sizes;
        let [before, after] = states.each_ref().map(|state| {
            let numbers = numbers.with(Array::Attitude, &state[..s.entries]);
            assert!(numbers.run(&step.programs.defect)[0] < 1e-13, "{name}");
            numbers.with(Array::Momentum, &state[s.momentum()..s.advected()]).run(&step.programs.spatial)
        });
        let change: Vec<f64> = before.iter().zip(&after).map(|(a, b)| a - b).collect();
        assert!(size(&change) < 1e-13 * size(&before), "{name}: {change:?}");
        let body: Vec<f64> = states[0].iter().zip(&states[1]).map(|(a, b)| a - b).collect();
        assert!(size(&body[s.momentum()..s.advected()]) > 1e-3, "{name} is moving");
        // The velocity of the initial momentum is the initial velocity, and the energy is that of its half.
        let momentum = states[0][s.momentum()..s.advected()].to_vec();
        let numbers = numbers.with(Array::Momentum, &momentum).with(Array::Velocity, &velocity);
        let found = numbers.run(&step.programs.velocity);
        let missed: Vec<f64> = found.iter().zip(&velocity).map(|(a, b)| a - b).collect();
        assert!(size(&missed) < 1e-12, "{name}: {missed:?}");
        let energy = numbers.run(&step.programs.energy)[0];
        let power = momentum.iter().zip(&velocity).fold(0.0, |sum, (a, b)| sum + a * b);
        assert!((energy - 0.5 * power).abs() < 1e-12 * energy, "{name}");
    }
}

/// The top (3.13) keeps its vertical momentum, and its energy to the order of the method.
#[test]
fn the_heavy_top() {
    let J_d = [2.0, 0.1, -0.2, 0.1, 2.5, 0.3, -0.2, 0.3, 3.0];
    let parameters = [&J_d[..], &[1.5, 9.81], &[0.1, -0.2, 0.4], &[0.0, 0.0, 1.0]].concat();
    let (step, numbers, states) = run(&heavy_top(), &parameters, &[0.7, -1.1, 4.0]);
    let s = &step.sizes;
    assert_eq!((s.n, s.entries, s.carried, s.dets, s.near, s.attitudes, s.state()), (3, 9, 3, 1, 1, 1, 25));
    let [before, after] = states.each_ref().map(|state| {
        let (momentum, w) = (&state[s.momentum()..s.advected()], &state[s.advected()..s.history()]);
        let numbers = numbers.with(Array::Momentum, momentum).with(Array::Advected, w);
        let velocity = numbers.run(&step.programs.velocity);
        let vertical = momentum.iter().zip(w).fold(0.0, |sum, (a, b)| sum + a * b);
        [vertical, numbers.with(Array::Velocity, &velocity).run(&step.programs.energy)[0]]
    });
    assert!((before[0] - after[0]).abs() < 1e-13 && (before[1] - after[1]).abs() < 1e-3 * before[1]);
    assert!((states[0][11] - states[1][11]).abs() > 1e-2, "it is moving");
}

/// A limit that isn't quadratic has the relativistic momentum and energy.
#[test]
fn a_relativistic_particle() {
    let declaration = parsed(
        "#[lagrangian(group = R3, velocity = xi, l = -m * (1.0 - xi.norm_squared()).sqrt(), discretise = trapezoid(Cayley))] struct Particle { m: f64 }",
    );
    let step = WholeStep::of(&declaration).expect("a step");
    let xi = [0.3, -0.4, 0.5_f64];
    let numbers =
        Numbers(vec![(Array::Parameters, vec![2.0]), (Array::Velocity, xi.to_vec()), (Array::Advected, Vec::new())]);
    let root = 0.5_f64.sqrt();
    let momentum = numbers.run(&step.programs.momentum);
    assert!(momentum.iter().zip(xi).all(|(p, xi)| (p - 2.0 * xi / root).abs() < 1e-14), "{momentum:?}");
    assert!((numbers.run(&step.programs.energy)[0] - 2.0 / root).abs() < 1e-14);
    let hessian = numbers.run(step.programs.hessian.as_ref().expect("a Hessian"));
    assert!((hessian[1] - 2.0 * xi[0] * xi[1] / root.powi(3)).abs() < 1e-14);
    assert!(WholeStep::of(&heavy_top()).expect("a step").programs.hessian.is_none());
}

#[test]
fn programs_are_the_same_in_every_run() {
    let programs = || WholeStep::of(&heavy_top()).expect("a step").programs;
    assert_eq!(programs(), programs());
}

#[test]
fn refusals_say_what_to_write() {
    let refused = |staged: &StagedDeclaration| match WholeStep::of(staged) {
        Ok(step) => panic!("{} operations", step.programs.iterate.operations.len()),
        Err(refusal) => refusal,
    };
    let gravity = parsed(
        "#[lagrangian(group = SO3, advected(w = up), l_d = -h * m * w.dot(&rho))] struct Gravity { m: f64, rho: Vector3<f64>, up: Vector3<f64> }",
    );
    assert_eq!(refused(&gravity), StepRefusal::NoKinetic);
    // The Cayley map of a nilpotent matrix `N` with `N³ ≠ 0 = N⁴` leaves its one-dimensional group.
    let mut shift = vec![0.0; 16];
    (0..3).for_each(|i| shift[i * 4 + i + 1] = 1.0);
    assert_eq!(refused(&declared(&[vec![shift]], Vec::new())), StepRefusal::Cube { generator: 0 });
    let twice = vec![sl3()[0].clone(), sl3()[0].clone()];
    assert_eq!(refused(&declared(&[twice], Vec::new())), StepRefusal::Dependent);
    // Declarations with too many operations: one of many dimensions, and one with many tensors.
    let tensors = carried(&vec![(Action::Moved(Variance::Covariant, 0), (4, 4)); 600]);
    for large in [declared(&[affine(8)], Vec::new()), declared(&[affine(3)], tensors)] {
        let refusal = refused(&large);
        assert!(matches!(refusal, StepRefusal::TooLong { .. }) && refusal.to_string().contains("smaller group"));
    }
}

/// A step whose Jacobian has two entries exchanged gets no certificate.
#[test]
fn what_is_wrong_is_refused() {
    for places in [[3, 4], [0, 1], [5, 9]] {
        let mut wrong = heavy_top();
        wrong.programs.newton_system.outputs.swap(places[0], places[1]);
        let refusal = WholeStep::of(&wrong).expect_err("no step");
        assert_eq!(refusal, StepRefusal::Wrong { claim: "an iteration isn't Newton's" });
    }
}

/// Counts of the operations of a step, to be changed with care.
#[test]
fn operations_of_a_step() {
    let count = |program: &Program| program.operations.len();
    let programs = WholeStep::of(&heavy_top()).expect("a step").programs;
    let counts = [&programs.target, &programs.iterate, &programs.again, &programs.finish].map(count);
    assert_eq!(counts, [17, 167, 93, 151]);
}
