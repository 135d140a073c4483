//! Properties of structure-preserving steps: symplectic transition matrices, and adjoints by steps of `−h`.

use liestep::effects::{Gravity, PrincipalBody};
use liestep::gradients::{Cotangent, Gradient, Linearisable, Tape};
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia, Sum, Term as _, inertia};
use liestep::methods::{
    CompositionScheme, ExactBody, ProcessedScheme, ProcessedSplitting, Splitting, SplittingScheme, SymmetricBody,
};
use liestep::{SO3, StepError, Stepper};
use nalgebra::{SMatrix, Vector3};

type Matrix6 = SMatrix<f64, 6, 6>;

type Top = Sum<PrincipalBody, Gravity>;

fn top() -> Top {
    let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).expect("a body");
    PrincipalBody { J_d } + Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.2, 0.4), up: Vector3::z() }
}

fn start() -> (SO3, Vector3<f64>) {
    (
        SO3::from_matrix_unchecked(*nalgebra::Rotation3::new(Vector3::new(0.8, 0.0, 0.0)).matrix()),
        Vector3::new(1.0, 6.0, 27.0),
    )
}

/// The form `Ω(μ)` on `(ζ, δμ)`: `⟨δμ', ζ⟩ − ⟨δμ, ζ'⟩ + ⟨μ, [ζ, ζ']⟩`, up to a common sign.
fn form(momentum: &Vector3<f64>) -> Matrix6 {
    let mut form = Matrix6::zeros();
    form.fixed_view_mut::<3, 3>(0, 0).copy_from(&momentum.cross_matrix());
    for k in 0..3 {
        (form[(k, k + 3)], form[(k + 3, k)]) = (-1.0, 1.0);
    }
    form
}

#[test]
fn the_transition_matrix_keeps_the_symplectic_form() {
    assert_symplectic(&Stepper::new(top(), 0.01).expect("a stepper"), 10.0);
    for beside in [0.0, 0.2] {
        assert_symplectic(&symmetric(beside), 5.0);
    }
    assert_symplectic(&exact(top(), 0.01, SplittingScheme::NYSTROM_6), 10.0);
    assert_symplectic(&exact(top(), 0.01, SplittingScheme::FORCE_GRADIENT_5), 10.0);
    assert_symplectic(&processed(ProcessedScheme::SIX_A, 0.01), 10.0);
    assert_symplectic(&processed(ProcessedScheme::FOUR_C, 0.01), 10.0);
}

/// A splitting with an exact flow; with the weight on the axis, its spin is merged.
fn symmetric(beside: f64) -> Stepper<Top, Splitting<Top, SymmetricBody>> {
    let moments = Vector3::new(3.0, 3.0, 4.5);
    let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(moments).expect("a body") };
    let scene = body + Gravity { rho: Vector3::new(beside, 0.0, 0.4), ..top().second };
    let flow =
        SymmetricBody::new(&Inertia::from_principal_moments(moments).expect("a body")).expect("a symmetric body");
    Stepper::split(scene, 0.01, flow, SplittingScheme::NYSTROM_6).expect("a stepper")
}

fn exact(scene: Top, h: f64, scheme: SplittingScheme) -> Stepper<Top, Splitting<Top, ExactBody>> {
    Stepper::split(scene, h, exact_body(&scene), scheme).expect("a stepper")
}

fn processed(scheme: ProcessedScheme, h: f64) -> Stepper<Top, ProcessedSplitting<Top, ExactBody>> {
    Stepper::processed(top(), h, exact_body(&top()), scheme).expect("a stepper")
}

fn exact_body(scene: &Top) -> ExactBody {
    ExactBody::new(&Inertia::new(inertia(scene, &scene.advected())).expect("a body"))
}

/// Both flows are the motion of a symmetric body, by independent formulas.
#[test]
fn exact_flows_of_a_symmetric_body_agree() {
    let symmetric = symmetric(0.2);
    let exact = exact(*symmetric.scene(), symmetric.step_size(), SplittingScheme::NYSTROM_6);
    let (linear, other) = (symmetric.linearised().expect("derivatives"), exact.linearised().expect("derivatives"));
    let scene: Vec<usize> = (0..17).collect();
    // The derivatives with respect to both transverse moments, and to the axial one.
    let mut tangent = linear.tangent(&[&scene[..], &[17, 18]].concat());
    let mut by_exact = other.tangent(&[&scene[..], &[17, 18, 19]].concat());
    let (attitude, momentum) = start();
    let mut state = symmetric.start_with_momentum(attitude, momentum).expect("a start");
    let mut also = exact.start_with_momentum(attitude, momentum).expect("a start");
    for _ in 0..100 {
        linear.step(&mut state, &mut tangent).expect("a step");
        other.step(&mut also, &mut by_exact).expect("a step");
    }
    let (expected, mut found) = (tangent.columns().collect::<Vec<_>>(), by_exact.columns().collect::<Vec<_>>());
    let second = found.remove(24);
    found[23] = (found[23].0 + second.0, found[23].1 + second.1);
    let size = expected.iter().fold(0.0_f64, |size, column| size.max(column.0.amax()).max(column.1.amax()));
    for (number, (found, expected)) in found.iter().zip(&expected).enumerate() {
        let error = (found.0 - expected.0).amax().max((found.1 - expected.1).amax());
        assert!(error < 1e-12 * size, "column {number}: {error:e} of {size:e}");
    }
}

