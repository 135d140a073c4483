//! The library's joints, and some of a user's own.

use core::array::from_fn;

use declarations::Strut;
use liestep::groups::{CayleyRetraction, LieGroup as _, R3, Retraction};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::SceneVisitor;
use liestep::methods::{Constraint, Joint, Multibody, Place, Slope};
use liestep::motion::Propagator as _;
use liestep::{NonstandardInertia, SO3, SetupError, constraint};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};

use super::super::apart;
use super::{
    Body, Components, Connection, EPSILON, MassAndInertia, assert_no_work, falling, jointed, place, rod, six, watched,
};

/// Checks that a constraint's slopes are the derivatives of its gaps, for turns and shifts of either body.
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
        let (points, axes) = ([next(), next()], [next(), next()]);
        let relative = SO3::exp(next());
        let all = [
            Joint::ball(points),
            Joint::pin(points, axes),
            Joint::universal(points, axes),
            Joint::cylinder(points, axes),
            Joint::slider(points, axes[0], *relative.as_matrix()),
            Joint::weld(points, *relative.as_matrix()),
            Joint::plane(points, axes),
            Joint::distance(points, 0.7),
        ];
        for joint in &all {
            check_slopes(joint, &mut random);
        }
    }
}

/// The library's ball joint as a declaration.
#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    zero = r + R_2 * below - R_1 * above,
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct DeclaredBall {
    above: Vector3<f64>,
    below: Vector3<f64>,
}

/// The strut of `examples/declarations` as a declaration.
#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
    zero = {
        // The vector of the rod in the frame of the body above.
        let along = R_1.transpose() * r + Q * below - above;
        0.5 * (along.norm_squared() / length - length)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct DeclaredStrut {
    above: Vector3<f64>,
    below: Vector3<f64>,
    length: f64,
}

/// A sleeve on a rail: a point of the body below stays on a line of the body above, and an axis stays parallel to it.
#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R = F_1.seen_from(space), Q = F_2.seen_from(F_1), x = d_1.seen_from(space), y = d_2.seen_from(space)),
    zero = {
        let on = |e: Vector3<f64>| e.dot(&(R.transpose() * (y - x)));
        let along = Q * axis;
        (on(first), on(second), first.dot(&along), second.dot(&along))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sleeve {
    /// Directions across the rail, in the axes of the body above.
    first: Vector3<f64>,
    second: Vector3<f64>,
    /// The direction along the rail, in the axes of the body below.
    axis: Vector3<f64>,
}

/// A constraint without a physical meaning, with functions, fields in either body's frame, and inverses.
#[constraint(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(w = up.seen_from(F_2), v = up.seen_from(F_1), Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
    zero = (
        (Q * w).dot(&(A * v)) + k * (1.0 + r.norm_squared()).sqrt() - r[2].sin(),
        vee(Q) - hat(v) * (Q * e).cross(&(Q * w)),
        (Q * inverse(A)).trace() * (0.1 * w.y).exp(),
    ),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct UnphysicalConstraint {
    A: Matrix3<f64>,
    k: f64,
    e: Vector3<f64>,
    up: Vector3<f64>,
}

/// The derived slopes of a declared constraint are its derivatives; they agree to rounding with those of the library's
/// ball joint and of a strut by hand.
#[test]
fn declared_constraints() {
    let mut random = Random::new(15);
    for _ in 0..10 {
        let mut next = || -> Vector3<f64> { random.sample() };
        let (above, below) = (next(), next());
        let ball = DeclaredBall { above, below };
        let strut = DeclaredStrut { above, below, length: 0.7 };
        let sleeve = Sleeve { first: next(), second: next(), axis: next() };
        let anything = UnphysicalConstraint {
            A: Matrix3::identity() * 2.0 + Matrix3::from_columns(&[next(), next(), next()]) * 0.3,
            k: 0.4,
            e: next(),
            up: next(),
        };
        check_slopes(&ball, &mut random);
        check_slopes(&strut, &mut random);
        check_slopes(&sleeve, &mut random);
        check_slopes(&anything, &mut random);
        let by_hand = Strut { called: "strut", above, below, length: 0.7 };
        for _ in 0..10 {
            let places: [Place; 2] = from_fn(|_| {
                let (xi, position): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
                Place { attitude: *<CayleyRetraction as Retraction<SO3>>::retract(&xi).as_matrix(), position }
            });
            are_alike(&ball, &Joint::ball([above, below]), &places);
            are_alike(&strut, &by_hand, &places);
        }
    }
    let mut shown = Vec::new();
    let strut = DeclaredStrut { above: Vector3::x(), below: Vector3::zeros(), length: 2.0 };
    strut.describe(&mut |name, value| shown.push((name, value)));
    assert_eq!((strut.name(), shown.len(), shown[0], shown[6]), ("DeclaredStrut", 7, ("above", 1.0), ("length", 2.0)));
    let refused = DeclaredStrut { length: f64::NAN, ..strut }.validate();
    assert_eq!(refused, Err(SetupError::Parameter { field: "length", cause: "is not finite" }));
}

/// On a sleeve on a tilted rail a body falls as on an inclined plane, and continues to rotate about the rail. The
/// discrete parabola is exact.
#[test]
fn a_sleeve_on_a_rail() {
    let (h, g, steps) = (0.01, 9.81, 400_u32);
    let along = Vector3::new(2.0, 1.0, -2.0) / 3.0;
    let [first, second] = [Vector3::new(1.0, -2.0, 0.0), Vector3::new(2.0, 1.0, 2.5)];
    // The body's z axis is along the rail; the body isn't symmetric about it.
    let attitude = SO3::from(nalgebra::UnitQuaternion::rotation_between(&Vector3::z(), &along).unwrap());
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.03, 0.04)).unwrap();
    let mut system = Multibody::new();
    let [body] = falling([MassAndInertia { m: 1.3, K }], g, Vector3::z());
    let body = system.body(body);
    system.join(Sleeve { first, second, axis: Vector3::z() }, None, body);
    let stepper = system.stepper(h).unwrap();
    let (speed, rate) = (0.4, 3.0);
    let start = [(attitude, R3::from(along * 0.2))];
    let mut state = stepper.start(&start, &[six(&(Vector3::z() * rate), &(along * speed))]).unwrap();
    stepper.run(&mut state, u64::from(steps)).unwrap();
    let time = h * f64::from(steps);
    let fallen = along * (0.2 + speed * time - 0.5 * g * along.z * time * time);
    let (turned, place) = stepper.attitude(&state, body);
    // About a principal axis the turn of a step has the sine h Ω.
    let angle = f64::from(steps) * (h * rate).asin();
    let expected = attitude.as_matrix() * SO3::exp(Vector3::z() * angle).as_matrix();
    let errors = [(place.translation() - fallen).norm() / fallen.norm(), (turned.as_matrix() - expected).norm()];
    println!("{errors:?}, gap {:.1e}", stepper.widest_gap(&state));
    assert!(errors.iter().all(|&error| error < 1e-12), "{errors:?}");
}

