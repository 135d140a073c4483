//! Constraints on values of the states.

use liestep::motion::Motion;

use super::*;

type MotionOfBody = Motion<SO3, ()>;

/// The constraint that the instrument along the body's x axis is so far from the sun.
fn away_from(sun: Vector3<f64>, angle: f64) -> impl Fn(usize, &MotionOfBody) -> f64 {
    move |_, motion| angle.cos() - sun.dot(&(motion.attitude().matrix() * Vector3::x()))
}

/// A turn past the sun, which is a little beside the middle of the way.
fn past_the_sun(stepper: &Body, steps: usize, angle: f64) -> Control<'_, Body> {
    let sun = Vector3::new(0.75_f64.cos(), 0.75_f64.sin(), 0.1).normalize();
    slew(stepper, steps, [0.0, 0.0, 1.5]).keep(away_from(sun, angle))
}

/// The exact solution with a rate of at most `v`: a turn by `θ` in `T` speeds up until `t = 3/2 (v T − θ)/v`, by a
/// torque that falls linearly to zero, and goes on at that rate: `½∫u² dt = 4/3 J² v²/t`.
#[test]
fn the_least_effort_with_a_rate_that_is_kept() {
    let (rate, time) = (1.8 / 2.6, 0.4);
    let exact = 4.0 * 9.0 * rate * rate / (3.0 * time);
    let error = |steps: u32| {
        let stepper = body([2.0, 3.0, 4.0], 2.0 / f64::from(steps));
        let task = slew(&stepper, steps as usize, [0.0, 1.2, 0.0]);
        let plan = task.keep(|_, motion| 3.0 * rate - motion.momentum().y).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged, "{:?} after {}", plan.residual, plan.iterations);
        let most = plan.states.iter().map(|state| state.momentum().y).fold(0.0, f64::max);
        assert!((most - 3.0 * rate).abs() < 1e-9, "{most}");
        plan.cost / exact - 1.0
    };
    let errors = [50, 100, 200].map(error);
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.1, "{errors:?}");
    }
    assert!(errors[2].abs() < 1e-3, "{errors:?}");
}

/// The prices determine the derivative of the least cost by the cone's width.
#[test]
fn an_instrument_goes_round_the_sun() {
    let stepper = body([1.0, 2.0, 2.5], 0.02);
    let least = |angle: f64| {
        let plan = past_the_sun(&stepper, 100, angle).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged, "{:?} after {}", plan.residual, plan.iterations);
        plan
    };
    let plan = least(0.3);
    let sun = Vector3::new(0.75_f64.cos(), 0.75_f64.sin(), 0.1).normalize();
    let nearest = plan.states.iter().enumerate().map(|(k, state)| away_from(sun, 0.3)(k, state)).fold(1.0, f64::min);
    assert!(nearest.abs() < 1e-9, "{nearest}");
    assert!(plan.iterations < 40, "26 but 49 with the other sign of the cone's curvature: {}", plan.iterations);
    let free = slew(&stepper, 100, [0.0, 0.0, 1.5]).solve().expect("a task");
    assert!(plan.cost > 1.01 * free.cost, "{} and {}", plan.cost, free.cost);
    let slope = (least(0.3 + 1e-4).cost - least(0.3 - 1e-4).cost) / 2e-4;
    let price = plan.prices.iter().sum::<f64>() * 0.3_f64.sin();
    assert!((price - slope).abs() < 1e-5 * slope, "{price}, not {slope}");
}

/// The shortest duration under bounds doesn't depend on that of the first guess, a plan of the least effort.
#[test]
fn the_shortest_way_round_the_sun() {
    let shortest = |h, angle| {
        let stepper = body([1.0, 2.0, 2.5], h);
        let task = || past_the_sun(&stepper, 60, angle).bounds(|_, _| (-1.0, 1.0));
        let begun = torques(&task().solve().expect("a task"));
        let plan = task().minimise(TIME).guess(|step, axis| begun[step][axis]).solve().expect("a task");
        assert_eq!(plan.verdict, Verdict::Converged, "{angle}: {:?} after {}", plan.residual, plan.iterations);
        plan.duration
    };
    let times = [shortest(0.06, 0.4), shortest(0.08, 0.4)];
    assert!((times[0] - times[1]).abs() < 1e-7, "{times:?}");
    assert!(times[0] > shortest(0.06, 0.01) + 0.01, "{times:?}");
}

