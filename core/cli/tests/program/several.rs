//! Files of several bodies: they agree with programs to the bit; springs, loops, and mistakes with their places.

use std::fmt::Write as _;
use std::fs;

use liestep::groups::R3;
use liestep::methods::{Joint, Multibody};
use liestep::prelude::*;
use liestep_scene::{BodySample, Column, Sample, Scene};
use nalgebra::{UnitQuaternion, Vector3, Vector6};

use crate::called::{TOP, called, folder, printed, simulate, table};

const HELD: &str = include_str!("scenes/held.toml");

/// A body of a file with its weight. One of the three kinetic terms has the factor one, the others zero.
#[liestep::lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space)),
    l_d = {
        let xi = log(F);
        let tangent = vee(F - F.transpose()) / (1.0 + F.trace());
        (rigid * ((F - I) * J_d * (F - I).transpose()).trace()
            + geodesic * xi.dot(&(J * xi))
            + cayley * 4.0 * tangent.dot(&(J * tangent))
            + m * d.norm_squared()) / (2.0 * h)
            - 0.5 * h * m * g * (x + x + d).dot(&up)
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct HeavyBody {
    J: Inertia,
    J_d: NonstandardInertia,
    rigid: f64,
    geodesic: f64,
    cayley: f64,
    m: f64,
    g: f64,
    up: Vector3<f64>,
}

fn system(text: &str) -> Scene {
    Scene::parse("several.toml", text).unwrap()
}

/// The rows of a file have the bits of a program's states.
#[test]
fn a_file_is_what_a_program_makes() {
    let folder = folder("held");
    let by_3_13 =
        HELD.replace("moments = ", "kinetic = \"rigid\"\nmoments = ").replace("J = ", "kinetic = \"rigid\"\nJ = ");
    fs::write(folder.join("held.toml"), by_3_13).unwrap();
    printed(&folder, &["run", "held.toml", "--csv", "--out", "."]);
    let csv = fs::read_to_string(folder.join("held.csv")).unwrap();
    let rows = table(&csv);
    assert_eq!(rows.len(), 401);
    let names: Vec<_> = csv.lines().next().unwrap().split(',').collect();
    assert_eq!((names[4], names[10], names[14], names[24]), ("lower_x", "upper_q_z", "lower_q_z", "lower_moving_x"));

    let (g, up) = (9.81, Vector3::z());
    let first = Inertia::from_principal_moments(Vector3::new(0.2, 0.3, 0.25)).unwrap();
    let full = nalgebra::Matrix3::new(0.1, 0.01, 0.0, 0.01, 0.12, 0.0, 0.0, 0.0, 0.11);
    let second = Inertia::new(full).unwrap();
    let by_3_13 = |J: Inertia, m| {
        let (rigid, geodesic, cayley) = (1.0, 0.0, 0.0);
        HeavyBody { J, J_d: J.to_nonstandard(), rigid, geodesic, cayley, m, g, up }
    };
    let mut bodies = Multibody::new();
    bodies.body(by_3_13(first, 1.5));
    bodies.body(by_3_13(second, 700.0 * 1e-3));
    let axis = Vector3::x();
    let pivot = Joint::pin([Vector3::zeros(), up * 0.5], [axis; 2]);
    bodies.join(pivot, None, 0);
    bodies.join(Joint::ball([up * -0.5, axis * -0.3]), Some(0), 1);
    let stepper = bodies.stepper(5.0 * 1e-3).unwrap();
    let place = |x: f64, z: f64| (SO3::from(UnitQuaternion::identity()), R3::from(Vector3::new(x, 0.0, z)));
    let moving = |y: f64| Vector6::new(1.0, 0.0, 0.0, 0.0, y, 0.0);
    let mut state = stepper.start(&[place(0.0, -0.5), place(0.3, -1.0)], &[moving(0.5), moving(1.0)]).unwrap();
    for (step, row) in rows.iter().enumerate() {
        for body in 0..2 {
            let (attitude, place) = stepper.attitude(&state, body);
            assert_eq!(row[1 + 3 * body..][..3], *place.translation().as_slice(), "{step}");
            let [w, x, y, z] = [0, 1, 2, 3].map(|part| row[7 + 4 * body + part]);
            let turned = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(w, x, y, z)).to_rotation_matrix();
            assert!((turned.matrix() - attitude.as_matrix()).amax() < 1e-14, "{step}");
            let velocity = stepper.velocity(&state, body);
            assert_eq!(row[15 + 3 * body..][..3], velocity.as_slice()[..3], "{step}");
            assert_eq!(row[21 + 3 * body..][..3], velocity.as_slice()[3..], "{step}");
        }
        assert_eq!(row[27..], [stepper.energy(&state), stepper.widest_gap(&state)], "{step}");
        stepper.step(&mut state).unwrap();
    }
}

