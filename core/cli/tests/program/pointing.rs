//! Orbits, starts and angles as people know them, against formulas and integrations typed here.

use std::f64::consts::{PI, TAU};
use std::fs;

use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::called::{folder, printed, rows};

const DEGREE: f64 = PI / 180.0;
/// m³/s².
const EARTH: f64 = 398_600.441_8e9;
const GM: &str = "GM = \"398600.4418 km³/s²\"";

/// A ball at rest with the angles of its axes to the nadir.
fn at_rest(orbit: &str, duration: f64) -> String {
    let angle =
        |name: &str, axis: [f64; 3]| format!("[[pointing]]\nname = \"{name}\"\naxis = {axis:?}\nto = \"nadir\"\n");
    let angles = [("a", [1.0, 0.0, 0.0]), ("b", [0.0, 1.0, 0.0]), ("c", [0.0, 0.0, 1.0])].map(|(n, a)| angle(n, a));
    format!(
        "title = \"At rest\"\n[body]\nmoments = [1, 1, 1]\n[start]\neuler = [0, 0, 0]\nvelocity = [0, 0, 0]\n[run]\n\
         duration = {duration:?}\nstep = {:?}\n[output]\ncolumns = [\"pointing\"]\nevery = 10\n{}[orbit]\n{orbit}\n",
        duration / 100.0,
        angles.concat()
    )
}

/// The fall of a satellite by Newton's law, by the classical Runge–Kutta method; its position after each tenth.
fn fallen(place: Vector3<f64>, velocity: Vector3<f64>, duration: f64) -> Vec<Vector3<f64>> {
    let (mut r, mut v, h) = (place, velocity, duration / 20_000.0);
    let pull = |r: Vector3<f64>| r * (-EARTH / r.norm().powi(3));
    let mut all = vec![r];
    for step in 1..=20_000 {
        let (a, b) = (v, pull(r));
        let (c, d) = (v + b * (h / 2.0), pull(r + a * (h / 2.0)));
        let (e, f) = (v + d * (h / 2.0), pull(r + c * (h / 2.0)));
        let (g, i) = (v + f * h, pull(r + e * h));
        r += (a + (c + e) * 2.0 + g) * (h / 6.0);
        v += (b + (d + f) * 2.0 + i) * (h / 6.0);
        if step % 2000 == 0 {
            all.push(r);
        }
    }
    all
}

/// The largest angle between the directions of a table and those of the planet.
fn off(rows: &[Vec<f64>], places: &[Vector3<f64>]) -> f64 {
    assert_eq!(rows.len(), places.len());
    let angle = |(row, place): (&Vec<f64>, &Vector3<f64>)| {
        let down = Vector3::new(row[1].cos(), row[2].cos(), row[3].cos());
        (down + place.normalize()).norm()
    };
    rows.iter().zip(places).map(angle).fold(0.0, f64::max)
}

#[test]
fn an_orbit_by_position_and_velocity_is_newtons() {
    let folder = folder("an_orbit_by_position_and_velocity_is_newtons");
    for (place, velocity) in [
        ([7e6, -1e6, 2e6], [1500.0, 6900.0, 2500.0]),
        ([4e7, 1e7, -3e6], [-200.0, 1100.0, 2400.0]),
        ([7e6, 0.0, 0.0], [0.0, (EARTH / 7e6).sqrt() * 0.6, (EARTH / 7e6).sqrt() * 0.8]),
    ] {
        let orbit = format!("position = {place:?}\nvelocity = {velocity:?}\n{GM}");
        let rows = rows(&folder, &at_rest(&orbit, 9000.0));
        let off = off(&rows, &fallen(place.into(), velocity.into(), 9000.0));
        assert!(off < 1e-8, "{place:?}: {off:e}");
    }
}