/// Checks that gaps and slopes agree up to rounding.
///
/// The second may have room for more functions than the first; the others are zero.
fn are_alike<A: Constraint<K>, B: Constraint<M>, const K: usize, const M: usize>(
    a: &A,
    b: &B,
    [above, below]: &[Place; 2],
) {
    let padded = |row: usize, column: usize, entry: &dyn Fn(usize, usize) -> f64| {
        if row < K { entry(row, column) } else { 0.0 }
    };
    let gap = a.gap(above, below);
    let gaps = [SVector::<f64, M>::from_fn(|row, _| padded(row, 0, &|row, _| gap[row])), b.gap(above, below)];
    assert!((gaps[0] - gaps[1]).amax() < 8.0 * EPSILON * (1.0 + gaps[0].amax()), "{a:?}: {gaps:?}");
    for (a, b) in a.slope(above, below).iter().zip(&b.slope(above, below)) {
        let wide = |of: &SMatrix<f64, K, 3>| {
            SMatrix::<f64, M, 3>::from_fn(|row, column| padded(row, column, &|row, column| of[(row, column)]))
        };
        let off = (wide(&a.turn) - b.turn).amax().max((wide(&a.shift) - b.shift).amax());
        assert!(off < 8.0 * EPSILON * (1.0 + a.turn.amax() + a.shift.amax()), "{a:?} {b:?}");
    }
}

/// A body on a pin is a pendulum of one angle: `I (sin δ_k − sin δ_{k−1}) = −h² V'(θ_k)`, with the moment about the
/// pin.
#[test]
fn a_pendulum_on_a_pin() {
    let (h, m, reach) = (0.01, 1.3, 0.7);
    // The axis is the body's z axis and space's y axis, and the body hangs along its x axis.
    let moments = Vector3::new(0.05, 0.2, 0.22);
    let K = NonstandardInertia::from_principal_moments(moments).unwrap();
    let pivot = Vector3::new(0.3, -0.2, 1.0);
    let pin = Joint::pin([pivot, Vector3::x() * -reach], [Vector3::y() * 2.0, Vector3::z()]);
    let bodies = falling([MassAndInertia { m, K }], 9.81, Vector3::z());
    let stepper = jointed(bodies, &[Connection::to_space(pin, 0)], h).unwrap();
    // From hanging along −z the angle turns towards −x.
    let attitude = |angle: f64| {
        let hanging = Matrix3::from_columns(&[-Vector3::z(), -Vector3::x(), Vector3::y()]);
        SO3::try_from(SO3::exp(Vector3::y() * angle).as_matrix() * hanging).unwrap()
    };
    let centre = |attitude: &SO3| R3::from(pivot + attitude.as_matrix() * Vector3::x() * reach);
    let (mut angle, rate) = (1.2, -0.8);
    let first = attitude(angle);
    let velocity = first.as_matrix() * (Vector3::z() * rate).cross(&(Vector3::x() * reach));
    let start = [(first, centre(&first))];
    let mut state = stepper.start(&start, &[six(&(Vector3::z() * rate), &velocity)]).unwrap();
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
        apart(&stepper.turns(&state), &[expected]),
        (stepper.attitude(&state, 0).1.translation() - centre(&expected).translation()).amax(),
        (stepper.velocity(&state, 0).z - momentum / inertia).abs(),
        stepper.widest_gap(&state),
    ];
    println!("{errors:?}");
    assert!(errors[..3].iter().all(|&error| error < 1e-11) && errors[3] < 4.0 * EPSILON * 2.0, "{errors:?}");
}

