//! Checks of a run: its step against springs and spins, its start against joints, its end against the exact motion.

use std::fs;

use liestep_scene::{Run, Sample, Scene};
use nalgebra::Vector3;

use crate::called::{called, folder, refuses};

fn one(text: &str) -> Scene {
    liestep_scene::Scene::parse("one.toml", text).unwrap()
}

fn several(text: &str) -> Scene {
    Scene::parse("several.toml", text).unwrap()
}

fn last(run: &Run) -> &Sample {
    run.samples().last().unwrap()
}

fn notes(run: &Run) -> String {
    run.notes().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Masses of 0.1 kg on a line.
fn masses(places: &[f64]) -> String {
    let body = |(number, place): (usize, &f64)| {
        format!(
            "[[body]]\nname = \"b{number}\"\nm = 0.1\nmoments = [1e-3, 1e-3, 1e-3]\nposition = [{place}, 0, 0]\n\
             start.euler = [0, 0, 0]\nstart.velocity = [0, 0, 0]\n"
        )
    };
    format!("title = \"masses\"\n{}", places.iter().enumerate().map(body).collect::<String>())
}

fn spring(bodies: [&str; 2], at: [[f64; 3]; 2], k: f64, length: f64) -> String {
    format!("[[spring]]\nbodies = {bodies:?}\nat = {at:?}\nk = {k:?}\nlength = {length:?}\n")
}

/// Eight masses of 0.1 kg in a ring of springs of 1.02e5 N/m: `ω = √(4 k/m) = 2020 rad/s`, and steps of 1 ms let a
/// disturbance of 1e-7 m grow without bounds.
#[test]
fn springs_that_are_too_stiff() {
    let ring = |k: f64, step: &str| {
        let mut places = [0, 1, 2, 3, 4, 5, 6, 7].map(f64::from);
        places[3] += 1e-7;
        let springs: String = (0..8)
            .map(|body| {
                let names = [format!("b{body}"), format!("b{}", (body + 1) % 8)];
                spring([&names[0], &names[1]], [[0.0; 3]; 2], k, if body == 7 { 7.0 } else { 1.0 })
            })
            .collect();
        several(&format!("{}{springs}[run]\nstep = \"{step}\"\nduration = 0.1\n", masses(&places)))
    };
    let refused = ring(1.02e5, "1 ms").run().unwrap_err().to_string();
    assert!(refused.contains("at 2020 rad/s") && refused.contains("below 0.00099 s, better 9.9e-5 s"), "{refused}");
    // The message has the line of a spring; the first step, as in `check`, suffices for it.
    assert!(refused.starts_with("several.toml:") && ring(1.02e5, "1 ms").first(1).is_err(), "{refused}");
    let run = ring(1.02e5, "0.1 ms").run().unwrap();
    assert!(run.notes().is_empty() && last(&run).energy < 1e-8, "{}", notes(&run));
    // The rate is `√(4 k/m)` again, in steps `2 asin(hω/2)/(hω)` times that.
    let run = ring(4e4, "1 ms").run().unwrap();
    let said = notes(&run);
    assert!(said.contains("is at 1260 rad/s, and a step of 0.001 s makes it 8 % faster"), "{said}");
    assert!(ring(2e4, "1 ms").run().unwrap().notes().is_empty());
}

const TIED: &str = include_str!("scenes/tied.toml");

/// A soft spring conserves the energy.
#[test]
fn a_soft_spring_of_one_body() {
    let soft = one(&TIED.replace("1e6", "1e3")).run().unwrap();
    let [first, end] = [&soft.samples()[0], last(&soft)].map(|sample| sample.energy);
    assert!(soft.notes().is_empty() && (end / first - 1.0).abs() < 0.02, "{first} {end}");
}

/// Other potentials are kicks, too: `ω² = |c||w|/J` for gravity and a dipole, `3 GM/r³ (J₃ − J₁)/J₂` for a gradient.
#[test]
fn stiff_potentials_of_one_body() {
    let text = |effect: &str, step: &str| {
        format!(
            "title = \"a\"\n[body]\nmoments = [1, 1.1, 1.2]\nkinetic = \"cayley\"\n{effect}\n[start]\neuler = [0, 0.5, 0]\n\
             velocity = [0, 0.1, 0]\n[run]\nstep = {step}\nduration = 2\n"
        )
    };
    for (effect, rate, stable) in [
        (
            "[gravity]\nm = 1e5\ng = 9.81\nrho = [0, 0, -1]\nup = [0, 0, 1]",
            "by gravity the body swings at up to 990 rad/s",
            "5e-4",
        ),
        (
            "[dipole]\nmoment = [0, 0, 1e6]\nfield = [0, 0, 1]",
            "by the dipole's field the body swings at up to 1000 rad/s",
            "5e-4",
        ),
        (
            "[gravity_gradient]\nGM = 1e6\nr = 1\ndirection = [1, 0, 0]",
            "by the gravity gradient the body swings at up to 739 rad/s",
            "5e-4",
        ),
    ] {
        let message = one(&text(effect, "0.01")).run().unwrap_err().to_string();
        assert!(message.contains(rate) && message.contains("makes that grow: take a `step` below"), "{message}");
        let run = one(&text(effect, stable)).run().unwrap();
        let [first, end] = [&run.samples()[0], last(&run)].map(|sample| sample.energy);
        assert!((end / first - 1.0).abs() < 0.1, "{effect}: {first} {end}");
    }
}

/// Estimates that overflow end, without an infinite loop.
#[test]
fn springs_out_of_range() {
    for (k, arm) in [(1e308, 1e150), (1e-308, 1e-150), (1e308, 1.0), (1e200, 1e200)] {
        let spring = spring(["space", "b0"], [[0.0, 0.0, 1.0], [arm, 0.0, 0.0]], k, 1.0);
        let system = several(&format!("{}{spring}[run]\nstep = 0.01\nduration = 0.02\n", masses(&[0.0])));
        let _ = system.run();
        let _ =
            one(&TIED.replace("k = 1e6", &format!("k = {k:?}")).replace("at = [0,", &format!("at = [{arm:?},"))).run();
    }
}

/// Members with a spring that is too stiff are impossible.
#[test]
fn stiff_springs_of_members() {
    let folder = folder("stiff_springs_of_members");
    let drawn = "[ensemble]\nmembers = 8\ndraw.spring.k = { from = 1e3, to = 1e6 }\n";
    fs::write(folder.join("tied.toml"), TIED.to_owned() + drawn).unwrap();
    let output = called(&folder, &["ensemble", "tied.toml", "--out", "."]);
    let notes = String::from_utf8(output.stderr).unwrap();
    assert!(notes.contains("can't exist; the first of them is member") && notes.contains("makes it grow"), "{notes}");
}

/// A spring of length zero has no force between ends at one place.
#[test]
fn springs_of_length_zero() {
    let slack = spring(["space", "b0"], [[0.0; 3]; 2], 80.0, 0.0);
    let run = several(&format!("{}{slack}[run]\nstep = 0.01\nduration = 0.02\n", masses(&[0.0]))).run().unwrap();
    assert!(last(&run).energy.abs() < 1e-30);
}

/// A scene with a rod that is thrown about its joint.
const THROWN: &str = include_str!("scenes/thrown.toml");

/// The nearest start preserves attitudes and angular velocities where shifts suffice.
#[test]
fn what_the_nearest_start_changes() {
    let run = several(THROWN).run().unwrap();
    let start = &run.samples()[0].bodies[0];
    assert!((start.velocity - Vector3::new(3.0, 0.0, 0.0)).norm() < 1e-12, "{}", start.velocity);
    assert!((start.position - Vector3::new(0.0, 0.0, -0.5)).norm() < 1e-12, "{}", start.position);
    // A consistent start is nearest to itself, and no change is reported.
    let right = THROWN
        .replace("[0, 0, 3]", "[0, 0, -0.5]")
        .replace("start.euler", "moving = [-0.29800199, 1.46009987, 0]\nstart.euler");
    let right = right.replace("-0.29800199", "-0.2980039961854183").replace("1.46009987", "1.4700998667618628");
    assert!(several(&right).run().is_ok());
    let held = right.replace("nearest = true\n", "");
    let system = several(&held);
    assert_eq!(system.changes(&system.run().unwrap()), "");
    let system = several(&right);
    assert_eq!(system.changes(&system.run().unwrap()), "");
}

/// The nearest start of free bodies preserves their centre of mass and all momentum. Changed attitudes are reported.
#[test]
fn the_nearest_start_of_free_bodies() {
    let body = |name: &str, m: f64, x: f64, rest: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nm = {m:?}\nmoments = [0.3, 0.4, 0.5]\nposition = [{x:?}, 0, 0]\n\
             moving = [0, {x:?}, 0.1]\nstart.euler = [0, 0, 0]\n{rest}\n"
        )
    };
    let pair = body("a", 1.0, 0.0, "start.velocity = [0, 0, 2]") + &body("b", 3.0, 2.0, "start.velocity = [0.5, 0, 2]");
    let joint = |kind: &str| {
        format!(
            "[[joint]]\n{kind}\nbodies = [\"b\", \"a\"]\nat = [[-0.5, 0, 0], [0.5, 0, 0]]\n[run]\nstep = 0.01\nduration = 0.1\nnearest = true\n"
        )
    };
    let run = several(&format!("title = \"pair\"\n{pair}{}", joint("kind = \"ball\""))).run().unwrap();
    let start = &run.samples()[0];
    let centre = start.bodies[0].position * 0.25 + start.bodies[1].position * 0.75;
    assert!((centre - Vector3::new(1.5, 0.0, 0.0)).norm() < 1e-12 && start.gap < 1e-14, "{centre}");
    assert!((start.momentum - Vector3::new(0.0, 6.0, 0.4)).norm() < 1e-12, "{}", start.momentum);
    assert!((start.bodies[1].velocity - Vector3::new(0.5, 0.0, 2.0)).norm() < 1e-12);
    // A pin permits turns about one axis only, so the velocities change.
    let system =
        several(&format!("title = \"pair\"\n{pair}{}", joint("kind = \"pin\"\naxes = [[0, 0, 1], [0, 0, 1]]")));
    let changes = system.changes(&system.run().unwrap());
    assert!(
        changes.lines().count() == 2 && changes.contains("`b` doesn't start") && !changes.ends_with("by 0 rad/s\n")
    );
}

