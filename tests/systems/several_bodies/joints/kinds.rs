//! Kinds of joints, and some of one's own.

use core::array::from_fn;

use declarations::Strut;
use liestep::groups::{CayleyRetraction, LieGroup as _, R3, Retraction};
use liestep::laws::samples::{Random, derivative};
use liestep::methods::{BallJoint, Constraint, Joined, Joint, Joints, PinJoint, Place, Slope};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError, Stepper};
use nalgebra::{Matrix3, SVector, Vector3, Vector6};

use super::super::apart;
use super::{Body, EPSILON, Free, assert_no_work, place, scene, six};

/// Slopes are the derivatives of gaps, for turns and shifts of either body.
fn check_slopes<C: Constraint<K>, const K: usize>(joint: &C, random: &mut Random) {
    let places: [Body; 2] = from_fn(|_| {
        let (xi, x): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        (<CayleyRetraction as Retraction<SO3>>::retract(&xi), R3::from(x))
    });
    let slopes = joint.slope(&place(&places[0]), &place(&places[1]));
    for (body, slope) in slopes.iter().enumerate() {
        for k in 0..6 {
            let moved = |s: f64| {
                let mut moved = places.map(|body| place(&body));
                let axis = Vector3::ith(k % 3, s);
                if k < 3 {
                    let turn: SO3 = <CayleyRetraction as Retraction<SO3>>::retract(&axis);
                    moved[body].attitude = turn.as_matrix() * moved[body].attitude;
                } else {
                    moved[body].position += axis;
                }
                joint.gap(&moved[0], &moved[1])
            };
            let slope = if k < 3 { slope.turn } else { slope.shift };
            for row in 0..K {
                let expected = derivative(|s| moved(s)[row]);
                assert!((slope[(row, k % 3)] - expected).abs() < 1e-9, "{joint:?}: {body} {k} {row} {expected}");
            }
        }
    }
}

#[test]
fn slopes_are_derivatives_of_gaps() {
    let mut random = Random::new(5);
    for _ in 0..10 {
        let mut next = || -> Vector3<f64> { random.sample() };
        let ball = BallJoint { above: next(), below: next() };
        let pin = PinJoint { above: next(), below: next(), axis_above: next(), axis_below: next() };
        check_slopes(&ball, &mut random);
        check_slopes(&pin, &mut random);
        check_slopes(&Joint::Ball(ball), &mut random);
        check_slopes(&Joint::Pin(pin), &mut random);
    }
}

/// On a pin a body is a pendulum of one angle: `I (sin δ_k − sin δ_{k−1}) = −h² V'(θ_k)`, with the moment about the
/// pin.
#[test]
fn a_pendulum_on_a_pin() {
    let (h, m, reach) = (0.01, 1.3, 0.7);
    // The axis is the body's z axis and space's y axis, and the body hangs along its x axis.
    let moments = Vector3::new(0.05, 0.2, 0.22);
    let K = NonstandardInertia::from_principal_moments(moments).unwrap();
    let pin = PinJoint {
        above: Vector3::new(0.3, -0.2, 1.0),
        below: Vector3::x() * -reach,
        axis_above: Vector3::y() * 2.0,
        axis_below: Vector3::z(),
    };
    let joints = Joints::tree([Joined::to_space(pin, 0)]);
    let stepper = Stepper::jointed(scene([Free { m, K }], 9.81, Vector3::z()), joints, h).unwrap();
    // From hanging along −z the angle turns towards −x.
    let attitude = |angle: f64| {
        let hanging = Matrix3::from_columns(&[-Vector3::z(), -Vector3::x(), Vector3::y()]);
        SO3::try_from(SO3::exp(Vector3::y() * angle).as_matrix() * hanging).unwrap()
    };
    let centre = |attitude: &SO3| R3::from(pin.above + attitude.as_matrix() * Vector3::x() * reach);
    let (mut angle, rate) = (1.2, -0.8);
    let first = attitude(angle);
    let velocity = first.as_matrix() * (Vector3::z() * rate).cross(&(Vector3::x() * reach));
    let start = [(first, centre(&first))];
    let mut state = stepper.start(start, Bodies([six(&(Vector3::z() * rate), &velocity)])).unwrap();
    let inertia = moments.z + m * reach * reach;
    let torque = |angle: f64| -m * 9.81 * reach * angle.sin();
    let mut momentum = inertia * rate;
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
        momentum += 0.5 * h * torque(angle);
        angle += (h * momentum / inertia).asin();
        momentum += 0.5 * h * torque(angle);
    }
    let expected = attitude(angle);
    let errors = [
        apart(&[state.attitude()[0].0], &[expected]),
        (state.attitude()[0].1.translation() - centre(&expected).translation()).amax(),
        (stepper.velocity(&state).0[0].z - momentum / inertia).abs(),
        stepper.widest_gap(&state),
    ];
    println!("{errors:?}");
    assert!(errors[..3].iter().all(|&error| error < 1e-11) && errors[3] < 4.0 * EPSILON * 2.0, "{errors:?}");
}