const TURNING: &str = "start.velocity = [0.4, -0.2, 1]\nmoving = [0.2, 0.1, 0]";

fn free(name: &str, position: [f64; 3], rest: &str) -> String {
    format!(
        "[[body]]\nname = \"{name}\"\nm = 2\nmoments = [0.3, 0.4, 0.5]\nposition = {position:?}\nstart.euler = [0, 0, 0]\n\
         {rest}\n"
    )
}

/// Two bodies on a spring oscillate like half a kick, a drift and half a kick: `sin(θ/2) = ω h/2` for each step's
/// phase.
#[test]
fn bodies_on_a_spring() {
    let still = "start.velocity = [0, 0, 0]";
    let spring = "[[spring]]\nbodies = [\"a\", \"b\"]\nat = [[0, 0, 0], [0, 0, 0]]\nk = 30\nlength = \"40 cm\"\n";
    let bodies = free("a", [0.0, 0.0, 0.0], still) + &free("b", [0.5, 0.0, 0.0], still);
    let run = "[run]\nstep = 0.02\nduration = 4\n";
    let run_of = system(&format!("title = \"spring\"\n{bodies}{spring}{run}")).run().unwrap();
    let phase = 2.0 * (0.5 * 30.0_f64.sqrt() * 0.02).asin();
    for (step, sample) in (0_u32..).zip(run_of.samples()) {
        let apart = sample.bodies[1].position - sample.bodies[0].position;
        let expected = Vector3::new(0.4 + 0.1 * (f64::from(step) * phase).cos(), 0.0, 0.0);
        assert!((apart - expected).amax() < 1e-13, "{step}: {apart}");
    }
    assert_eq!(run_of.steps(), 200);

    // Eccentric springs turn the bodies, a third one hangs on a joint, and all momentum is conserved.
    let bodies = free("a", [0.0; 3], TURNING) + &free("b", [0.9, 0.0, 0.1], still) + &free("c", [0.9, 0.6, 0.1], still);
    let springs = "[[spring]]\nbodies = [\"a\", \"b\"]\nat = [[0.2, 0.1, 0], [-0.1, 0, 0.2]]\nk = 30\nlength = 0.3\n\
                   [[spring]]\nbodies = [\"c\", \"a\"]\nat = [[0, 0.1, 0], [0, 0, 0.2]]\nk = 5\nlength = 0\n";
    let joint = "[[joint]]\nkind = \"ball\"\nbodies = [\"b\", \"c\"]\nat = [[0, 0.3, 0], [0, -0.3, 0]]\n";
    let run_of = system(&format!("title = \"springs\"\n{bodies}{springs}{joint}{}", run.replace("0.02", "0.005")))
        .run()
        .unwrap();
    let (first, last) = (&run_of.samples()[0], run_of.samples().last().unwrap());
    let moved = [(last.momentum - first.momentum).norm(), (last.angular_momentum - first.angular_momentum).norm()];
    let off = run_of.samples().iter().map(|sample| (sample.energy - first.energy).abs()).fold(0.0, f64::max);
    println!("momenta {moved:?}, energy {} within {off:e}", first.energy);
    assert!(moved.iter().all(|&moved| moved < 1e-12) && off < 1e-3 * first.energy, "{moved:?} {off:e}");
    assert!((last.bodies[0].position - first.bodies[0].position).norm() > 0.1 && last.gap < 1e-14);
    // A spring to space: the body oscillates about the anchor.
    let tied = "[[spring]]\nbodies = [\"space\", \"a\"]\nat = [[0, 0, 1], [0, 0, 0]]\nk = 30\nlength = 0\n";
    let body = free("a", [0.0; 3], still);
    let run_of = system(&format!("title = \"tied\"\n{body}{tied}{run}")).run().unwrap();
    let phase = 2.0 * (0.5 * 15.0_f64.sqrt() * 0.02).asin();
    let last = run_of.samples().last().unwrap();
    assert!((last.bodies[0].position.z - (1.0 - (200.0 * phase).cos())).abs() < 1e-12);
}