/// A wheel at 500 rad/s turns by 500 rad in a second. Steps of (3.13) of 1 ms turn it by 523.6 rad, and a note says so.
#[test]
fn a_fast_wheel() {
    let wheel = include_str!("scenes/wheel.toml");
    let system = several(wheel);
    let run = system.run().unwrap();
    let [w, x, ..] = last(&run).bodies[0].quaternion;
    let turned = 2.0 * x.atan2(w);
    assert!((0.5 * (turned - 500.0)).sin().abs() < 1e-11, "{turned}");
    assert!(run.notes().is_empty() && system.end_error(&run).starts_with("  the end is off by about "));
    let rigid = several(&wheel.replace("position", "kinetic = \"rigid\"\nposition"));
    let run = rigid.run().unwrap();
    let [w, x, ..] = last(&run).bodies[0].quaternion;
    assert!((0.5 * (2.0 * x.atan2(w) - 523.598_775_6)).sin().abs() < 1e-6);
}

/// The kinetic terms of several bodies agree with those of a single body.
#[test]
fn kinetic_terms_of_several_bodies() {
    let rest = "start.euler = [0.3, 0.2, 0.1]\nstart.velocity = [1, 2, 1.5]\nrun.step = 0.02\nrun.duration = 2\n";
    let inertia = "J = [[1, 0.1, 0], [0.1, 2, 0.2], [0, 0.2, 2.5]]\n";
    let mut ends = Vec::new();
    for kinetic in ["geodesic", "rigid", "cayley"] {
        let rest = rest.replace("start.", "").replace("run.step = 0.02\nrun.duration = 2\n", "");
        let run = "[run]\nstep = 0.02\nduration = 2\n";
        let alone = format!("title = \"a\"\n[body]\n{inertia}kinetic = \"{kinetic}\"\n[start]\n{rest}{run}");
        let beside = format!(
            "title = \"a\"\n[[body]]\nname = \"a\"\nm = 2\n{inertia}kinetic = \"{kinetic}\"\nposition = [1, 0, 0]\n\
             start.euler = [0.3, 0.2, 0.1]\nstart.velocity = [1, 2, 1.5]\n{run}"
        );
        let (alone, run) = (one(&alone).run().unwrap(), several(&beside).run().unwrap());
        let [alone, beside] = [&alone, &run].map(|run| last(run).bodies[0]);
        let apart = (alone.attitude.as_matrix() - beside.attitude.as_matrix()).norm();
        assert!(apart < 1e-12 && (alone.velocity - beside.velocity).norm() < 1e-12, "{kinetic}: {apart:e}");
        assert!(ends.iter().all(|other: &Vector3<f64>| (other - beside.velocity).norm() > 1e-4), "{kinetic}");
        ends.push(beside.velocity);
    }
}