/// A wheel that is pinned at its centre, at the origin and far from it: cosines are compared with one, and places with
/// what the wheel and its place are long.
#[test]
fn a_wheel_on_its_axle() {
    let moments = Vector3::new(0.1, 0.1, 0.2);
    let K = NonstandardInertia::from_principal_moments(moments).unwrap();
    let axis = Vector3::new(0.3, -0.7, 0.2);
    for centre in [Vector3::zeros(), Vector3::new(1e6, 0.0, 0.0)] {
        let pin = PinJoint { above: centre, below: Vector3::zeros(), axis_above: axis, axis_below: Vector3::z() };
        let joints = Joints::tree([Joined::to_space(pin, 0)]);
        let stepper = Stepper::jointed(scene([Free { m: 5.0, K }], 0.0, Vector3::z()), joints, 0.01).unwrap();
        let attitude = nalgebra::Rotation3::rotation_between(&Vector3::z(), &axis).unwrap();
        let about = [(SO3::try_from(*attitude.matrix()).unwrap(), R3::from(centre))];
        for rate in [0.0, 1e-7, 3.0] {
            let turning = Bodies([six(&(Vector3::z() * rate), &Vector3::zeros())]);
            let mut state = stepper.start(about, turning).unwrap();
            stepper.run(&mut state, 1000).unwrap();
            let moved = stepper.velocity(&state).0[0] - turning.0[0];
            assert!(
                moved.amax() < 1e-12 * (rate + 1.0)
                    && stepper.widest_gap(&state) < 8.0 * EPSILON * centre.norm().max(1.0)
            );
            // What steps leave may be started from.
            stepper.start_with_momentum(state.attitude(), state.momentum()).unwrap();
        }
        // It is open by more than roundings.
        let mut open = about;
        open[0].1 = R3::from(centre + Vector3::y() * 1e-10 * centre.norm().max(1.0));
        let error = stepper.start(open, Bodies([Vector6::zeros()])).unwrap_err();
        assert!(matches!(error, SetupError::OffConstraint { joint: 0, .. }), "{error}");
        let closed = stepper.start_nearest(open, Bodies([Vector6::zeros()])).unwrap();
        assert!(stepper.widest_gap(&closed) < 4.0 * EPSILON * centre.norm().max(1.0));
    }
}

/// A joint whose functions repeat each other is named where it starts; what isn't in the group isn't a start either.
#[test]
fn a_joint_that_repeats_itself() {
    /// The height of a point, twice over, and then perhaps a function whose slope is zero.
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Heights([f64; 2]);
    impl Constraint<2> for Heights {
        fn name(&self) -> &'static str {
            "heights"
        }

        fn validate(&self) -> Result<(), SetupError> {
            Ok(())
        }
        fn gap(&self, above: &Place, below: &Place) -> SVector<f64, 2> {
            SVector::from(self.0) * (below.position.z - above.position.z)
        }
        fn slope(&self, _: &Place, _: &Place) -> [Slope<2>; 2] {
            let turn = nalgebra::SMatrix::zeros();
            let shift =
                nalgebra::SMatrix::<f64, 2, 3>::from_fn(|row, column| if column == 2 { self.0[row] } else { 0.0 });
            [Slope { turn, shift: -shift }, Slope { turn, shift }]
        }
        fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
            self.0.iter().for_each(|&height| visit("height", height));
        }
    }
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.1)).unwrap();
    let still = Bodies([Vector6::zeros()]);
    for heights in [[1.0, 1.0], [1.0, 0.3], [1.0, 0.0], [0.0, 1.0]] {
        let joints = Joints::tree([Joined::to_space(Heights(heights), 0)]);
        let stepper = Stepper::jointed(scene([Free { m: 1.0, K }], 9.81, Vector3::z()), joints, 0.01).unwrap();
        let named = |error: Result<_, SetupError>| matches!(error, Err(SetupError::RedundantJoint { joint: 0, .. }));
        assert!(named(stepper.start([Body::identity()], still).map(|_| ())), "{heights:?}");
        assert!(named(stepper.start_nearest([Body::identity()], still).map(|_| ())), "{heights:?}");
        let nowhere = [(SO3::identity(), R3::from(Vector3::x() * f64::NAN))];
        let error = stepper.start_nearest(nowhere, still).unwrap_err();
        assert!(matches!(error, SetupError::NotInGroup { .. }), "{error}");
    }
}