/// The bits of a body's state.
fn bits(body: &BodySample) -> Vec<u64> {
    let attitude = body.attitude.as_matrix().as_slice();
    let vectors = [&body.position, &body.velocity, &body.moving].map(nalgebra::Matrix::as_slice);
    [attitude, &body.quaternion[..], &vectors.concat()[..]].concat().into_iter().map(f64::to_bits).collect()
}

/// Resting bodies change no bit of the others, whatever their number, and stay where they are: beside bodies on a spring
/// and beside joined ones.
#[test]
fn bodies_that_rest_change_nothing() {
    let still = "start.velocity = [0, 0, 0]";
    let spring = "[[spring]]\nbodies = [\"a\", \"b\"]\nat = [[0.2, 0.1, 0], [-0.1, 0, 0.2]]\nk = 30\nlength = 0.3\n";
    let joint = "[[joint]]\nkind = \"ball\"\nbodies = [\"a\", \"b\"]\nat = [[0.5, 0, 0.1], [-0.4, 0, 0]]\n";
    let moving = free("a", [0.0; 3], TURNING) + &free("b", [0.9, 0.0, 0.1], still);
    for held in [spring, joint] {
        let runs = [0, 1, 3, 6].map(|resting| {
            let rest: String =
                (0..resting).map(|k| free(&format!("rest-{k}"), [0.0, 9.0, f64::from(k)], still)).collect();
            let run = "[run]\nstep = 0.005\nduration = 1\nnearest = true\n";
            system(&format!("title = \"rest\"\n{moving}{rest}{held}{run}")).run().unwrap()
        });
        let first = &runs[0].samples()[0];
        let last = runs[0].samples().last().unwrap();
        assert!((0..2).all(|body| bits(&last.bodies[body]) != bits(&first.bodies[body])));
        for run in &runs {
            assert_eq!(run.samples().len(), 201);
            for (sample, expected) in run.samples().iter().zip(runs[0].samples()) {
                let all = sample.bodies.len();
                // Resting bodies have no energy and no momentum.
                let of_all = |sample: &Sample| {
                    let momenta = [sample.momentum, sample.angular_momentum];
                    (sample.energy.to_bits(), sample.gap.to_bits(), momenta)
                };
                assert_eq!(of_all(sample), of_all(expected), "{all} bodies");
                for (body, expected) in sample.bodies.iter().zip(&expected.bodies) {
                    assert_eq!(bits(body), bits(expected), "{all} bodies");
                }
                for (body, start) in sample.bodies.iter().zip(&run.samples()[0].bodies).skip(2) {
                    assert_eq!(body, start, "{all} bodies");
                }
            }
        }
    }
}