#[test]
fn an_orbit_by_elements_is_that_of_their_state() {
    let folder = folder("an_orbit_by_elements_is_that_of_their_state");
    let (a, e, tilt, node, argument, anomaly) = (9e6, 0.2, 63.4, 250.0, 40.0, 130.0);
    // The state in the plane, by the conic section, turned about z, x and z.
    let (sin, cos) = (anomaly * DEGREE).sin_cos();
    let parameter: f64 = a * (1.0 - e * e);
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), node * DEGREE)
        * Rotation3::from_axis_angle(&Vector3::x_axis(), tilt * DEGREE)
        * Rotation3::from_axis_angle(&Vector3::z_axis(), argument * DEGREE);
    let place = turn * Vector3::new(cos, sin, 0.0) * (parameter / (1.0 + e * cos));
    let velocity = turn * Vector3::new(-sin, e + cos, 0.0) * (EARTH / parameter).sqrt();
    let angles = format!(
        "eccentricity = {e}\ninclination = \"{tilt} deg\"\nascending_node = \"{node} deg\"\nargument_of_periapsis = \
         \"{argument} deg\"\ntrue_anomaly = \"{anomaly} deg\"\n"
    );
    let period = TAU * (a * a * a / EARTH).sqrt();
    for size in [format!("semi_major_axis = \"{} km\"\n{GM}", a / 1e3), format!("period = {period:?}")] {
        let rows = rows(&folder, &at_rest(&(angles.clone() + &size), 9000.0));
        let off = off(&rows, &fallen(place, velocity, 9000.0));
        assert!(off < 1e-8, "{size}: {off:e}");
    }
}

/// The numbers of two lines in their columns, and those of an orbit by keys.
#[test]
fn two_lines_are_their_mean_elements() {
    let folder = folder("two_lines_are_their_mean_elements");
    let lines = "tle = \"\"\"\nISS (ZARYA)\n1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927\n\
                 2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537\n\"\"\"";
    let keys = format!(
        "period = {:?}\neccentricity = 0.0006703\ninclination = \"51.6416 deg\"\nascending_node = \"247.4627 deg\"\n\
         argument_of_periapsis = \"130.5360 deg\"\nphase = \"325.0288 deg\"",
        86_400.0 / 15.721_253_91
    );
    let [one, other] = [lines, &keys].map(|orbit| rows(&folder, &at_rest(orbit, 9000.0)));
    let apart = crate::called::apart(&one, &other);
    assert!(apart < 1e-12 && one.len() == 11 && (one[0][1] - one[5][1]).abs() > 0.1, "{apart:e}");
}

fn local(moments: &str, rpy: &str, more: &str) -> String {
    format!(
        "title = \"Local\"\n[body]\nmoments = {moments}\n[start]\nrelative_to = \"local vertical\"\nrpy = {rpy}\n\
         velocity = [0, 0, 0]\n[orbit]\nperiod = 6000\nnormal = [0.6, -0.48, 0.64]\n[run]\nduration = 12000\nstep = 2\n\
         {more}\n"
    )
}

/// A ball that starts at rest relative to the local vertical of a circle turns with it for ever.
#[test]
fn a_start_at_rest_relative_to_the_local_vertical_stays() {
    let folder = folder("a_start_at_rest_relative_to_the_local_vertical_stays");
    let more = "[output]\ncolumns = [\"roll-pitch-yaw\", \"velocity\", \"pointing\"]\n[[pointing]]\nname = \"down\"\n\
                axis = [0, 0, 1]\nto = \"nadir\"";
    let level = rows(&folder, &local("[2, 2, 2]", "[0, 0, 0]", more));
    for row in &level {
        // The steps turn the ball by asin(hΩ) instead of hΩ.
        assert!(row[1..4].iter().chain(&row[7..]).all(|angle| angle.abs() < 1e-5), "{row:?}");
        assert!((row[5] + TAU / 6000.0).abs() < 1e-12 && row[4].abs() < 1e-12 && row[6].abs() < 1e-12, "{row:?}");
    }
    let tilted = rows(&folder, &local("[2, 2, 2]", "[\"10 deg\", \"20 deg\", \"-30 deg\"]", more));
    let angles = [10.0, 20.0, -30.0].map(|angle: f64| angle * DEGREE);
    for (found, expected) in tilted[0][1..4].iter().zip(angles) {
        assert!((found - expected).abs() < 1e-12, "{:?}", tilted[0]);
    }
    // The matrix of these angles, by its rows.
    let [roll, pitch, yaw] = angles;
    let turn = Rotation3::from_euler_angles(roll, pitch, yaw);
    let entries = turn.matrix().row_iter().map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>();
    let text = local("[2, 2, 2]", "RPY", more).replace("rpy = RPY", &format!("attitude = {entries:?}"));
    let by_matrix = rows(&folder, &text);
    let apart = crate::called::apart(&by_matrix[..100], &tilted[..100]);
    assert!(apart < 1e-12, "{apart:e}");
    let down = (angles[0].cos() * angles[1].cos()).acos();
    assert!((tilted[0][7] - down).abs() < 1e-12, "{:?}", tilted[0]);
}