/// A kind of one's own: two bodies on struts. Their ends whip so fast that a step meets places where a strut is as long on
/// its other side; taken there, the energy would be sixty times what it is. Its parameters are checked, and a kind that has
/// another name and the same numbers doesn't go on from its checkpoints.
#[test]
fn a_joint_of_ones_own() {
    let strut = |called, length| Strut { called, above: Vector3::new(0.1, 0.3, -0.2), below: -Vector3::x(), length };
    check_slopes(&strut("strut", 0.7), &mut Random::new(6));
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.09)).unwrap();
    let bodies = scene([1.0, 0.7].map(|m| Free { m, K }), 9.81, Vector3::z());
    let joined =
        |called, length| [Joined::to_space(strut(called, 0.5), 0), Joined::between(strut(called, length), 0, 1)];
    let of = |called, length| Stepper::jointed(bodies, Joints::tree(joined(called, length)), 0.005);
    let refused = of("strut", -1.0).unwrap_err();
    assert!(matches!(refused, SetupError::JointParameter { joint: 1, field: "length", .. }), "{refused}");
    let stepper = of("strut", 0.8).unwrap();
    let mut random = Random::new(7);
    let about = from_fn(|k| {
        let attitude: SO3 = <CayleyRetraction as Retraction<SO3>>::retract(&random.sample());
        (attitude, R3::from(Vector3::new(0.9, 0.2, -0.4) * if k == 0 { 1.0 } else { 2.0 }))
    });
    let mut state = stepper.start_nearest(about, Bodies(from_fn(|_| random.sample()))).unwrap();
    let (before, energy) = (state, stepper.energy(&state));
    stepper.step(&mut state).unwrap();
    assert_no_work((stepper.scene(), 0.005), &joined("strut", 0.8), &Bodies([Vector6::zeros(); 2]), [&before, &state]);
    let (mut gap, mut off) = (0.0_f64, 0.0_f64);
    for _ in 1..1000 {
        stepper.step(&mut state).unwrap();
        gap = gap.max(stepper.widest_gap(&state));
        off = off.max((stepper.energy(&state) - energy).abs());
    }
    println!("energy {energy:.3} within {off:.1e}, gap {gap:.1e}");
    assert!(off < 0.6 && gap < 8.0 * EPSILON * 3.0);

    let saved = stepper.checkpoint(&state);
    assert_eq!(stepper.resume(&saved).unwrap(), state);
    let error = of("cord", 0.8).unwrap().resume(&saved).unwrap_err();
    println!("{error}");
    assert!(of("strut", 0.9).unwrap().resume(&saved).is_err());
}

/// A loop of struts that whips: two bodies on three struts. Whichever is given apart, no step is taken to where one is as
/// long on its other side.
#[test]
fn a_loop_of_struts_that_whips() {
    let strut = |above: Vector3<f64>, below, length| Strut { called: "strut", above, below, length };
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.09)).unwrap();
    let bodies = scene([1.0, 0.7].map(|m| Free { m, K }), 9.81, Vector3::z());
    let at = Vector3::new(0.1, 0.3, -0.2);
    let all = [
        Joined::to_space(strut(at, -Vector3::x(), 0.5), 0),
        Joined::between(strut(at, -Vector3::x(), 0.8), 0, 1),
        Joined::to_space(strut(Vector3::new(1.5, 0.3, 0.4), Vector3::x(), 0.6), 1),
    ];
    let mut random = Random::new(7);
    let about = from_fn(|k| {
        let attitude: SO3 = <CayleyRetraction as Retraction<SO3>>::retract(&random.sample());
        (attitude, R3::from(Vector3::new(0.9, 0.2, -0.4) * if k == 0 { 1.0 } else { 2.0 }))
    });
    let moving: [Vector6<f64>; 2] = from_fn(|_| random.sample::<Vector6<f64>>() * 2.0);
    let steppers = [0, 1, 2].map(|apart| {
        let tree = Joints::tree([all[(apart + 1) % 3], all[(apart + 2) % 3]]);
        Stepper::jointed(bodies, tree.closed_by([all[apart]]), 0.005).unwrap()
    });
    let start = steppers[0].start_nearest(about, Bodies(moving)).unwrap();
    let energy = steppers[0].energy(&start);
    let mut states = [0, 1, 2].map(|k| steppers[k].adopt(&start));
    let (mut off, mut between) = (0.0_f64, 0.0_f64);
    for step in 0..1000 {
        for (stepper, state) in steppers.iter().zip(&mut states) {
            let stepped = stepper.step(state);
            assert!(stepped.is_ok(), "{step}: {stepped:?}");
            off = off.max((stepper.energy(state) - energy).abs());
        }
        let turned = states.each_ref().map(|state| state.attitude().map(|body| body.0));
        between = between.max(apart(&turned[0], &turned[1])).max(apart(&turned[0], &turned[2]));
    }
    println!("energy {energy:.3} within {off:.1e}, apart by {between:.1e}");
    assert!(off < 0.6 && between < 1e-6);
}
