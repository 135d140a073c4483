//! Conventions of numbers in files: attitudes, directions, tensors, and the order of parameters.

use std::f64::consts::PI;

use liestep::SO3;
use liestep::effects::{CayleyBody, RigidBody};
use liestep::mechanics::Inertia;
use liestep::prelude::*;
use liestep_scene::{Form, Sample, Scene, Sums};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// A scene with this line for the attitude.
fn text(attitude: &str) -> String {
    format!(
        "title = \"a\"\n[body]\nmoments = [3, 3, 4]\n[start]\n{attitude}\nvelocity = [0.1, 0.2, 0.3]\n[run]\nstep = 0.1\n\
         duration = 1\n"
    )
}

fn start(text: &str) -> Sample {
    Scene::parse("a.toml", text).unwrap().first(1).unwrap().samples()[0].clone()
}

/// The attitude of a scene's start, body to space.
fn attitude(line: &str) -> Matrix3<f64> {
    *start(&text(line)).bodies[0].attitude.as_matrix()
}

fn about(axis: usize, angle: f64) -> Matrix3<f64> {
    let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
    *UnitQuaternion::from_axis_angle(&axes[axis], angle).to_rotation_matrix().matrix()
}

fn same(one: Matrix3<f64>, other: Matrix3<f64>) -> bool {
    (one - other).amax() < 1e-15
}

/// Euler angles are z-x-z; yaw, pitch and roll are z-y-x; both are about axes that turn with the body. A column of an
/// attitude is a body axis in space.
#[test]
fn attitudes() {
    let zxz = about(2, 0.3) * about(0, 0.5) * about(2, 0.7);
    assert!(same(attitude("euler = [0.3, 0.5, 0.7]"), zxz));
    let zyx = about(2, 0.3) * about(1, 0.5) * about(0, 0.7);
    assert!(same(attitude("yaw_pitch_roll = [0.3, 0.5, 0.7]"), zyx));
    assert!(same(attitude("yaw_pitch_roll = [0, \"30 deg\", 0]"), about(1, PI / 6.0)));
    let (s, c) = (0.25_f64.sin(), 0.25_f64.cos());
    let quaternion = attitude(&format!("quaternion = [{c}, 0, {s}, 0]"));
    assert!(same(quaternion, about(1, 0.5)));
    assert!(same(attitude(&format!("quaternion = {{ w = {c}, x = 0, y = {s}, z = 0 }}")), quaternion));
    let velocity = start(&text("euler = [0.3, 0.5, 0.7]")).bodies[0].velocity;
    assert!((velocity - Vector3::new(0.1, 0.2, 0.3)).amax() < 1e-15);
}

/// A number of radians with its unit, without one, and half a turn that is meant.
#[test]
fn radians_and_half_turns() {
    assert!(same(attitude("euler = [0, \"30 rad\", 0]"), about(0, 30.0)));
    assert!((attitude("euler = [0, -6.28318530718, 0]") - about(0, -2.0 * PI)).amax() < 1e-11);
    assert!(same(attitude("quaternion = { w = 0, x = 0, y = 0, z = 1 }"), about(2, PI)));
    assert!((attitude("quaternion = [0, 0, 1e-9, 1]") - about(2, PI)).amax() < 1e-8);
}

/// Marsaglia's xorshift, from −1 to 1.
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        f64::from(u32::try_from(self.0 >> 32).unwrap()) / f64::from(u32::MAX) * 2.0 - 1.0
    }
}

