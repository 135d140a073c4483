//! Runs of scene files: they agree with programs, and every file in `examples/scenes` runs.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::process::Command;

use liestep::accuracy::Accuracy;
use liestep::effects::CayleyBody;
use liestep::effects::{Dipole, Drag, GravityGradient, MagneticDamping, Rotor, Spring, Thrust, Torque};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme};
use liestep::motion::Moment;
use liestep::prelude::*;
use liestep::recording::{Csv, Recorder};
use nalgebra::{UnitQuaternion, Vector3};

use crate::called::{PROGRAM, TOP, called, folder, printed, refused, rows, simulate, table};

/// The body of the top's file.
fn body() -> PrincipalBody {
    PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap() }
}

/// The weight of the top.
fn gravity() -> Gravity {
    Gravity { m: 1.0, g: 9.81, rho: Vector3::z(), up: Vector3::z() }
}

/// The top's attitude and angular velocity at the start.
fn start() -> (UnitQuaternion<f64>, Vector3<f64>) {
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 45.0 * (PI / 180.0));
    (tilt, Vector3::new(0.0, 0.0, 60.0 * (6.0 * (PI / 180.0))))
}

/// The table of a file agrees with that of a program's recorder, in numbers, signs and digits.
#[test]
fn a_table_is_that_of_a_recorder() {
    let folder = folder("recorded");
    // The body turns over several times, so that the continuous quaternion passes through `w < 0`.
    let columns = "[output]\ncolumns = [\"quaternion\", \"velocity\", \"momentum\", \"energy\"]\nevery = 7\n";
    fs::write(folder.join("top.toml"), TOP.replace("[drag]\nc = 1e-3\n", columns)).unwrap();
    printed(&folder, &["run", "top.toml", "--csv", "--out", "."]);
    let table = fs::read_to_string(folder.join("top.csv")).unwrap();

    let stepper = Stepper::new(body() + gravity(), 10.0 * 1e-3).unwrap();
    let (attitude, velocity) = start();
    let mut state = stepper.start(attitude, velocity).unwrap();
    let mut recorder = Recorder::new(&stepper, Csv::new(Vec::new()));
    stepper.observed(&mut state).every(7, |now| recorder.record(now)).steps(200).unwrap();
    recorder.record(&Moment::of_step(&stepper, &state)).unwrap();
    let expected = String::from_utf8(recorder.finish().unwrap().into_inner().unwrap()).unwrap();
    // All columns but the defect.
    let expected: Vec<_> = expected.lines().map(|line| line.rsplit_once(',').unwrap().0).collect();
    assert_eq!(table.lines().collect::<Vec<_>>(), expected);
    assert!(self::table(&table).iter().any(|row| row[1] < -0.1), "{table}");
}