/// A thin rod from a public report, with the default method and with steps of 1 ms. The reference after 10 s is by
/// Euler's equations with a quaternion, in 30 digits by extrapolation; 500 and 1000 steps agree in 20.
#[test]
fn a_thin_rod() {
    let rod = "title = \"rod\"\n[body]\nmoments = [1.7231e-4, 6.58e-6, 1.7243e-4]\n[start]\neuler = [0, 0, 0]\n\
               velocity = [70, 1, 71.4]\n[run]\nduration = 10\n";
    let scene = one(rod);
    let run = scene.run().unwrap();
    let off = off(&run, ROD);
    assert!(off < 1e-9, "{off:e}");
    assert!(scene.end_error(&run).is_empty() && scene.summary(&run).contains("  the end is off by at most about "));
    // The error of a prescribed step is estimated by a second run, up to a factor of two.
    let coarse = rod.replace("[run]\n", "[run]\nstep = \"0.1 ms\"\n");
    let scene = one(&coarse);
    let run = scene.run().unwrap();
    let said = scene.end_error(&run);
    let estimate: f64 = said.split_whitespace().nth(6).unwrap().parse().unwrap();
    let error = self::off(&run, ROD);
    assert!((0.5..2.0).contains(&(estimate / error)), "{said} {error:e}");
}