/// Librations in the plane of a long symmetric body on a circle take `2π / (n √(3 (J_t − J_s)/J_t))`.
#[test]
fn a_long_body_librates() {
    let folder = folder("a_long_body_librates");
    let more = "[gravity_gradient]\ndirection = \"nadir\"\n[[event]]\nname = \"level\"\ncolumn = \"pitch\"\nvalue = 0\n\
                direction = \"rising\"";
    let text =
        local("[100, 100, 10]\nkinetic = \"geodesic\"", "[0, \"0.1 deg\", 0]", more).replace("step = 2", "step = 1");
    fs::write(folder.join("scene.toml"), text).unwrap();
    printed(&folder, &["run", "scene.toml", "--csv", "--out", "."]);
    let events = fs::read_to_string(folder.join("scene.events.csv")).unwrap();
    let times: Vec<f64> = events.lines().skip(1).map(|row| row.split(',').nth(2).unwrap().parse().unwrap()).collect();
    let expected = 6000.0 / (3.0_f64 * 90.0 / 100.0).sqrt();
    assert!(times.len() == 3, "{times:?}");
    for pair in times.windows(2) {
        assert!((pair[1] - pair[0] - expected).abs() < 2e-6 * expected, "{times:?} {expected}");
    }
    // The first is after three quarters of a period, as it starts above; the angle is so small that the kick of the first
    // half step is seen.
    assert!((times[0] - 0.75 * expected).abs() < 1e-4 * expected, "{times:?} {expected}");
}

/// An axis that turns at .1 rad/s is by 30 degrees off a direction after 5.2359… s.
#[test]
fn an_angle_to_a_direction_is_an_event() {
    let folder = folder("an_angle_to_a_direction_is_an_event");
    let text = "title = \"A spin\"\n[body]\nmoments = [1, 1, 2]\nkinetic = \"geodesic\"\n[start]\neuler = [0, 0, 0]\n\
                velocity = [-1e-12, 0, 0.1]\n[run]\nduration = 9\nstep = 0.1\n[[pointing]]\nname = \"sun\"\naxis = [1, 0, 0]\n\
                to = [1, 0, 0]\n[[event]]\nname = \"off\"\ncolumn = \"sun\"\nvalue = \"30 deg\"\n";
    fs::write(folder.join("scene.toml"), text).unwrap();
    let told = printed(&folder, &["run", "scene.toml", "--csv", "--out", "."]);
    let events = fs::read_to_string(folder.join("scene.events.csv")).unwrap();
    let time: f64 = events.lines().nth(1).unwrap().split(',').nth(2).unwrap().parse().unwrap();
    assert!((time - 10.0 * PI / 6.0).abs() < 1e-9, "{time}");
    assert!(told.contains("velocity [0.000000, 0.000000, 5.729578] deg/s, sun 51.566 deg"), "{told}");
    assert!(told.contains("quaternion [0.900447, 0.000000, 0.000000, 0.434966]"), "{told}");
}

/// A body that turns about one of its axes passes a roll or a yaw once a turn, and nothing where they jump from π to −π: on so
/// wide an orbit the local vertical rests.
#[test]
fn a_roll_and_a_yaw_are_passed_once_a_turn() {
    let folder = folder("a_roll_and_a_yaw_are_passed_once_a_turn");
    for (name, velocity) in [("roll", "[0.5, 0, 0]"), ("yaw", "[0, 0, 0.5]")] {
        let text = format!(
            "title = \"A spin\"\n[body]\nmoments = [1, 1, 2]\nkinetic = \"geodesic\"\n[start]\nrelative_to = \"local \
             vertical\"\nrpy = [0, 0, 0]\nvelocity = {velocity}\n[orbit]\nperiod = 1e12\nnormal = [0.6, -0.48, 0.64]\n\
             [run]\nduration = 30\nstep = 0.1\n[[event]]\nname = \"there\"\ncolumn = \"{name}\"\nvalue = \"100 deg\"\n"
        );
        fs::write(folder.join("scene.toml"), text).unwrap();
        printed(&folder, &["run", "scene.toml", "--csv", "--out", "."]);
        let events = fs::read_to_string(folder.join("scene.events.csv")).unwrap();
        let rows: Vec<Vec<&str>> = events.lines().skip(1).map(|row| row.split(',').collect()).collect();
        assert_eq!(rows.len(), 3, "{events}");
        for (row, turn) in rows.iter().zip([0.0, 1.0, 2.0]) {
            let (time, expected) = (row[2].parse::<f64>().unwrap(), (100.0 * DEGREE + turn * TAU) / 0.5);
            assert!(row[1] == "1" && (time - expected).abs() < 1e-9, "{time} for {expected}: {events}");
        }
    }
}