/// Inertias are used as written: bodies of files and of programs start with the same momentum, to the bit.
#[test]
fn inertias_as_they_are_written() {
    let mut random = Random(1);
    for _ in 0..30 {
        let turn =
            UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| random.number()) * 2.0).to_rotation_matrix();
        let moments = Vector3::new(1.0, 1.3, 1.5) + Vector3::from_fn(|_, _| random.number()) * 0.2;
        let full = turn.matrix() * Matrix3::from_diagonal(&moments) * turn.matrix().transpose();
        let full = (full + full.transpose()) * 0.5;
        let rows = [0, 1, 2].map(|row| format!("{:?}", full.row(row).iter().collect::<Vec<_>>())).join(", ");
        let body =
            |line: &str| start(&text("euler = [0, 0, 0]").replace("moments = [3, 3, 4]", line)).bodies[0].momentum;
        let (J, velocity) = (Inertia::new(full).unwrap(), Vector3::new(0.1, 0.2, 0.3));
        let cayley = Stepper::new(CayleyBody { J }, 0.1).unwrap().start(SO3::identity(), velocity).unwrap();
        assert_eq!(body(&format!("J = [{rows}]\nkinetic = \"cayley\"")), cayley.momentum());
        let rigid = Stepper::new(RigidBody { J_d: J.to_nonstandard() }, 0.1).unwrap();
        let rigid = rigid.start(SO3::identity(), velocity).unwrap();
        assert_eq!(body(&format!("J = [{rows}]")), rigid.momentum());
        let [x, y, z] = [moments.x, moments.y, moments.z];
        let J = Inertia::from_principal_moments(moments).unwrap();
        let cayley = Stepper::new(CayleyBody { J }, 0.1).unwrap().start(SO3::identity(), velocity).unwrap();
        let found = body(&format!("moments = [{x:?}, {y:?}, {z:?}]\nkinetic = \"cayley\""));
        assert_eq!(found, cayley.momentum());
    }
}

/// Off-diagonal entries of a tensor are `−∫ x y dm`: for two masses at ±(1, 1, 0), `J_xy = −2`.
#[test]
fn the_sign_of_products_of_inertia() {
    let body = "J = [[2, -2, 0], [-2, 2, 0], [0, 0, 4]]";
    let J = Matrix3::new(2.0, -2.0, 0.0, -2.0, 2.0, 0.0, 0.0, 0.0, 4.0) + Matrix3::identity() * 0.1;
    let body = body.replace("2, -2, 0]", "2.1, -2, 0]").replace("-2, 2, 0]", "-2, 2.1, 0]").replace("0, 4]", "0, 4.1]");
    let momentum = start(&text("euler = [0, 0, 0]").replace("moments = [3, 3, 4]", &body)).bodies[0].momentum;
    assert!((momentum - J * Vector3::new(0.1, 0.2, 0.3)).norm() < 1e-15, "{momentum}");
}

/// Parameters are in the order of the file. Their names affect no operation of the C text and no bit.
#[test]
fn names_change_no_bit() {
    let own = |[a, b, c, d]: [&str; 4]| {
        format!(
            "title = \"own\"\n[lagrangian]\nl_d = \"((F - I) * {a}_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * {b} * {c} * \
             {b}{d} * (s.dot({d}) + (F.transpose() * s).dot({d})) - 0.5 * h * {c} * (w.dot({d}) + (F.transpose() * w).dot({d}))\"\n\
             advected = {{ w = \"{a}p\", s = \"{d}p\" }}\n{a}_d = {{ moments = [3, 3.3, 4.1] }}\n{b} = 1.1\n{b}{d} = 0.37\n\
             {c} = 9.81\n{d} = [0.1, 0.7, 1.3]\n{a}p = [0, 0.6, 0.8]\n{d}p = [0.3, 0.1, 0.2]\n[start]\n\
             euler = [0.1, 0.4, 0.2]\nvelocity = [0.3, 0.2, 5.1]\n[run]\nstep = 0.01\nduration = 0.5\n"
        )
    };
    let all = [["j", "m", "g", "r"], ["z", "y", "x", "q"], ["p", "b", "m", "a"], ["a", "b", "c", "d"]].map(|names| {
        let scene = Scene::parse("own.toml", &own(names)).unwrap();
        let end = scene.run().unwrap().samples().last().unwrap().clone();
        let text = scene.written(Form::C(Sums::Rounded)).unwrap().unwrap();
        let [a, b, c, d] = names;
        let listed = format!("[9..10]: {b}\n   parameters[10..11]: {b}{d}\n   parameters[11..12]: {c}\n");
        assert!(text.contains(&format!("[0..9]: {a}_d\n   parameters{listed}")), "{text}");
        // The comment that lists the names differs.
        (end, text[text.find("static void lagrangian_constants").unwrap()..].to_owned())
    });
    assert!(all.iter().all(|one| *one == all[0]));
}