/// Checks a transition matrix with entries of this size.
fn assert_symplectic<P: Linearisable<Top>>(stepper: &Stepper<Top, P>, size: f64) {
    let linear = stepper.linearised().expect("derivatives");
    let (attitude, momentum) = start();
    let mut state = stepper.start_with_momentum(attitude, momentum).expect("a start");
    let mut tangent = linear.tangent(&[]);
    for _ in 0..1000 {
        linear.step(&mut state, &mut tangent).expect("a step");
    }
    let [[a, b], [c, d]] = tangent.transition();
    let mut transition = Matrix6::zeros();
    for (place, block) in [((0, 0), a), ((0, 3), b), ((3, 0), c), ((3, 3), d)] {
        transition.fixed_view_mut::<3, 3>(place.0, place.1).copy_from(&block);
    }
    let kept = transition.transpose() * form(&state.momentum()) * transition;
    let defect = (kept - form(&momentum)).amax();
    println!("defect {defect:e}, entries up to {:e}", transition.amax());
    assert!(transition.amax() > size && defect < 1e-12, "{defect:e}");
}

/// A gradient by steps of `−h` and its distance from that by the tape, relative to the largest entry.
fn parting<P>(stepper: &Stepper<Top, P>, steps: u64) -> f64
where
    P: Linearisable<Top>,
{
    let linear = stepper.linearised().expect("derivatives");
    let (attitude, momentum) = start();
    let state = stepper.start_with_momentum(attitude, momentum).expect("a start");
    let cost = |n: u64, motion: &liestep::motion::Motion<SO3, ((), Vector3<f64>)>| {
        let height = Cotangent { attitude: -motion.advected().1.cross(&Vector3::z()), momentum: Vector3::z() };
        if n == steps { height } else { Cotangent::zero() }
    };
    let taped = linear.adjoint(&mut { state }, steps, Tape::SquareRoot, cost).expect("a gradient");
    let reversed = linear.backwards().expect("steps back").adjoint(&mut { state }, steps, cost).expect("a gradient");
    let entries = |gradient: &Gradient<Vector3<f64>, f64>| -> Vec<f64> {
        let start = gradient.start.attitude.iter().chain(gradient.start.momentum.iter());
        start.chain(&gradient.parameters).copied().collect()
    };
    let (taped, reversed) = (entries(&taped), entries(&reversed));
    let largest = taped.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    let error = taped.iter().zip(&reversed).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
    println!("{steps} steps: {error:e} of {largest:e}");
    error / largest
}

#[test]
fn steps_back_give_the_gradient_of_the_tape() {
    let stepper = Stepper::new(top(), 0.01).expect("a stepper");
    assert!(parting(&stepper, 1_000) < 1e-12);
    assert!(parting(&stepper, 100_000) < 1e-10);
}

#[test]
fn steps_back_of_a_splitting() {
    for beside in [0.0, 0.2] {
        assert!(parting(&symmetric(beside), 1_000) < 1e-12);
    }
    assert!(parting(&exact(top(), 0.01, SplittingScheme::NYSTROM_6), 1_000) < 1e-12);
    assert!(parting(&exact(top(), 0.01, SplittingScheme::FORCE_GRADIENT_5), 1_000) < 1e-12);
}

/// The processor of both directions is that of `|h|`.
#[test]
fn steps_back_of_a_processed_splitting() {
    for scheme in ProcessedScheme::ALL {
        for h in [0.01, -0.01] {
            assert!(parting(&processed(scheme, h), 1_000) < 1e-12, "{}, {h}", scheme.name());
        }
    }
}

#[test]
fn steps_back_of_a_composition() {
    let stepper = Stepper::composed(top(), 0.01, CompositionScheme::SUZUKI_4).expect("a stepper");
    assert!(parting(&stepper, 1_000) < 1e-12);
}

/// After some good steps and a push the next step has no solution: state, memory, and tangent stay unchanged, although
/// the first stages of a composition are solvable.
#[test]
fn a_step_without_a_solution_changes_nothing() {
    assert_unchanged(&Stepper::new(top(), 0.05).expect("a stepper"), 150.0);
    assert_unchanged(&Stepper::composed(top(), 0.05, CompositionScheme::SUZUKI_4).expect("a stepper"), 175.0);
}

fn assert_unchanged<P: Linearisable<Top>>(stepper: &Stepper<Top, P>, impulse: f64) {
    let linear = stepper.linearised().expect("derivatives");
    let mut state = stepper.start_with_momentum(start().0, Vector3::new(0.1, 0.2, 3.0)).expect("a start");
    let mut tangent = linear.tangent(&[0]);
    for _ in 0..3 {
        linear.step(&mut state, &mut tangent).expect("a step");
    }
    // A forced step has half of its impulse before it.
    stepper.step_forced(&mut state, &(Vector3::z() * (impulse / stepper.step_size()))).expect("a step");
    let (before, columns) = (state, tangent.columns().collect::<Vec<_>>());
    let error = linear.step(&mut state, &mut tangent).expect_err("it is too fast");
    assert!(matches!(error, StepError::BeyondSolvable { .. }), "{error}");
    assert_eq!(state, before);
    assert_eq!(tangent.columns().collect::<Vec<_>>(), columns);
}