/// The angle between the attitude at the end of a run and a quaternion, rad.
fn off(run: &Run, [w, x, y, z]: [f64; 4]) -> f64 {
    let exact = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(w, x, y, z));
    let turned = exact.to_rotation_matrix().matrix() - last(run).bodies[0].attitude.as_matrix();
    2.0 * (turned.norm() / 8.0_f64.sqrt()).asin()
}

const ROD: [f64; 4] =
    [-0.935_539_411_984_150_5, -0.233_301_800_853_360_36, -0.041_715_420_294_214_68, -0.261_908_575_752_314_6];

/// The first listing of README, without a step. The reference after 20 s is by Euler's equations with a quaternion, in
/// 30 digits by extrapolation; 100 and 200 steps agree in 20, and `DOP853` at 1e-13 in 11.
#[test]
fn the_top_of_readme() {
    let readme = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../README.md")).unwrap();
    let scene = readme.split("```toml\n").find(|block| block.starts_with("title = \"My top\"")).unwrap();
    let scene = scene.split("```").next().unwrap().replace("step = \"10 ms\"\n", "");
    let scene = one(&scene);
    let run = scene.run().unwrap();
    let attitude =
        [0.775_938_954_280_921_4, 0.097_707_248_954_974_64, 0.266_854_249_438_441_64, 0.563_170_349_261_861_2];
    let velocity = Vector3::new(-0.212_202_399_107_379_03, 0.367_545_336_741_989, std::f64::consts::TAU);
    let off = [off(&run, attitude), (last(&run).bodies[0].velocity - velocity).norm()];
    assert!(off.iter().all(|off| *off < 1e-5), "{off:?}");
    // A picture needs this many steps, though fewer would do for the end.
    assert!(run.samples().len() == 1001 && (last(&run).time - 20.0).abs() < 1e-12);
    // Steps of 10 ms have an error of 0.08 rad, which the program reports.
    let stepped = one(&readme_with_a_step(&readme));
    let run = stepped.run().unwrap();
    let said = stepped.end_error(&run);
    assert!(said.starts_with("  the end is off by about 8e-2 rad and 9e-3 rad/s"), "{said}");
}

fn readme_with_a_step(readme: &str) -> String {
    let scene = readme.split("```toml\n").find(|block| block.starts_with("title = \"My top\"")).unwrap();
    scene.split("```").next().unwrap().replace("step = \"10 ms\"\n", "").replace("duration", "step = 0.01\nduration")
}

/// A run without a step of a length that no machine completes in seconds.
#[test]
fn a_run_without_a_step() {
    let folder = folder("runs_without_a_step");
    let gravity = "[gravity]\nm = 1\ng = 9.81\nrho = [0.5, 0, 1]\nup = [0, 0, 1]\n[start]";
    let text = include_str!("scenes/plain.toml").replace("[start]", gravity).replace("duration = 2", "duration = 1e9");
    fs::write(folder.join("long.toml"), text).unwrap();
    refuses(&folder, &["run", "long.toml"], 3, "a run without a `step` is one for an accuracy of 1e-6: give a `step`");
    assert!(called(&folder, &["check", "long.toml"]).status.success());
}