/// Each sequence of axes is the product of its turns, and its rates are those of the attitude's change.
#[test]
fn each_sequence_is_the_product_of_its_turns() {
    let folder = folder("each_sequence_is_the_product_of_its_turns");
    let (angles, rates) = ([0.4, -0.7, 1.1], [0.3, 0.5, -0.2]);
    let axis = |letter: char| match letter {
        'x' => Vector3::x_axis(),
        'y' => Vector3::y_axis(),
        _ => Vector3::z_axis(),
    };
    for sequence in ["xyz", "xzy", "yxz", "yzx", "zxy", "zyx", "xyx", "xzx", "yxy", "yzy", "zxz", "zyz"] {
        let at = |time: f64| {
            let turns = sequence.chars().zip(angles).zip(rates);
            turns.fold(UnitQuaternion::identity(), |turn, ((letter, angle), rate)| {
                turn * UnitQuaternion::from_axis_angle(&axis(letter), angle + rate * time)
            })
        };
        let spin = (at(-1e-5).inverse() * at(1e-5)).scaled_axis() / 2e-5;
        let digits: String = sequence.chars().map(|letter| char::from(letter as u8 - b'x' + b'1')).collect();
        for name in [sequence, &digits] {
            let text = format!(
                "title = \"A sequence\"\n[body]\nmoments = [1, 1, 1]\n[start]\neuler = {{ sequence = \"{name}\", angles = \
                 {angles:?} }}\neuler_rates = {rates:?}\n[run]\nduration = 1\nstep = 0.1\n[output]\ncolumns = \
                 [\"quaternion\", \"velocity\"]\n"
            );
            let first = rows(&folder, &text).remove(0);
            let q = UnitQuaternion::new_normalize(Quaternion::new(first[1], first[2], first[3], first[4]));
            let apart = q.angle_to(&at(0.0));
            assert!(apart < 1e-12, "{sequence}: {apart:e}");
            let wrong = (Vector3::new(first[5], first[6], first[7]) - spin).norm();
            assert!(wrong < 1e-9, "{sequence}: {wrong:e}");
        }
    }
}

/// Units of other houses have their sizes.
#[test]
fn units_have_their_sizes() {
    let folder = folder("units_have_their_sizes");
    let scene = |moment: &str, spin: &str, field: &str, duration: &str| {
        let text = format!(
            "title = \"Units\"\n[body]\nmoments = [{moment}, {moment}, {moment}]\n[start]\neuler = [0.3, 0.4, 0.1]\n\
             velocity = [0.1, 0, 0]\n[rotor]\nspin = [0, 0, {spin}]\n[dipole]\nmoment = [9e4, 0, 0]\nfield = [{field}, 0, \
             0]\n[run]\nduration = {duration}\nstep = 0.0864\n"
        );
        rows(&folder, &text)
    };
    let si = scene("1.3558179483314004", "2", "2.5e-5", "86.4");
    for (moment, spin, field, duration) in [
        ("\"1 slug ft²\"", "\"2 N m s\"", "\"0.25 G\"", "\"0.001 d\""),
        ("\"1355817.9483314004 kg mm²\"", "\"2000 mN m s\"", "\"25 µT\"", "\"86.4 s\""),
        ("\"13558.179483314004 kg*cm^2\"", "\"2 kg·m^2/s\"", "\"25000 nT\"", "\"1.44 min\""),
    ] {
        let apart = crate::called::apart(&si, &scene(moment, spin, field, duration));
        assert!(apart < 1e-10, "{moment}: {apart:e}");
    }
}