/// A wheel that is pinned at its centre, at the origin and far from it: cosines are compared with one, and positions
/// with the sizes of the wheel and of its distance.
#[test]
fn a_wheel_on_its_axle() {
    let moments = Vector3::new(0.1, 0.1, 0.2);
    let K = NonstandardInertia::from_principal_moments(moments).unwrap();
    let axis = Vector3::new(0.3, -0.7, 0.2);
    for centre in [Vector3::zeros(), Vector3::new(1e6, 0.0, 0.0)] {
        let pin = Joint::pin([centre, Vector3::zeros()], [axis, Vector3::z()]);
        let bodies = falling([MassAndInertia { m: 5.0, K }], 0.0, Vector3::z());
        let stepper = jointed(bodies, &[Connection::to_space(pin, 0)], 0.01).unwrap();
        let attitude = nalgebra::Rotation3::rotation_between(&Vector3::z(), &axis).unwrap();
        let about = [(SO3::try_from(*attitude.matrix()).unwrap(), R3::from(centre))];
        for rate in [0.0, 1e-7, 3.0] {
            let turning = [six(&(Vector3::z() * rate), &Vector3::zeros())];
            let mut state = stepper.start(&about, &turning).unwrap();
            stepper.run(&mut state, 1000).unwrap();
            let moved = stepper.velocity(&state, 0) - turning[0];
            assert!(
                moved.amax() < 1e-12 * (rate + 1.0)
                    && stepper.widest_gap(&state) < 8.0 * EPSILON * centre.norm().max(1.0)
            );
            // A motion may start from the state after a step.
            stepper.start_with_momentum(&stepper.attitudes(&state), &stepper.momenta(&state)).unwrap();
        }
        // The joint is open by more than rounding.
        let mut open = about;
        open[0].1 = R3::from(centre + Vector3::y() * 1e-10 * centre.norm().max(1.0));
        let error = stepper.start(&open, &[Vector6::zeros()]).unwrap_err();
        assert!(matches!(error, SetupError::OffConstraint { joint: 0, .. }), "{error}");
        let closed = stepper.start_nearest(&open, &[Vector6::zeros()]).unwrap();
        assert!(stepper.widest_gap(&closed) < 4.0 * EPSILON * centre.norm().max(1.0));
    }
}

/// A joint with dependent functions is named at the start; an attitude off the group is refused, too.
#[test]
fn a_joint_that_repeats_itself() {
    /// A constraint with the height of a point, twice, and then perhaps a function whose slope is zero.
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
    let still = [Vector6::zeros()];
    for heights in [[1.0, 1.0], [1.0, 0.3], [1.0, 0.0], [0.0, 1.0]] {
        let mut system = Multibody::new();
        let [body] = falling([rod(1.0)], 9.81, Vector3::z());
        let body = system.body(body);
        system.join(Heights(heights), None, body);
        let stepper = system.stepper(0.01).unwrap();
        let named = |error: Result<_, SetupError>| matches!(error, Err(SetupError::RedundantJoint { joint: 0, .. }));
        assert!(named(stepper.start(&[Body::identity()], &still).map(|_| ())), "{heights:?}");
        assert!(named(stepper.start_nearest(&[Body::identity()], &still).map(|_| ())), "{heights:?}");
        let nowhere = [(SO3::identity(), R3::from(Vector3::x() * f64::NAN))];
        let error = stepper.start_nearest(&nowhere, &still).unwrap_err();
        assert!(matches!(error, SetupError::NotInGroup { .. }), "{error}");
    }
}

/// A visitor that collects the names and numbers of a description.
#[derive(Default)]
struct Description(Vec<String>);

impl SceneVisitor<f64> for Description {
    fn term(&mut self, derivation: &str) {
        self.0.push(derivation.to_owned());
    }