/// A run that stops leaves the rows up to then.
#[test]
fn a_run_that_stops_has_a_table() {
    let folder = folder("stops");
    let thrust = "[torque]\ntorque = [0, 0, 400]\n";
    fs::write(folder.join("top.toml"), TOP.replace("[drag]\nc = 1e-3\n", thrust)).unwrap();
    let output = simulate(&folder, &["top.toml"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(3) && text.contains(": stopped at t = "), "{text}");
    let rows = table_of(&folder.join("top.csv"));
    let last = rows.last().unwrap()[0];
    // Times are printed without the rounding errors of the last digits.
    let stop: f64 = text.split("stopped at t = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((stop - last).abs() < 1e-9 && stop.to_string().len() < 6, "{text}");
    assert!(rows.len() > 20 && text.contains(&format!("stopped at t = {stop} s")), "{text}");
}

/// Every example file runs, moves, and has a picture and a table.
#[test]
fn the_scenes_run() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let gallery = fs::read_to_string(scenes.join("README.md")).unwrap();
    let mut files: Vec<_> = fs::read_dir(&scenes).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    assert!(files.len() >= 12, "{}", files.len());
    let names: Vec<_> = files.iter().map(|path| path.to_str().unwrap()).collect();
    let folder = folder("scenes");
    let output = simulate(&folder, &names);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut compared = 0;
    for path in &files {
        let result = |ending| {
            let name = Path::new(path.file_name().unwrap()).with_extension(ending);
            fs::read_to_string(folder.join(name)).unwrap()
        };
        let rows = table(&result("csv"));
        assert!(rows.len() > 500 && rows.first() != rows.last(), "{}", path.display());
        assert!(rows.iter().flatten().all(|value| value.is_finite()), "{}", path.display());
        assert!(result("svg").matches("<polyline").count() > 3, "{}", path.display());
        // The picture is small enough for the repository, where the gallery displays it.
        assert!(result("svg").len() < 60_000, "{}", path.display());
        let name = path.file_stem().and_then(|stem| stem.to_str()).unwrap();
        assert!(gallery.contains(&format!("({name}.toml)")) && gallery.contains(&format!("/{name}.svg)")), "{name}");
        let kept = fs::read_to_string(scenes.join(format!("../figures/scenes/{name}.svg"))).unwrap();
        if fs::read_to_string(path).unwrap().contains("\naccuracy = ") {
            println!("skipped: the step of {name}.svg is chosen by runs whose rounding is the machine's");
        } else {
            assert_same_picture(&result("svg"), &kept, name);
            compared += 1;
        }
    }
    assert!(compared >= 12, "{compared}");
}

/// Asserts equal pictures up to a pixel, two of a picture's units. Charts of rounding errors are left out, as sines
/// differ between machines.
fn assert_same_picture(made: &str, kept: &str, name: &str) {
    // The scale of such a chart goes down to 10⁻¹⁰ at least.
    let is_of_rounding = |chart: &str| {
        chart.split("10⁻¹").skip(1).any(|behind| behind.starts_with(['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹']))
    };
    let parts = |picture: &str| -> (String, Vec<f64>) {
        // Each chart begins with its title, at this place.
        let charts = picture.split("<text x=\"1072\" ").filter(|chart| !is_of_rounding(chart));
        let picture: String = charts.collect();
        let is_of_number = |letter: char| letter.is_ascii_digit() || letter == '.' || letter == '-';
        let numbers = picture.split(|letter| !is_of_number(letter)).filter_map(|text| text.parse().ok());
        (picture.replace(is_of_number, ""), numbers.collect())
    };
    let ((words, numbers), (kept_words, kept_numbers)) = (parts(made), parts(kept));
    assert!(words == kept_words && numbers.len() == kept_numbers.len() && numbers.len() > 500, "{name}");
    let moved = numbers.iter().zip(&kept_numbers).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved <= 2.0, "{name}: {moved}");
}

/// A file with all effects agrees with the sum in a program, to the bit, and its units are those of SI.
#[test]
fn a_file_may_have_every_effect() {
    let others = "[gravity_gradient]\nGM = 2\nr = 3\ndirection = [1, 0, 0]\n\
                  [dipole]\nmoment = [0, 0.1, 1]\nfield = [0.2, 0, 1]\n\
                  [spring]\nk = 3\nlength = 0.5\nat = [0, 0, 1]\nanchor = [1, 0.3, 0.5]\n\
                  [rotor]\nspin = [0, 0.4, 1]\n\
                  [magnetic_damping]\nk = 0.1\nfield = [0, 0.5, 1]\n\
                  [torque]\ntorque = [0.1, 0.2, -0.1]\n\
                  [thrust]\nat = [0.3, 0, 1]\nthrust = [0, 0.2, 0.1]\n[run]";
    let rows = rows(&folder("all"), &TOP.replace("[run]", others));
    assert_eq!(rows.len(), 201);
    let J = NonstandardInertia::from(body().J_d).to_inertia();
    // The body comes first, and the effects follow in the order of the list.
    let scene = body()
        + gravity()
        + GravityGradient { GM: 2.0, r: 3.0, J, direction: Vector3::x() }
        + Dipole { moment: Vector3::new(0.0, 0.1, 1.0), field: Vector3::new(0.2, 0.0, 1.0) }
        + Spring { k: 3.0, length: 0.5, at: Vector3::z(), anchor: Vector3::new(1.0, 0.3, 0.5) }
        + Rotor { spin: Vector3::new(0.0, 0.4, 1.0) }
        + Drag { c: 1e-3, J }
        + Torque { torque: Vector3::new(0.1, 0.2, -0.1) }
        + Thrust { at: Vector3::new(0.3, 0.0, 1.0), thrust: Vector3::new(0.0, 0.2, 0.1) }
        + MagneticDamping { k: 0.1, field: Vector3::new(0.0, 0.5, 1.0), J };
    same_as(&rows[200], Stepper::new(scene, 10.0 * 1e-3), 0.0);
}

