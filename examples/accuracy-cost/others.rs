//! Three scenes more, with other potentials; their references are runs of high order with much shorter steps.

use std::error::Error;

use declarations::motions::End;
use liestep::effects::{Dipole, Gravity, GravityGradient, PrincipalBody, Spring};
use liestep::mechanics::{DiagonalNonstandardInertia, DiscreteLagrangian, Regular};
use liestep::methods::{CompositionScheme, ExactBody, SymmetricBody};
use liestep::{NonstandardInertia, SO3, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

use crate::asked::{Question, asking};
use crate::methods::{self, Family};
use crate::scenes::Scene;

/// A scene that no file describes, and how it is asked for.
pub type Other = (Scene, Question);

/// All three.
pub fn all() -> Result<Vec<Other>, Box<dyn Error>> {
    let body = |moments| DiagonalNonstandardInertia::from_principal_moments(moments).map(|J_d| PrincipalBody { J_d });
    let satellite = body(Vector3::new(1.0, 2.5, 3.0))?;
    let J = NonstandardInertia::from(satellite.J_d).to_inertia();
    let gradient = GravityGradient { GM: 1.0, r: 1.0, J, direction: Vector3::z() };
    let rod = body(Vector3::new(0.4, 0.4, 0.02))?;
    let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.0, 0.0, 0.6), up: Vector3::z() };
    let anchor = Vector3::new(0.8, 0.0, 1.0);
    let spring = Spring { k: 30.0, length: 0.4, at: Vector3::z(), anchor };
    let needle = body(Vector3::new(1.0, 1.0, 0.2))?;
    let dipole = Dipole { moment: Vector3::new(0.0, 0.0, 2.0), field: Vector3::new(1.0, 0.0, 1.0) };
    Ok(vec![
        other("satellite", satellite + gradient, &satellite, [0.3, 0.9, 1.2], [-0.2, 0.5, 0.4])?,
        other("spring pendulum", rod + gravity + spring, &rod, [0.3, 1.2, 0.0], [0.5, 1.0, 2.0])?,
        other("compass needle", needle + dipole, &needle, [0.7, 0.2, 0.0], [0.1, -0.3, 1.5])?,
    ])
}

fn other<L>(
    name: &'static str,
    scene: L,
    body: &PrincipalBody,
    turn: [f64; 3],
    velocity: [f64; 3],
) -> Result<Other, Box<dyn Error>>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + Copy + 'static,
    L::Advected: 'static,
{
    let attitude = SO3::from(UnitQuaternion::from_scaled_axis(turn.into()));
    let velocity = Vector3::from(velocity);
    let states: Result<Vec<_>, Box<dyn Error>> =
        [10.0, 100.0].iter().map(|t| Ok((*t, reference(scene, attitude, velocity, *t)?))).collect();
    let J_d = body.J_d;
    let inertia = NonstandardInertia::from(J_d).to_inertia();
    let mut fixed = methods::declared("(3.13)", move |_| scene, 2);
    fixed.extend(if let Ok(body) = SymmetricBody::new(&inertia) {
        methods::splittings("exact", Family::Poisson, move |_| scene, move |_| Some(body))
    } else {
        let body = ExactBody::new(&inertia);
        methods::splittings("exact", Family::Poisson, move |_| scene, move |_| Some(body))
    });
    fixed.extend(methods::gauss(move |_| scene));
    let question = Question { ask: asking(scene, attitude, velocity), fixed };
    Ok((Scene::bare(name, J_d, *attitude.as_matrix(), velocity, states?), question))
}

/// The end after so long, by steps far shorter than any that is measured.
fn reference<L>(scene: L, attitude: SO3, velocity: Vector3<f64>, t: f64) -> Result<End, Box<dyn Error>>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + Clone,
{
    const A_SECOND: u32 = 100;
    let fine = Stepper::composed(scene, f64::from(A_SECOND).recip(), CompositionScheme::SOFRONIOU_SPALETTA_10)?;
    let mut state = fine.start(attitude, velocity)?;
    while fine.time(&state) < t - 1e-6 {
        fine.step(&mut state)?;
    }
    Ok((*state.attitude().as_matrix(), fine.velocity(&state)))
}