    fn parameter(&mut self, field: &str, value: f64) {
        self.0.push(format!("{field} {value:?}"));
    }
}

/// A user's kind of joint: two bodies on struts. Their ends whip so fast that a step could end with a strut on its
/// other side; the energy would then be sixty times as large. The parameters are checked, and a kind with another name
/// and the same numbers has another description.
#[test]
fn a_joint_of_ones_own() {
    let strut = |called, length| Strut { called, above: Vector3::new(0.1, 0.3, -0.2), below: -Vector3::x(), length };
    check_slopes(&strut("strut", 0.7), &mut Random::new(6));
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.09)).unwrap();
    let bodies = falling([1.0, 0.7].map(|m| MassAndInertia { m, K }), 9.81, Vector3::z());
    let joined = |called, length| {
        [Connection::to_space(strut(called, 0.5), 0), Connection::between(strut(called, length), 0, 1)]
    };
    let of = |called, length| jointed(bodies, &joined(called, length), 0.005);
    let refused = of("strut", -1.0).unwrap_err();
    assert!(matches!(refused, SetupError::JointParameter { joint: 1, field: "length", .. }), "{refused}");
    let stepper = of("strut", 0.8).unwrap();
    let mut random = Random::new(7);
    let about: [Body; 2] = from_fn(|k| {
        let attitude: SO3 = <CayleyRetraction as Retraction<SO3>>::retract(&random.sample());
        (attitude, R3::from(Vector3::new(0.9, 0.2, -0.4) * if k == 0 { 1.0 } else { 2.0 }))
    });
    let moving: Components<2> = from_fn(|_| random.sample());
    let mut state = stepper.start_nearest(&about, &moving).unwrap();
    let (before, energy) = (stepper.motion(&state), stepper.energy(&state));
    stepper.step(&mut state).unwrap();
    let motions = [before, stepper.motion(&state)];
    assert_no_work((&stepper.scene(), 0.005), &joined("strut", 0.8), &[Vector6::zeros(); 2], motions);
    let [off, gap] = watched(&stepper, &mut state, energy, 999);
    println!("energy {energy:.3} within {off:.1e}, gap {gap:.1e}");
    assert!(off < 0.6 && gap < 4.0 * EPSILON * 3.0);

    let described = |called, length| {
        let mut all = Description::default();
        of(called, length).unwrap().describe(&mut all);
        all.0
    };
    assert_eq!(described("strut", 0.8), described("strut", 0.8));
    assert_ne!(described("strut", 0.8), described("cord", 0.8));
    assert_ne!(described("strut", 0.8), described("strut", 0.9));
}

/// A loop of struts that whips: two bodies on three struts. Whichever joint closes the loop, no step ends with a strut
/// on its other side.
#[test]
fn a_loop_of_struts_that_whips() {
    let strut = |above: Vector3<f64>, below, length| Strut { called: "strut", above, below, length };
    let bodies = falling([1.0, 0.7].map(rod), 9.81, Vector3::z());
    let at = Vector3::new(0.1, 0.3, -0.2);
    let all = [
        Connection::to_space(strut(at, -Vector3::x(), 0.5), 0),
        Connection::between(strut(at, -Vector3::x(), 0.8), 0, 1),
        Connection::to_space(strut(Vector3::new(1.5, 0.3, 0.4), Vector3::x(), 0.6), 1),
    ];
    let mut random = Random::new(7);
    let about: [Body; 2] = from_fn(|k| {
        let attitude: SO3 = <CayleyRetraction as Retraction<SO3>>::retract(&random.sample());
        (attitude, R3::from(Vector3::new(0.9, 0.2, -0.4) * if k == 0 { 1.0 } else { 2.0 }))
    });
    let moving: [Vector6<f64>; 2] = from_fn(|_| random.sample::<Vector6<f64>>() * 2.0);
    let steppers = [0, 1, 2].map(|apart| jointed(bodies, &[1, 2, 3].map(|k| all[(apart + k) % 3]), 0.005).unwrap());
    let start = steppers[0].start_nearest(&about, &moving).unwrap();
    let energy = steppers[0].energy(&start);
    let mut states = [0, 1, 2].map(|k| steppers[k].adopt(&start));
    let (mut off, mut between) = (0.0_f64, 0.0_f64);
    for step in 0..1000 {
        for (stepper, state) in steppers.iter().zip(&mut states) {
            let stepped = stepper.step(state);
            assert!(stepped.is_ok(), "{step}: {stepped:?}");
            off = off.max((stepper.energy(state) - energy).abs());
        }
        let turned = states.each_ref().map(|state| steppers[0].turns(state));
        between = between.max(apart(&turned[0], &turned[1])).max(apart(&turned[0], &turned[2]));
    }
    println!("energy {energy:.3} within {off:.1e}, apart by {between:.1e}");
    assert!(off < 0.6 && between < 1e-6);
}