/// Each effect of the library has a table of its name in scene files, and each body a value of `kinetic`, as listed in
/// messages about unknown names.
#[test]
fn no_effect_is_without_a_table() {
    let folder = folder("effects");
    let listed = |line, by| -> Vec<String> {
        let message = refused(&folder, &TOP.replace(line, by));
        let (_, names) = message.split_once(", expected one of ").unwrap();
        names.trim().split(", ").map(|name| name.trim_matches('`').to_owned()).collect()
    };
    let tables = listed("[drag]", "[none]");
    let kinetic = listed("moments = [3, 3, 4]", "moments = [3, 3, 4]\nkinetic = \"none\"");
    let in_words = |name: &str, between: &str| {
        name.chars().enumerate().fold(String::new(), |text, (place, letter)| {
            let before = if place > 0 && letter.is_uppercase() { between } else { "" };
            text + before + &letter.to_lowercase().to_string()
        })
    };
    let effects = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/effects/mod.rs");
    let library = fs::read_to_string(effects).unwrap();
    let exported = library.lines().filter_map(|line| line.strip_prefix("pub use ")?.split_once("::"));
    let names: Vec<&str> = exported.flat_map(|(_, names)| names.trim_matches(['{', '}', ';']).split(", ")).collect();
    assert!(names.len() > 14, "{names:?}");
    for name in names {
        let has = match name.strip_suffix("Body") {
            // The rigid body in its principal axes.
            Some("Principal") => kinetic.contains(&"rigid".to_owned()),
            Some(kind) => kinetic.contains(&in_words(kind, "-")),
            None => tables.contains(&in_words(name, "_")),
        };
        assert!(has, "{name}");
    }
}

/// The last row of the top without drag, with an additional line in the tables `body` and `run`.
fn last_row(test: &str, body: &str, run: &str) -> Vec<f64> {
    let text = TOP.replace("[drag]\nc = 1e-3\n", "").replace("moments = [3, 3, 4]\n", body);
    rows(&folder(test), &text.replace("duration = 2\n", &format!("duration = 2\n{run}\n"))).pop().unwrap()
}

/// Asserts that a program with the same scene and method agrees with a row, within a relative error of velocity and
/// energy.
fn same_as<S, P>(row: &[f64], stepper: Result<Stepper<S, P>, SetupError>, tolerance: f64)
where
    S: liestep::mechanics::Effect<Scalar = f64, Group = SO3>,
    P: liestep::motion::Plan<S>,
{
    let (stepper, (attitude, velocity)) = (stepper.unwrap(), start());
    let mut state = stepper.start(attitude, velocity).unwrap();
    stepper.run(&mut state, 200).unwrap();
    let (velocity, energy) = (stepper.velocity(&state), stepper.energy(&state));
    assert!((Vector3::new(row[1], row[2], row[3]) - velocity).norm() <= tolerance * velocity.norm(), "{velocity}");
    assert!((row[7] - energy).abs() <= tolerance * energy.abs(), "{energy}");
}