/// A deviation may be a share of the mean, and two numbers may have units of one quantity.
#[test]
fn draws_have_units_of_one_quantity() {
    let folder = folder("draws_have_units_of_one_quantity");
    let member = |draw: &str| {
        let text = format!(
            "title = \"A top\"\n[body]\nmoments = [1, 1, 2]\n[gravity]\nm = 1\ng = 9.81\nrho = [0, 0, 0.1]\nup = [0, 0, 1]\n\
             [start]\neuler = [0.3, 0.4, 0.1]\nvelocity = [0.1, 0, 3]\n[run]\nduration = 1\nstep = 0.01\n[ensemble]\n\
             members = 3\ndraw.gravity.m = {draw}\n"
        );
        fs::write(folder.join("scene.toml"), text).unwrap();
        let _ = fs::remove_dir_all(folder.join("scene.ensemble"));
        printed(&folder, &["ensemble", "scene.toml", "--out", "."]);
        let store = liestep_ensemble::Store::folder(folder.join("scene.ensemble")).unwrap();
        let files = store.files().unwrap();
        let columns = files.iter().map(|(_, path)| liestep_ensemble::Store::read(path).unwrap().rows.columns);
        columns.flat_map(|columns| columns.concat()).collect::<Vec<f64>>()
    };
    let plain = member("{ mean = 1, deviation = 0.1 }");
    for draw in [
        "{ mean = \"1 kg\", deviation = \"0.1 kg\" }",
        "{ mean = \"1 kg\", deviation = \"10 %\" }",
        "{ mean = \"1 kg\", deviation = \"100 g\" }",
        "{ mean = 1, deviation = \"10 %\" }",
    ] {
        let own = member(draw);
        let apart = plain.iter().zip(&own).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(own.len() == plain.len() && !own.is_empty() && apart < 1e-12, "{draw}: {apart:e}");
    }
    let even = member("{ from = 0.5, to = 1 }\ndraw.start.velocity = [0, 0, { from = 0, to = \"10 deg/s\" }]");
    let other =
        member("{ from = 0.5, to = 1 }\ndraw.start.velocity = [0, 0, { from = \"0 deg/s\", to = \"10 deg/s\" }]");
    assert_eq!(even, other);
}

/// The files of the guide's satellite: its commands print the page's lines, and the camera is turned by the leak as an oscillator
/// is by a force.
#[test]
fn the_satellite_of_the_guide() {
    let guide = include_str!("../../../src/guide/satellite.md");
    let listings = |kind: &str| -> Vec<&str> {
        let fence = format!("```{kind}\n");
        guide.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
    };
    let folder = folder("the_satellite_of_the_guide");
    let [scene, sweep] = listings("toml")[..] else { panic!("two scenes") };
    let [of_run, of_ensemble] = listings("text")[..] else { panic!("two texts") };
    fs::write(folder.join("thruster.csv"), listings("csv")[0]).unwrap();
    fs::write(folder.join("satellite.toml"), scene).unwrap();
    printed(&folder, &["check", "satellite.toml"]);
    // The sizes of files are those of a page, which changes with the program.
    let lines = |text: &str| text.lines().filter(|line| !line.ends_with(" kB")).collect::<Vec<_>>().join("\n");
    let told = printed(&folder, &["run", "satellite.toml", "--csv", "--html"]);
    assert_eq!(lines(&told), lines(of_run));
    assert_eq!(printed(&folder, &["ensemble", "satellite.toml"]), of_ensemble);
    let again = printed(&folder, &["report", "satellite.toml"]);
    assert_eq!(lines(&again).replace("0 of them now", "35 of them now"), of_ensemble.trim_end());
    fs::write(folder.join("satellite.toml"), format!("{scene}{sweep}")).unwrap();
    printed(&folder, &["sweep", "satellite.toml"]);
    let table = fs::read_to_string(folder.join("out/satellite.sweep.csv")).unwrap();
    assert_eq!(table.lines().count(), 7, "{table}");
    // From rest at the local vertical, about each axis: J θ'' + k_d θ' + k_p θ = τ.
    let still = scene.replace("\"4 deg\", \"-2 deg\", \"6 deg\"", "0, 0, 0");
    let row = rows(&folder, still.split("[ensemble]").next().unwrap()).pop().unwrap();
    for (at, inertia, torque) in [(2, 12.0, 0.002), (3, 14.0, -0.001), (4, 9.0, 0.0015)] {
        let (mut angle, mut rate, h) = (0.0, 0.0, 1e-3);
        for _ in 0..20_000 {
            rate += h * (torque - 1.0 * rate - 0.02 * angle) / inertia;
            angle += h * rate;
        }
        assert!((row[at] - angle).abs() < 0.05 * f64::abs(angle), "{row:?} {angle}");
    }
    // The histogram counts the members by the column of their rows.
    let store = liestep_ensemble::Store::folder(folder.join("out/satellite.ensemble")).unwrap();
    let files = store.files().unwrap();
    let angles =
        files.iter().flat_map(|(_, path)| liestep_ensemble::Store::read(path).unwrap().rows.columns[0].clone());
    let angles: Vec<f64> = angles.map(f64::to_degrees).collect();
    for part in 0..6_u8 {
        let from = f64::from(part) * 0.5;
        let count = angles.iter().filter(|angle| (from..from + 0.5).contains(*angle)).count();
        let line = of_ensemble.lines().find(|line| line.trim_start().starts_with(&format!("{from} deg to"))).unwrap();
        assert_eq!(line.split_whitespace().nth(5).unwrap(), count.to_string(), "{line}");
    }
}