#[test]
fn a_start_at_the_edge_and_one_beyond_it() {
    let stepper = body([1.0, 2.0, 2.5], 0.05);
    let sun = Vector3::new(0.3_f64.cos(), -0.3_f64.sin(), 0.0);
    let task = |angle: f64| slew(&stepper, 40, [0.0, 0.0, 1.5]).keep(away_from(sun, angle)).solve();
    let plan = task(0.3).expect("a task");
    assert_eq!(plan.verdict, Verdict::Converged, "{:?} after {}", plan.residual, plan.iterations);
    let Err(ControlError::Outside(0, value)) = task(0.31) else { panic!("the start is within the cone") };
    assert!(value < 0.0);
    let nothing = slew(&stepper, 40, [0.0, 0.0, 1.5]).keep(|_, _| f64::NAN).solve();
    assert!(matches!(nothing, Err(ControlError::Outside(0, value)) if value.is_nan()));
}

/// A target in the sun and too low a rate are infeasible.
#[test]
fn what_cannot_be_kept_has_a_certificate() {
    let stepper = body([1.0, 2.0, 2.5], 0.05);
    let sun = Vector3::new(1.5_f64.cos(), 1.5_f64.sin(), 0.1).normalize();
    let bounded = slew(&stepper, 40, [0.0, 0.0, 1.5]).bounds(|_, _| (-8.0, 8.0));
    let in_the_sun = bounded.keep(away_from(sun, 0.3)).solve().expect("a task");
    let slow = slew(&stepper, 40, [0.0, 0.0, 1.5]).keep(|_, motion| 0.25 - motion.momentum().norm_squared());
    let slow = slow.solve().expect("a task");
    for plan in [in_the_sun, slow] {
        let Verdict::Infeasible { ref direction, gap } = plan.verdict else {
            panic!("{:?}, {:?} after {}", plan.verdict, plan.residual, plan.iterations)
        };
        assert!(gap > 1e-3, "{gap}");
        assert_eq!(direction.len(), 6 + 40);
        assert!((direction.iter().map(|entry| entry * entry).sum::<f64>() - 1.0).abs() < 1e-12);
    }
}

/// Random bodies turn past a sun in the middle of the way: most plans are found, to the tolerance that is advised here,
/// and the verdicts of the others say that they aren't.
#[test]
fn random_turns_past_a_sun() {
    let mut random = Random::new(11);
    let (mut tried, mut found) = (0, 0);
    while tried < 20 {
        let sides: Vector3<f64> = random.sample::<Vector3<f64>>().map(|side| 1.0 + 0.8 * side);
        let squares = sides.component_mul(&sides);
        let moments = [squares.y + squares.z, squares.z + squares.x, squares.x + squares.y];
        let (angles, sun) = (random.sample::<Vector3<f64>>() * 1.7, random.sample::<Vector3<f64>>().normalize());
        let near = |share: f64| sun.dot(&(turned((angles * share).into()).matrix() * Vector3::x())).acos();
        if near(0.0) < 0.35 || near(1.0) < 0.35 || near(0.5) > 0.3 {
            continue;
        }
        tried += 1;
        let (stepper, bound) = (body(moments, 0.05), 12.0 * moments.into_iter().fold(0.0, f64::max));
        let task = slew(&stepper, 40, angles.into()).bounds(move |_, _| (-bound, bound)).keep(away_from(sun, 0.3));
        let plan = task.until(1e-6, 100).solve().expect("a task");
        let is_found = plan.verdict == Verdict::Converged;
        assert!(is_found == (plan.residual.largest() <= 1e-6), "{:?}, {:?}", plan.verdict, plan.residual);
        found += usize::from(is_found);
    }
    println!("{found} of {tried}");
    assert!(found >= 17, "{found} of {tried}");
}