/// Rows of (3.13) agree to the bit. Files of other kinetic terms solve their steps in another order of operations.
#[test]
fn kinetic_terms_and_methods() {
    let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    let gravity = gravity();
    let body = RigidBody { J_d: J.to_nonstandard() };
    let (full, h) = ("J = [[3, 0, 0], [0, 3, 0], [0, 0, 4]]\n", 10.0 * 1e-3);
    same_as(&last_row("full", full, ""), Stepper::new(body + gravity, h), 0.0);
    let composed = last_row("composed", full, "method = { composition = \"Suzuki 4\" }");
    same_as(&composed, Stepper::composed(body + gravity, h, CompositionScheme::SUZUKI_4), 0.0);
    let cayley = last_row("cayley", "moments = [3, 3, 4]\nkinetic = \"cayley\"\n", "");
    same_as(&cayley, Stepper::new(CayleyBody { J } + gravity, h), 1e-13);
    let split = last_row("split", full, "method = { splitting = \"nyström 6-4\" }");
    same_as(&split, Stepper::split(body + gravity, h, ExactBody::new(&J), SplittingScheme::NYSTROM_6), 1e-13);
    let processed = last_row("processed", full, "method = { processed = \"processed 3-6 a\" }");
    same_as(&processed, Stepper::processed(body + gravity, h, ExactBody::new(&J), ProcessedScheme::SIX_A), 1e-13);
    let collocated = last_row("collocated", full, "method = { collocation = 4 }");
    same_as(&collocated, Stepper::collocated::<2>(body + gravity, h), 1e-13);
}

/// Each kinetic term has its order for a free body, and errors of its own.
#[test]
fn kinetic_terms_have_their_orders() {
    let velocity = |body: &str, run: &str| {
        let text = format!(
            "title = \"free\"\n[body]\nmoments = [3, 4, 5.5]\n{body}\n[start]\neuler = [0, 0, 0]\nvelocity = [1, 2.5, 2]\n\
             [run]\nduration = 3.2\n{run}\n"
        );
        let row = rows(&folder("orders"), &text).pop().unwrap();
        Vector3::new(row[1], row[2], row[3])
    };
    // A splitting moves a free body by its exact flow.
    let exact = velocity("", "step = 0.1\nmethod = { splitting = \"Strang\" }");
    let mut errors = Vec::new();
    for (name, order) in
        [("rigid", 2.0), ("cayley", 2.0), ("geodesic", 2.0), ("fourth-order", 4.0), ("sixth-order", 6.0)]
    {
        let error = |h: f64| (velocity(&format!("kinetic = \"{name}\""), &format!("step = {h}")) - exact).norm();
        let (coarse, fine) = (error(0.1), error(0.05));
        assert!(((coarse / fine).log2() - order).abs() < 0.2, "{name}: {coarse} {fine}");
        assert!(errors.iter().all(|other: &f64| (coarse / other - 1.0).abs() > 0.05), "{name}: {errors:?} {coarse}");
        errors.push(coarse);
    }
}