/// Four rods between two pivots: joints that close a loop are detected in any order.
#[test]
fn a_loop() {
    let rods = (0..4).map(|k| {
        let tilt = [0.8, 0.3, -0.3, -0.8][k];
        let [x, z] = [[0.3, -0.4], [1.1, -0.9], [1.9, -0.9], [2.7, -0.4]][k];
        format!(
            "[[body]]\nname = \"rod-{k}\"\nm = 1\nJ_d = [0.0833, 0.001, 0.001]\nposition = [{x}, 0, {z}]\n\
             start.quaternion = [{}, 0, {}, 0]\nstart.velocity = [0, 0.3, 0]\n",
            f64::cos(tilt / 2.0),
            f64::sin(tilt / 2.0)
        )
    });
    let rods: String = rods.collect();
    let joint = |bodies: [&str; 2], at: [[f64; 3]; 2]| {
        format!("[[joint]]\nkind = \"ball\"\nbodies = {bodies:?}\nat = {at:?}\n")
    };
    let (left, right) = ([-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]);
    let mut joints = [
        joint(["space", "rod-0"], [[0.0; 3], left]),
        joint(["rod-0", "rod-1"], [right, left]),
        joint(["rod-2", "rod-1"], [left, right]),
        joint(["rod-2", "rod-3"], [right, left]),
        joint(["rod-3", "space"], [right, [3.0, 0.0, 0.0]]),
    ];
    let gravity = "title = \"garland\"\n[gravity]\ng = 9.81\nup = [0, 0, 1]\n";
    let run = "[run]\nstep = 0.01\nduration = 2\nnearest = true\n";
    let ends = [0, 1].map(|_| {
        joints.reverse();
        let run_of = system(&format!("{gravity}{rods}{}{run}", joints.concat())).run().unwrap();
        let start = run_of.samples()[0].energy;
        for sample in run_of.samples() {
            assert!(sample.gap < 4e-15 && (sample.energy - start).abs() < 1e-2 * start.abs(), "{}", sample.gap);
        }
        run_of.samples().last().unwrap().bodies[2].position
    });
    assert!((ends[0] - ends[1]).norm() < 1e-10, "{}", ends[0] - ends[1]);
}

/// The message of a file that is refused.
fn message(text: &str) -> String {
    let mistake = Scene::parse("held.toml", text).and_then(|scene| scene.first(1000)).map(|_| ()).unwrap_err();
    format!("{mistake}\n")
}

#[test]
fn systems_have_bounds() {
    let held = HELD;
    let ball = "[[joint]]\nkind = \"ball\"\nbodies = [\"upper\", \"lower\"]\nat = [[0, 0, -0.5], [-0.3, 0, 0]]\n";
    // A joint that others imply is left out, with a note at its place.
    let run = system(&held.replace("[run]", &(ball.to_owned() + "[run]"))).run().unwrap();
    let notes: Vec<_> = run.notes().iter().map(ToString::to_string).collect();
    let left_out = "several.toml:36:1: 3 functions of this joint are implied by the other joints, and left out; the motion is the same";
    assert_eq!(notes, [left_out]);
}

/// Forty rods in chains of eight from five pivots, with springs between neighbours, and four rods between their ends: four
/// loops. The energy stays, and so do the joints.
#[test]
fn more_than_forty_bodies() {
    let mut text = "title = \"curtain\"\n[gravity]\ng = 9.81\nup = [0, 0, 1]\n".to_owned();
    let joint = |bodies: [&str; 2], at: [[f64; 3]; 2]| {
        format!("[[joint]]\nkind = \"ball\"\nbodies = {bodies:?}\nat = {at:?}\n")
    };
    let (top, bottom) = ([0.0, 0.0, 0.1], [0.0, 0.0, -0.1]);
    for (chain, link) in (0..5).flat_map(|chain| (0..8).map(move |link| (chain, link))) {
        let (name, x) = (format!("rod-{chain}-{link}"), 0.2 * f64::from(chain));
        let _ = write!(
            text,
            "[[body]]\nname = {name:?}\nm = 0.1\nmoments = [4e-4, 4e-4, 1e-5]\nposition = [{x}, 0, {}]\n\
             start.euler = [0, 0, 0]\nstart.velocity = [0, 0, 0]\nmoving = [0, {}, 0]\n",
            -0.1 - 0.2 * f64::from(link),
            if chain == 4 { 0.3 } else { 0.0 }
        );
        text += &match link {
            0 => joint(["space", &name], [[x, 0.0, 0.0], top]),
            _ => joint([&format!("rod-{chain}-{}", link - 1), &name], [bottom, top]),
        };
        if chain > 0 && link > 2 {
            let other = format!("rod-{}-{link}", chain - 1);
            let _ = write!(
                text,
                "[[spring]]\nbodies = [{other:?}, {name:?}]\nat = [{bottom:?}, {bottom:?}]\nk = 2\nlength = 0.15\n"
            );
        }
        if chain > 0 && link == 7 {
            let _ = write!(
                text,
                "[[body]]\nname = \"tie-{chain}\"\nm = 0.05\nmoments = [1e-5, 2e-4, 2e-4]\nposition = [{}, 0, -1.6]\n\
                 start.euler = [0, 0, 0]\nstart.velocity = [0, 0, 0]\n",
                x - 0.1
            );
            let tie = format!("tie-{chain}");
            text += &joint([&format!("rod-{}-7", chain - 1), &tie], [bottom, [-0.1, 0.0, 0.0]]);
            text += &joint([&tie, &name], [[0.1, 0.0, 0.0], bottom]);
        }
    }
    let run = system(&format!("{text}[run]\nstep = 0.005\nduration = 0.5\nnearest = true\n")).run().unwrap();
    let first = &run.samples()[0];
    assert_eq!((run.samples().len(), first.bodies.len()), (101, 44));
    let moved = (run.samples()[100].bodies[39].position - first.bodies[39].position).norm();
    let off = run.samples().iter().map(|sample| (sample.energy - first.energy).abs()).fold(0.0, f64::max);
    let gap = run.samples().iter().map(|sample| sample.gap).fold(0.0, f64::max);
    println!("energy {} within {off:e}, gap {gap:e}, moved by {moved}", first.energy);
    assert!(off < 1e-3 && gap < 8e-15 && moved > 0.02, "{off:e} {gap:e} {moved}");
}

