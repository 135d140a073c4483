//! A flyer with a load on a cable.

use liestep::gradients::Input;
use liestep::groups::R3;
use liestep::mechanics::{Sum, Term as _};
use liestep::numbers::Entries as _;
use liestep::{NonstandardInertia, SO3, Stepper, force, lagrangian};
use liestep_control::{Control, Target};
use nalgebra::{SVector, Vector3};
use workbench::drawing::path;
use workbench::plot::{BLUE, Line, ORANGE, PURPLE};

use crate::{Drawing, Part, found, given, picture};

/// A flyer of mass `m`, and a load of mass `m_load` on a cable that is always taut and turns with the load.
#[lagrangian(
    group(F = SO3, d = R3, C = SO3),
    advected(x = d.seen_from(space), R = C.seen_from(space)),
    gradients,
    l_d = {
        let way = d + R * ((C - I) * cable);
        let place = x + R * cable;
        ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
            + ((C - I) * K * (C - I).transpose()).trace() / (2.0 * h) + m_load * way.norm_squared() / (2.0 * h)
            - 0.5 * h * g * (m * (x + x + d) + m_load * (place + place + way)).z
    },
)]
#[derive(Clone, Debug)]
pub(crate) struct FlyerWithLoad {
    J_d: NonstandardInertia,
    m: f64,
    K: NonstandardInertia,
    m_load: f64,
    cable: Vector3<f64>,
    g: f64,
}

/// Rotors with constant forces over a step: a thrust along the flyer's third axis, N, and a torque in its axes, as the
/// angular acceleration, rad/s², of the moment `inertia`. So both numbers are of one size, and both count in the
/// effort.
#[force(
    group(F = SO3, d = R3, C = SO3),
    advected(S = F.seen_from(space)),
    displacement(eta, s, c),
    given(u = thrust, a = acceleration),
    gradients,
    work = 0.5 * h * (inertia * a.dot(&(eta + eta_next)) + u * ((S * axis).dot(&s) + (S * (F * axis)).dot(&s_next))),
)]
#[derive(Clone, Debug)]
pub(crate) struct Rotors {
    thrust: f64,
    acceleration: Vector3<f64>,
    inertia: f64,
    axis: Vector3<f64>,
}

/// The plan that moves a load by two metres to the side and one up, from rest to rest.
pub(crate) fn load() -> Drawing {
    let (steps, seconds) = (100, 2.0);
    let body = |moments: [f64; 3]| NonstandardInertia::from_principal_moments(Vector3::from(moments));
    let (J_d, K, cable) = (body([0.02, 0.02, 0.035])?, body([0.002, 0.002, 0.001])?, Vector3::z() * -0.8);
    let rotors = Rotors { thrust: 1.4 * 9.81, acceleration: Vector3::zeros(), inertia: 0.02, axis: Vector3::z() };
    let scene: Sum<FlyerWithLoad, Rotors> = FlyerWithLoad { J_d, m: 1.0, K, m_load: 0.4, cable, g: 9.81 } + rotors;
    let stepper = Stepper::new(scene, seconds / f64::from(steps))?;
    let at = |place: Vector3<f64>| (SO3::identity(), R3::from(place), SO3::identity());
    let start = stepper.start(at(Vector3::zeros()), SVector::<f64, 9>::zeros())?;
    let like = Input::Values(stepper.scene().advected());
    let mut scalars = 0;
    stepper.scene().advected().each(&mut |_: f64| scalars += 1);
    let plan = Control::new(&stepper, start, 100, Target::rest(at(Vector3::new(2.0, 0.0, 1.0))))
        .input(like, scalars - 4..scalars)
        .bounds(|_, input| if input == 0 { (4.0, 24.0) } else { (-30.0, 30.0) })
        .guess(|_, input| if input == 0 { 1.4 * 9.81 } else { 0.0 })
        .solve()?;
    let report = format!("{}; effort {:.1}", found(&plan)?, plan.cost);
    let places = |of_load: bool| -> Vec<(f64, f64)> {
        let place = |attitude: (SO3, R3, SO3)| {
            let place = attitude.1.translation();
            if of_load { place + attitude.2.as_matrix() * cable } else { place }
        };
        plan.states.iter().map(|state| place(state.attitude())).map(|place| (place.x, place.z)).collect()
    };
    let mut lines = vec![
        Line { colour: BLUE, width: 4, points: places(false) },
        Line { colour: ORANGE, width: 4, points: places(true) },
    ];
    // The cable at ten times.
    for (flyer, load) in places(false).into_iter().zip(places(true)).step_by(10) {
        lines.push(Line { colour: PURPLE, width: 1, points: vec![flyer, load] });
    }
    let numbers = |input: &Input<_, _>| {
        let scalars: Vec<f64> = input.scalars();
        [scalars[scalars.len() - 4], scalars[scalars.len() - 2]]
    };
    let numbers: Vec<[f64; 2]> = plan.inputs.iter().map(numbers).collect();
    let names = [("thrust, N", BLUE), ("turning, rad/s²", ORANGE)];
    let parts = [
        Part::Lines(
            path("The ways of flyer, load and cable", ["aside, m", "up, m"], lines),
            &[("flyer", BLUE), ("load", ORANGE)],
        ),
        given(("Rotors", "", &names), plan.stepper.step_size(), &numbers),
    ];
    let below = "a flyer of 1 kg with 0.4 kg on a cable, from rest to rest by thrust and torque within bounds";
    let title = "A load on a cable is brought two metres aside and one up in two seconds";
    Ok((report, picture(title, below, &parts)?))
}