/// A body that turns at a constant rate: its tilt passes 60° at π/6, 5π/6, 7π/6, … half seconds, between the steps.
#[test]
fn events() {
    let folder = folder("events");
    let text = "title = \"ball\"\n[body]\nmoments = [1, 1, 1]\n[start]\neuler = [0, 0, 0]\nvelocity = [2, 0, 0]\n\
                [run]\nstep = 0.07\nduration = 7\nmethod = { splitting = \"Strang\" }\n\
                [[event]]\nname = \"low\"\ntilt = \"60 deg\"\ndirection = \"rising\"\n\
                [[event]]\nname = \"side\"\naxis_y = 0.5\n";
    fs::write(folder.join("ball.toml"), text).unwrap();
    let report = printed(&folder, &["run", "ball.toml", "--csv", "--html", "--out", "."]);
    assert!(
        report.contains("\n  low: 3 times, first at t = 0.523598775598") && report.contains("\n  side: 4 times, first")
    );
    let table = fs::read_to_string(folder.join("ball.events.csv")).unwrap();
    assert!(table.starts_with("event,rising,t,velocity_x,"), "{table}");
    let mut found: Vec<(&str, &str, f64)> = Vec::new();
    for row in table.lines().skip(1) {
        let cells: Vec<_> = row.split(',').collect();
        found.push((cells[0], cells[1], cells[2].parse().unwrap()));
    }
    // `R e₃` has the second component −sin 2t.
    let expected = [
        ("low", "1", 1.0),
        ("side", "1", 3.5),
        ("low", "1", 7.0),
        ("side", "0", 5.5),
        ("side", "1", 9.5),
        ("low", "1", 13.0),
        ("side", "0", 11.5),
    ];
    let mut expected = expected.map(|(name, rising, sixths)| (name, rising, sixths * PI / 6.0));
    expected.sort_by(|a, b| a.2.total_cmp(&b.2));
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!((found.0, found.1), (expected.0, expected.1));
        assert!((found.2 - expected.2).abs() < 1e-13, "{found:?} {expected:?}");
    }
    assert!(fs::read_to_string(folder.join("ball.html")).unwrap().contains("events: [\n[0.5235987755"));

    fs::write(folder.join("stop.toml"), text.replace("axis_y = 0.5", "axis_y = 0.5\nstop = true")).unwrap();
    let report = printed(&folder, &["run", "stop.toml", "--csv", "--out", "."]);
    assert!(report.contains(", 27 steps of 0.07 s\n") && report.contains(", which ended the run\n"), "{report}");
    assert_eq!(table_of(&folder.join("stop.csv")).last().unwrap()[0].to_bits(), (0.07 * 27.0_f64).to_bits());
}

/// A free body to an accuracy takes one step by the exact motion, in which this velocity passes zero twice.
#[test]
fn events_within_one_long_step() {
    let folder = folder("events-within-one-long-step");
    let text = "title = \"flip\"\nbody.moments = [1, 2, 2.5]\nstart.velocity = [0.1, 2, 0.2]\nrun.duration = 10\n\
                run.accuracy = 1e-6\n[[event]]\nname = \"turn\"\nvelocity_x = 0\n";
    fs::write(folder.join("flip.toml"), text).unwrap();
    printed(&folder, &["run", "flip.toml", "--csv", "--out", "."]);
    let table = fs::read_to_string(folder.join("flip.events.csv")).unwrap();
    let times: Vec<f64> = table.lines().skip(1).map(|row| row.split(',').nth(2).unwrap().parse().unwrap()).collect();
    // Euler's equations by SciPy's DOP853 at 1e-12.
    let expected = [0.537_330_15, 8.301_608_65];
    assert!(times.len() == 2 && times.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-7), "{times:?}");
}

/// A sweep counts events.
#[test]
fn events_of_a_sweep() {
    let folder = folder("events-of-a-sweep");
    let text = "title = \"ball\"\nbody.moments = [1, 1, 1]\nstart.euler = [0, 0, 0]\nstart.velocity = [0, 0, 0]\n\
                run.step = 0.07\nrun.duration = 7\nrun.method = { splitting = \"Strang\" }\noutput.columns = []\n\
                sweep.start.velocity = [[2, 0, 0], [0, 0, 1]]\n[[event]]\nname = \"low\"\ntilt = \"60 deg\"\n";
    fs::write(folder.join("ball.toml"), text).unwrap();
    let told = printed(&folder, &["sweep", "ball.toml", "--out", "."]);
    let table = fs::read_to_string(folder.join("ball.sweep.csv")).unwrap();
    // The table is printed with fewer digits.
    let words: Vec<Vec<&str>> = told.lines().take(3).map(|line| line.split_whitespace().collect()).collect();
    assert!(words[0].ends_with(&["low_times", "low_first"]) && words[2].ends_with(&["0", "NaN"]), "{told}");
    assert!(words[1].starts_with(&["2", "0", "0"]) && words[1].ends_with(&["5", "0.523599"]), "{told}");
    let rows: Vec<Vec<_>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][4..], ["low_times", "low_first"]);
    assert_eq!((rows[1][0], rows[1][4]), ("2 0 0", "5.0"));
    assert!((rows[1][5].parse::<f64>().unwrap() - PI / 6.0).abs() < 1e-13, "{table}");
    assert_eq!(rows[2][4..], ["0.0", "NaN"]);
}