/// A body may have the name of a column, unless both are written.
#[test]
fn columns_have_names_of_their_own() {
    let text = HELD.replace("\"lower\"", "\"momentum\"");
    let columns = Column::listed(system(&text).columns());
    assert!(columns.iter().any(|column| column.name == "momentum_x" && column.unit == "m"));
    assert!(columns.iter().any(|column| column.name == "gap" && column.unit == "m, 1"));
    let ball = text.replace("kind = \"pin\"", "kind = \"ball\"").replace("axes = [[1, 0, 0], [1, 0, 0]]", "");
    assert!(Column::listed(system(&ball).columns()).iter().any(|column| column.name == "gap" && column.unit == "m"));
}

/// Files of several bodies have derivations, pictures and pages.
#[test]
fn results_of_several_bodies() {
    let folder = folder("several");
    fs::write(folder.join("held.toml"), HELD).unwrap();
    fs::write(folder.join("top.toml"), TOP).unwrap();
    assert!(called(&folder, &["run", "top.toml", "held.toml", "--html", "--out", "pages"]).status.success());
    let there = ["top.html", "held.svg", "held.html"].map(|name| folder.join("pages").join(name).exists());
    assert_eq!(there, [true, true, true]);
    let page = fs::read_to_string(folder.join("pages/held.html")).unwrap();
    let shown = [
        "name: \"upper\", sides: [[",
        "name: \"lower\", sides: [[",
        "title: \"Angles of joints\"",
        "title: \"Gaps of joints\"",
    ];
    assert!(shown.iter().all(|part| page.contains(part)), "{}", &page[..2000]);
    let derivation = printed(&folder, &["derive", "held.toml"]);
    let parts = ["momentum", "x_b + R_b ρ_b − x_a − R_a ρ_a = 0", "R_a e_2 · R_b n_b = 0"];
    assert!(parts.iter().all(|part| derivation.contains(part)) && !derivation.contains("without gravity"));
    let free = system(&format!("title = \"free\"\n{}[run]\nstep = 0.1\nduration = 1\n", free("a", [0.0; 3], TURNING)));
    assert!(free.derivation().contains("without gravity") && !free.derivation().contains("joints"));
    // Files of several bodies and of one.
    let output = simulate(&folder, &["held.toml", "top.toml"]);
    assert!(output.status.success() && folder.join("top.csv").exists());
    assert!(fs::read_to_string(folder.join("held.svg")).unwrap().contains("Ways of the centres of mass"));
}

