//! The energy `½ p·J⁻¹p` of a free body is an exact invariant of (3.13), as is the spatial momentum `R p`; what is left
//! is rounding, at random and less than one a step, so 10⁻¹⁴ after hundreds of steps and 10⁻¹³ after ten thousands; for
//! bodies and steps on which an explicit, an implicit or a rescaling update fails.

use declarations::FreeBody;
use liestep::groups::LieGroup as _;
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::{Matrix3, Vector3};

/// Largest relative errors of the energy and of the spatial momentum, and the most Newton iterations after the first
/// step, which starts without a guess.
struct Errors {
    energy: f64,
    momentum: f64,
    iterations: u32,
}

fn errors(body: FreeBody, velocity: [f64; 3], h: f64, steps: u32) -> Errors {
    let stepper = Stepper::new(body, h).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::from(velocity)).unwrap();
    let (energy, momentum) = (stepper.energy(&state), state.spatial_momentum());
    let mut worst = Errors { energy: 0.0, momentum: 0.0, iterations: 0 };
    for step in 0..steps {
        let iterations = stepper.step(&mut state).unwrap().iterations;
        if step > 0 {
            worst.iterations = worst.iterations.max(iterations);
        }
        worst.energy = worst.energy.max((stepper.energy(&state) / energy - 1.0).abs());
        worst.momentum = worst.momentum.max((state.spatial_momentum() - momentum).norm() / momentum.norm());
    }
    println!("{velocity:?}: energy {:.1e}, momentum {:.1e}", worst.energy, worst.momentum);
    worst
}

/// A box of 1 kg with half-extents 0.1, 0.2, 0.3: `J_d = m/3 diag(a², b², c²)`.
fn box_body() -> FreeBody {
    let diagonal = Vector3::new(0.01, 0.04, 0.09) / 3.0;
    FreeBody { J_d: NonstandardInertia::from_diagonal(diagonal).unwrap() }
}

/// A cylinder of 1 kg and 1 m length about its centre.
fn rod(slenderness: f64) -> FreeBody {
    let diameter = 1.0 / slenderness;
    let across = diameter * diameter / 16.0;
    FreeBody { J_d: NonstandardInertia::from_diagonal(Vector3::new(across, across, 1.0 / 12.0)).unwrap() }
}

#[test]
fn b1_box() {
    let errors = errors(box_body(), [1.0, 2.0, 3.0], 0.01, 500);
    assert!(errors.energy <= 1e-14, "{:e}", errors.energy);
    assert!(errors.momentum <= 1e-14, "{:e}", errors.momentum);
}

#[test]
fn b2_box_about_its_middle_axis() {
    let errors = errors(box_body(), [0.05, 5.0, 0.05], 0.005, 20_000);
    assert!(errors.energy <= 1e-13, "{:e}", errors.energy);
    assert!(errors.momentum <= 1e-13, "{:e}", errors.momentum);
}

/// The first axis has the largest moment: the spin is stable, and stays within the angle of its start.
#[test]
fn b2_box_spinning_fast_about_a_stable_axis() {
    let velocity = [20.0, 0.05, 0.05];
    let errors = errors(box_body(), velocity, 0.005, 20_000);
    assert!(errors.energy <= 1e-13, "{:e}", errors.energy);
    assert!(errors.momentum <= 1e-13, "{:e}", errors.momentum);

    let stepper = Stepper::new(box_body(), 0.005).unwrap();
    let mut state = stepper.start(SO3::identity(), Vector3::from(velocity)).unwrap();
    for _ in 0..20_000 {
        stepper.step(&mut state).unwrap();
        assert!(stepper.velocity(&state).x > 19.99);
    }
}

#[test]
fn b3_thin_rods_at_60_hertz() {
    for slenderness in [1e2, 1e4] {
        let errors = errors(rod(slenderness), [1.0, 0.5, 3.0], 1.0 / 60.0, 10_000);
        assert!(errors.energy <= 1e-13, "1 : {slenderness}, {:e}", errors.energy);
        assert!(errors.momentum <= 1e-13, "1 : {slenderness}, {:e}", errors.momentum);
    }
}

#[test]
fn b3_flat_plate_and_extreme_ratio() {
    for moments in [[1.0, 2.0, 3.0], [1e-6, 1.0, 1.000_001]] {
        let errors = errors(FreeBody::with_moments(moments), [1.0, 0.5, 0.3], 1.0 / 60.0, 10_000);
        assert!(errors.energy <= 1e-13, "{moments:?}, {:e}", errors.energy);
        assert!(errors.momentum <= 1e-13, "{moments:?}, {:e}", errors.momentum);
    }
}

/// A sphere turns uniformly: the last increment is the next one, so one iteration confirms it.
#[test]
fn b4_sphere() {
    let errors = errors(FreeBody::with_moments([0.4; 3]), [1.0, 2.0, 3.0], 0.01, 10_000);
    assert_eq!(errors.iterations, 1);
    assert!(errors.energy == 0.0, "{:e}", errors.energy);
}

/// Full tensors, too: the principal axes don't have to be those of the frame.
#[test]
fn b5_full_tensor_keeps_its_energy() {
    let axes: Matrix3<f64> = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1).into_inner();
    let turned = axes * box_body().J_d.as_matrix() * axes.transpose();
    let errors = errors(FreeBody { J_d: NonstandardInertia::new(turned).unwrap() }, [1.0, 2.0, 3.0], 0.01, 500);
    assert!(errors.energy <= 1e-14, "{:e}", errors.energy);
}