fn table_of(path: &Path) -> Vec<Vec<f64>> {
    table(&fs::read_to_string(path).unwrap())
}

/// A point of a sweep agrees with the file with its values.
#[test]
fn sweeps() {
    let folder = folder("sweeps");
    let sweep = "[sweep]\ngravity.m = [\"1 kg\", 1.5]\ndrag.c = { from = 0.001, to = 0.002, count = 3 }\n[run]";
    fs::write(folder.join("sweep.toml"), TOP.replace("[run]", sweep)).unwrap();
    let told = printed(&folder, &["sweep", "sweep.toml", "--out", "."]);
    assert!(told.lines().take(7).all(|line| line.len() <= 110), "{told}");
    assert!(told.lines().nth(7).unwrap().ends_with("more columns are in sweep.sweep.csv"), "{told}");
    let table = fs::read_to_string(folder.join("sweep.sweep.csv")).unwrap();
    let mut lines = table.lines();
    assert!(lines.next().unwrap().starts_with("gravity.m,drag.c,t,velocity_x,"));
    let points: Vec<_> = lines.map(|line| line.split(',').take(2).collect::<Vec<_>>().join(" ")).collect();
    assert_eq!(points, ["1 kg 0.001", "1 kg 0.0015", "1 kg 0.002", "1.5 0.001", "1.5 0.0015", "1.5 0.002"]);
    let row: Vec<f64> = table.lines().nth(6).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    let alone = self::rows(&folder, &TOP.replace("\"1 kg\"", "1.5").replace("1e-3", "0.002")).pop().unwrap();
    assert_eq!(row[2..17], alone[..]);

    // Points whose run stops have a row without numbers.
    let faster = "[sweep]\nstart.velocity = [[0, 0, 1], [0, 0, 1000]]\n[run]";
    fs::write(folder.join("faster.toml"), TOP.replace("[run]", faster)).unwrap();
    let output = called(&folder, &["sweep", "faster.toml", "--out", "."]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3));
    assert!(message.starts_with("note: start.velocity = 0 0 1000 gave no row: faster.toml:22:8: stopped at t = 0 s: "));
    assert!(message.ends_with("error: 1 scenes of the sweep stopped\n"), "{message}");
    let table = fs::read_to_string(folder.join("faster.sweep.csv")).unwrap();
    assert_eq!(table.lines().nth(2).unwrap(), format!("0 0 1000{}", ",".repeat(17)));
}

/// A file with an accuracy agrees with a program with the same accuracy, to the bit.
#[test]
fn a_file_may_ask_for_an_accuracy() {
    let text = TOP.replace("step = \"10 ms\"", "accuracy = 1e-7").replace("[drag]\nc = 1e-3\n", "");
    let rows = rows(&folder("asked"), &text);
    let last = rows.last().unwrap();

    let (attitude, velocity) = start();
    let accuracy = Accuracy { tolerance: 1e-7, horizon: 2.0 };
    let stepper = Stepper::for_accuracy(body() + gravity(), accuracy, attitude, velocity).unwrap();
    let mut state = stepper.start();
    stepper.run(&mut state).unwrap();
    assert_eq!(rows.len() as u64, stepper.choice().steps + 1);
    assert_eq!(last[1..4], *stepper.velocity(&state).as_slice());
}

