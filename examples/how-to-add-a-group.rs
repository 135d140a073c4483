//! How to add a group: the affine maps `x ↦ a x + b` of the line, by generators, with its laws as tests and a Lagrangian.
//!
//! ```text
//! cargo run -p liestep-examples --example how-to-add-a-group
//! cargo test --example how-to-add-a-group         runs the laws, too
//! ```

use std::error::Error;

use liestep::groups::LieGroup as _;
use liestep::mechanics::Effect as _;
use liestep::nalgebra::{Matrix2, RealField, SMatrix, Vector2};
use liestep::{Stepper, lagrangian};

liestep::groups::matrix_group! {
    /// Matrices `[a, b; 0, 1]` with `a > 0`: `E_1` stretches, `E_2` shifts.
    pub type Affine = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]];

    /// The defect of a matrix, which is zero on the group.
    fn relation<T: RealField + Copy>(m: &SMatrix<T, 2, 2>) -> T {
        m[(1, 0)].abs() + (m[(1, 1)] - T::one()).abs()
    }
}

/// The laws of a group, of the retraction of its steps, and of its advected parameters. Each is a test.
#[cfg(test)]
mod laws {
    use super::Affine;

    liestep::lie_group_laws!(Affine);
    liestep::advected_laws!(Affine);

    mod cayley {
        liestep::retraction_laws!(super::Affine, liestep::groups::CayleyRetraction);
    }

    mod exponential {
        liestep::retraction_laws!(super::Affine, liestep::groups::ExponentialRetraction);
    }
}

/// A line that stretches and shifts by its inertia: `Affine!` passes the generators declared above.
#[lagrangian(group = Affine!, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug)]
struct Line {
    /// Inertia, kg m².
    J: Matrix2<f64>,
}

/// A spring at one point of the line; half of the action belongs to either end of a step.
#[lagrangian(group = Affine!, advected(w = covector), l_d = -0.25 * h * k * (w.dot(&r).powi(2) + w.dot(&(F * r)).powi(2)))]
#[derive(Clone, Copy, Debug)]
struct Spring {
    /// Stiffness, N/m.
    k: f64,
    /// The point, in the line's own coordinates: `(x, 1)`.
    r: Vector2<f64>,
    /// The covector in space that measures the point's position; in the line's frame it is `w`.
    covector: Vector2<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    // Construction checks that a matrix is in the group.
    let (f, g) = (Affine::<f64>::try_from(Matrix2::new(2.0, 1.0, 0.0, 1.0))?, Matrix2::new(3.0, 5.0, 0.0, 1.0));
    assert_eq!(f.compose(&g.try_into()?).matrix(), Matrix2::new(6.0, 11.0, 0.0, 1.0)); // 2 (3 x + 5) + 1
    assert!(Affine::<f64>::try_from(Matrix2::new(2.0, 1.0, 0.25, 1.0)).is_err());
    // The bracket [E_1, E_2] = E_2 is computed from the generators.
    assert_eq!(Affine::<f64>::lie_bracket(&Vector2::x(), &Vector2::y()), Vector2::y());

    println!("{}\n\n{}\n", Line::DERIVATION, Spring::DERIVATION);
    let (line, velocity) = (Line { J: Matrix2::new(1.0, 0.2, 0.2, 2.0) }, Vector2::new(0.1, 0.2));

    // Without the spring, the line conserves its momentum in space.
    let free = Stepper::new(line, 0.01)?;
    let mut state = free.start(Affine::identity(), velocity)?;
    let momentum = free.spatial_momentum(&state);
    free.run(&mut state, 1000)?;
    let lost = (free.spatial_momentum(&state) - momentum).norm();
    println!("after 10 s: momentum within {lost:.1e}, {:.1e} from the group", state.orthogonality_defect());
    assert!(lost < 1e-12 && state.orthogonality_defect() < 1e-12);

    // The energy error with the spring is of order h: on this group the kinetic term isn't self-adjoint.
    let held = line + Spring { k: 1.0, r: Vector2::new(1.0, 1.0), covector: Vector2::new(1.0, -0.5) };
    let error = |h, steps| -> Result<f64, Box<dyn Error>> {
        let stepper = Stepper::new(held, h)?;
        let mut state = stepper.start(Affine::identity(), velocity)?;
        let energy = stepper.energy(&state);
        stepper.run(&mut state, steps)?;
        Ok((stepper.energy(&state) - energy).abs() / energy)
    };
    let (coarse, fine) = (error(0.01, 100)?, error(0.005, 200)?);
    println!("with a spring: energy within {coarse:.1e}, with half of the step {fine:.1e}");
    assert!(!Line::FACTS.is_self_adjoint && (coarse / fine - 2.0).abs() < 0.1);
    Ok(())
}

#[test]
fn a_group_of_ones_own_moves() -> Result<(), Box<dyn Error>> {
    main()
}