/// Paths are drawn in the plane of the motion, and a constant coordinate has a finite range.
#[test]
fn the_plane_of_the_motion() {
    let readme = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../README.md")).unwrap();
    let rod = readme.split("```toml\n").find(|block| block.contains("[[body]]")).unwrap().split("```").next().unwrap();
    let picture = |text: &str| {
        let system = system(text);
        system.picture(&system.run().unwrap()).unwrap()
    };
    let shows = |picture: &str, across: &str, up: &str| {
        let title = |name: &str| picture.contains(&format!("\n{name}\n"));
        assert!(title(across) && title(up) && !picture.contains("e−154"), "{picture}");
    };
    shows(&picture(rod), "y, m", "z, m");
    let plane = |plane: &str| rod.replace("[run]", &format!("[picture]\nplane = \"{plane}\"\n[run]"));
    shows(&picture(&plane("xz")), "x, m", "z, m");
    let across = rod.replace("moving = [0, 0.5, 0]", "moving = [-0.5, 0, 0]").replace("[1, 0, 0]", "[0, 1, 0]");
    shows(&picture(&across), "x, m", "z, m");
    let still = "start.velocity = [0, 0, 0]\nmoving = [1, 2, 0]";
    let free = format!("title = \"free\"\n{}[run]\nstep = 0.1\nduration = 1\n", free("a", [0.0; 3], still));
    shows(&picture(&free), "x, m", "y, m");
}

/// An arm on a vertical pin and a rod on its end, with friction of 0.1 N m s in both joints. A solver of order eight, by
/// Newton's and Euler's equations, has these places after a second.
const FURUTA: &str = r#"
title = "furuta"
[gravity]
g = 9.81
up = [0, 0, 1]
[[body]]
name = "arm"
m = 0.2
moments = [0.0002, 0.0016, 0.0016]
position = [0.15, 0, 0]
moving = [0, 0.45, 0]
start.euler = [0, 0, 0]
start.velocity = [0, 0, 3]
[[body]]
name = "rod"
m = 0.1
moments = [0.0014, 0.0014, 0.0001]
position = [0.3, 0.18185948536513635, 0.08322936730942848]
moving = [-0.5455784560954091, 0.8167706326905715, 0.18185948536513635]
start.euler = [0, 2, 0]
start.velocity = [1, 2.727892280477045, -1.2484405096414273]
[[joint]]
kind = "pin"
bodies = ["space", "arm"]
at = [[0, 0, 0], [-0.15, 0, 0]]
axes = [[0, 0, 1], [0, 0, 1]]
damping = "0.1 N m s"
[[joint]]
kind = "pin"
bodies = ["rod", "arm"]
at = [[0, 0, 0.2], [0.15, 0, 0]]
axes = [[1, 0, 0], [1, 0, 0]]
damping = 0.1
[run]
step = "1 ms"
duration = 1
"#;

#[test]
fn joints_have_friction() {
    let end = |text: &str| system(text).run().unwrap().samples().last().unwrap().clone();
    let expected = [
        Vector3::new(0.122_658_176_638, 0.086_342_178_012, 0.0),
        Vector3::new(0.194_560_588_851, 0.244_788_276_282, -0.179_512_888_286),
    ];
    let last = end(FURUTA);
    for (body, expected) in last.bodies.iter().zip(expected) {
        let off = (body.position - expected).norm();
        println!("{off:e}");
        assert!(off < 2e-6, "{off:e}");
    }
    assert!((last.energy + 0.173_729_646).abs() < 1e-5, "{}", last.energy);
    let without =
        system(&FURUTA.replace("damping = 0.1\n", "").replace("damping = \"0.1 N m s\"\n", "")).run().unwrap();
    let energies = [without.samples().first(), without.samples().last()].map(|sample| sample.unwrap().energy);
    assert!((energies[1] - energies[0]).abs() < 1e-4 && energies[0] > last.energy + 0.1, "{energies:?}");
    for (wrong, told) in [("-0.1", "above zero"), ("\"1 N m\"", "N m s")] {
        let message = message(&FURUTA.replace("damping = 0.1", &format!("damping = {wrong}")));
        assert!(message.contains(told), "{message}");
    }
}