/// The rates of Euler angles and the angular velocity agree in their motion.
#[test]
fn rates_of_euler_angles() {
    let angles = Vector3::new(0.3, 0.8, -0.5);
    let rates = Vector3::new(1.5, -0.7, 2.5);
    let at = |t: f64| {
        let angles = angles + rates * t;
        let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
        about(Vector3::z_axis(), angles.x) * about(Vector3::x_axis(), angles.y) * about(Vector3::z_axis(), angles.z)
    };
    let expected = (at(-1e-4).inverse() * at(1e-4)).scaled_axis() / 2e-4;
    let start = "euler = [0.3, 0.8, -0.5]\neuler_rates = [1.5, -0.7, 2.5]\n";
    let text = TOP.replace("euler = [0, \"45 deg\", 0]\nvelocity = [0, 0, \"60 rpm\"]\n", start);
    let row = &self::rows(&folder("rates"), &text)[0];
    let velocity = Vector3::new(row[1], row[2], row[3]);
    assert!((velocity - expected).norm() < 1e-6, "{velocity} {expected}");
    let axis = Vector3::new(row[8], row[9], row[10]);
    assert!((axis - at(0.0) * Vector3::z()).norm() < 1e-14, "{axis}");
}

/// A stream of Arrow and a table of the same run agree; a run may write both.
#[test]
fn a_run_as_a_stream_of_arrow() {
    let folder = folder("a_run_as_a_stream_of_arrow");
    fs::write(folder.join("top.toml"), TOP).unwrap();
    let csv = printed(&folder, &["run", "top.toml", "--csv", "--out", "one"]);
    let both = printed(&folder, &["run", "top.toml", "--csv", "--arrow", "--out", "both"]);
    assert!(!csv.contains("top.arrow") && both.contains("top.arrows "), "{both}");
    let [one, other] = ["one", "both"].map(|out| fs::read(folder.join(out).join("top.csv")).unwrap());
    assert!(one == other);
    // The stream has 201 rows of twelve doubles and the time, little-endian, column by column in one block.
    let stream = fs::read(folder.join("both/top.arrows")).unwrap();
    let rows = table(&String::from_utf8(one).unwrap());
    for column in 0..rows[0].len() {
        let bytes: Vec<u8> = rows.iter().flat_map(|row| row[column].to_le_bytes()).collect();
        assert!(stream.windows(bytes.len()).any(|window| window == bytes), "column {column}");
    }
}

/// Runs the top for a number of steps, with a row every hundredth of the run and bounded memory.
#[cfg(target_os = "linux")]
fn long_run(steps: u64) {
    let folder = folder("long_run");
    let duration = format!("duration = {}", steps / 100);
    let text = TOP.replace("duration = 2", &duration).replace("[drag]\nc = 1e-3\n", "[output]\nevery = 100\n");
    fs::write(folder.join("top.toml"), text).unwrap();
    let limited = format!("ulimit -d 51200 && exec '{PROGRAM}' run top.toml --csv --out .");
    let output = Command::new("sh").current_dir(&folder).args(["-c", &limited]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let rows = fs::read_to_string(folder.join("top.csv")).unwrap().lines().count();
    assert_eq!(rows as u64, steps / 100 + 2);
    fs::remove_dir_all(&folder).unwrap();
}

/// Runs in 50 MB, with pictures.
#[test]
#[cfg(target_os = "linux")]
fn memory_does_not_grow_with_a_run() {
    long_run(2_000_000);
}

#[test]
#[cfg(target_os = "linux")]
#[ignore = "minutes: cargo test --release -p liestep-cli --test program -- --ignored a_run_of_a_hundred_million_steps"]
fn a_run_of_a_hundred_million_steps() {
    long_run(100_000_000);
}
