//! Satellites on orbits, compared with integrations by Newton's law instead of Kepler's.

use std::cell::Cell;
use std::fs;

use nalgebra::{Matrix3, Quaternion, SVector, UnitQuaternion, Vector3};

use crate::called::{folder, printed, refused, refuses, rows, table};

/// s.
const PERIOD: f64 = 6000.0;
/// The mean motion, rad/s.
const RATE: f64 = std::f64::consts::TAU / PERIOD;

fn satellite(effect: &str, normal: [f64; 3], e: f64, start: &str, steps: u32) -> String {
    format!(
        "title = \"A satellite\"\n[body]\nmoments = [100, 250, 300]\n[start]\n{start}\n[run]\nduration = 7800\n\
         step = {:?}\n[output]\ncolumns = [\"quaternion\", \"velocity\", \"energy\", \"spatial-momentum\"]\n\
         {effect}[orbit]\nperiod = \"100 min\"\nnormal = {normal:?}\neccentricity = {e}\nphase = \"40 deg\"\n",
        7800.0 / f64::from(steps)
    )
}

const GRADIENT: &str = "[gravity_gradient]\ndirection = \"nadir\"\n";
const DAMPING: &str =
    "[magnetic_damping]\nk = 1e7\n[magnetic_damping.field]\nequator = [\"2 µT\", \"5 µT\", \"25 µT\"]\n";

const AIR: &str = "[air_drag]\nc = 0.05\nair = \"orbit\"\n";

/// One step of the classical Runge–Kutta method.
fn rk4<const N: usize>(y: &mut SVector<f64, N>, h: f64, f: &dyn Fn(&SVector<f64, N>) -> SVector<f64, N>) {
    let a = f(y);
    let b = f(&(*y + a * (0.5 * h)));
    let c = f(&(*y + b * (0.5 * h)));
    let d = f(&(*y + c * h));
    *y += (a + (b + c) * 2.0 + d) * (h / 6.0);
}

/// A torque as a function of the satellite's position, its angular velocity and the rotation from space to body.
type Torque<'a> = &'a dyn Fn(Vector3<f64>, &Vector3<f64>, &Matrix3<f64>) -> Vector3<f64>;

/// Integrates satellite and planet by Newton's law, and the body by Euler's equations. Returns the velocity and the
/// attitude after 7800 s.
fn integrated(
    e: f64,
    normal: Vector3<f64>,
    attitude: UnitQuaternion<f64>,
    velocity: Vector3<f64>,
    torque: Torque<'_>,
) -> (Vector3<f64>, UnitQuaternion<f64>) {
    let J = Matrix3::from_diagonal(&Vector3::new(100.0, 250.0, 300.0));
    let periapsis = (Vector3::x() - normal * normal.x).normalize();
    let f = |y: &SVector<f64, 13>| {
        let part = |place: usize| Vector3::new(y[place], y[place + 1], y[place + 2]);
        let (place, moving, turning) = (part(0), part(3), part(6));
        // Lengths in semi-major axes.
        let fall = place * (-RATE * RATE / place.norm().powi(3));
        let q = Quaternion::new(y[9], y[10], y[11], y[12]);
        let R = UnitQuaternion::new_normalize(q).to_rotation_matrix();
        // The position in the body frame.
        let seen = R.transpose() * place;
        let sum = torque(seen, &turning, &R.transpose().into_inner());
        let spin = J.try_inverse().unwrap() * (sum - turning.cross(&(J * turning)));
        let q = q * Quaternion::from_imag(turning) * 0.5;
        SVector::from_iterator(moving.iter().chain(fall.iter()).chain(spin.iter()).copied().chain([q.w, q.i, q.j, q.k]))
    };
    let (place, fast) = (periapsis * (1.0 - e), normal.cross(&periapsis) * (RATE * ((1.0 + e) / (1.0 - e)).sqrt()));
    let q = attitude.quaternion();
    let mut y =
        SVector::from_iterator(place.iter().chain(fast.iter()).copied().chain([0.0; 3]).chain([q.w, q.i, q.j, q.k]));
    let till = |y: &mut SVector<f64, 13>, time: f64| (0..20_000).for_each(|_| rk4(y, time / 20_000.0, &f));
    till(&mut y, PERIOD / 9.0);
    for (place, number) in velocity.iter().chain([q.w, q.i, q.j, q.k].iter()).enumerate() {
        y[6 + place] = *number;
    }
    till(&mut y, 7800.0);
    (Vector3::new(y[6], y[7], y[8]), UnitQuaternion::new_normalize(Quaternion::new(y[9], y[10], y[11], y[12])))
}

#[test]
fn in_space_it_is_as_newtons_and_eulers_equations_have_it() {
    let folder = folder("in_space_it_is_as_newtons_and_eulers_equations_have_it");
    let normal = Vector3::new(0.6, -0.48, 0.64);
    let (attitude, velocity) =
        (UnitQuaternion::new_normalize(Quaternion::new(0.8, 0.1, -0.5, 0.3)), Vector3::new(1e-3, -6e-4, 1.1e-3));
    let start = format!("quaternion = [0.8, 0.1, -0.5, 0.3]\nvelocity = {:?}", velocity.as_slice());
    let J = Matrix3::from_diagonal(&Vector3::new(100.0, 250.0, 300.0));
    let gradient = |place: Vector3<f64>, _: &Vector3<f64>, _: &Matrix3<f64>| {
        place.cross(&(J * place)) * (3.0 * RATE * RATE / place.norm().powi(5))
    };
    // The gradient of the potential m·r/r³ of a dipole m whose field at its equator is −m.
    let damping = |place: Vector3<f64>, turning: &Vector3<f64>, to_body: &Matrix3<f64>| {
        let m = to_body * Vector3::new(-2e-6, -5e-6, -25e-6);
        let (r, along) = (place.norm(), m.dot(&place));
        let field = place * (3.0 * along / r.powi(5)) - m / r.powi(3);
        field.cross(turning).cross(&field) * -1e7
    };
    // The direction of the planet turns at twice the areal velocity, a constant, over the square of the distance.
    let areal = Cell::new(0.0);
    let drag = |place: Vector3<f64>, turning: &Vector3<f64>, to_body: &Matrix3<f64>| {
        (to_body * normal * (areal.get() / place.norm_squared()) - turning) * 0.05
    };
    for (effect, eccentric, torque) in
        [(GRADIENT, 0.1, &gradient as Torque<'_>), (DAMPING, 0.1, &damping), (AIR, 0.3, &drag)]
    {
        for e in [0.0_f64, eccentric] {
            areal.set((1.0 - e * e).sqrt() * RATE);
            let (expected, turned) = integrated(e, normal, attitude, velocity, torque);
            let error = |steps| {
                let text = satellite(effect, normal.into(), e, &start, steps);
                let rows = rows(&folder, &text);
                let end = &rows[rows.len() - 1];
                let q = UnitQuaternion::new_normalize(Quaternion::new(end[1], end[2], end[3], end[4]));
                (q.angle_to(&turned), (Vector3::new(end[5], end[6], end[7]) - expected).norm() / RATE)
            };
            let [coarse, fine] = [error(1560), error(3120)];
            assert!(fine.0 < 1e-4 && fine.1 < 1e-4, "{effect}{e}: {coarse:?} {fine:?}");
            assert!((3.5..4.5).contains(&(coarse.0 / fine.0)), "{effect}{e}: {coarse:?} {fine:?}");
        }
    }
}

/// The energy `E − n L·ẑ` in the orbiting frame is conserved on a circle, with `E` at the present direction of the
/// planet.
#[test]
fn the_energy_is_that_of_the_moment() {
    let folder = folder("the_energy_is_that_of_the_moment");
    let start = "quaternion = [0.8, 0.1, -0.5, 0.3]\nvelocity = [1e-3, -6e-4, 1.1e-3]";
    let rows = rows(&folder, &satellite(GRADIENT, [0.0, 0.0, 1.0], 0.0, start, 7800));
    let integral = |row: &Vec<f64>| row[8] - RATE * row[11];
    let (first, energies) = (integral(&rows[0]), rows.iter().map(|row| row[8]));
    let swing = energies.clone().fold(0.0, f64::max) - energies.fold(f64::MAX, f64::min);
    let off = rows.iter().map(|row| (integral(row) - first).abs()).fold(0.0, f64::max);
    assert!(off < 1e-4 * swing, "{off} {swing}");
}

/// Events between steps, a sweep, an ensemble and a page work along an orbit, too.
#[test]
fn all_commands_have_orbits() {
    let folder = folder("all_commands_have_orbits");
    let start = "euler = [0.9, 0, 0]\nvelocity = [0, 0, 1e-3]";
    let text = satellite(GRADIENT, [0.0, 0.0, 1.0], 0.1, start, 780)
        + "[picture]\naxis = [1, 0, 0]\npanels = [\"tilt\", \"energy\"]\n[sweep]\norbit.eccentricity = [0.0, 0.05]\n\
             [ensemble]\nmembers = 3\nevery = 390\ndraw.orbit.phase = { from = \"40 deg\", to = \"40.0001 deg\" }\n";
    let event = "[[event]]\nname = \"sideways\"\naxis_x = 0\n";
    fs::write(folder.join("events.toml"), text.replace("\"energy\", \"spatial", "\"spatial") + event).unwrap();
    printed(&folder, &["run", "events.toml", "--csv", "--out", "."]);
    let events = fs::read_to_string(folder.join("events.events.csv")).unwrap();
    // The first axis passes the plane of the second and third axes of space at a right angle.
    for row in events.lines().skip(1) {
        let numbers: Vec<f64> = row.split(',').skip(2).map(|cell| cell.parse().unwrap()).collect();
        let turned = 2.0 * numbers[4].atan2(numbers[1]);
        assert!(turned.cos().abs() < 1e-12, "{row}");
    }
    assert!(events.lines().count() > 1);
    fs::write(folder.join("scene.toml"), &text).unwrap();
    printed(&folder, &["run", "scene.toml", "--csv", "--html", "--out", "."]);
    printed(&folder, &["sweep", "scene.toml", "--out", "."]);
    let swept = table(&fs::read_to_string(folder.join("scene.sweep.csv")).unwrap());
    assert!(swept.len() == 2 && (swept[0][2] - swept[1][2]).abs() > 1e-4, "{swept:?}");
    // A member agrees with the scene in the middle and at the end, in its energy, too.
    let run = table(&fs::read_to_string(folder.join("scene.csv")).unwrap());
    printed(&folder, &["ensemble", "scene.toml", "--out", "."]);
    let store = liestep_ensemble::Store::folder(folder.join("scene.ensemble")).unwrap();
    let (_, path) = store.files().unwrap().remove(0);
    let rows = liestep_ensemble::Store::read(&path).unwrap().rows;
    for (row, step) in [(1, 390), (2, 780)] {
        assert_eq!(rows.step[row], step);
        for (place, column) in rows.columns.iter().take(8).enumerate() {
            let (own, of_run) = (column[row], run[usize::try_from(step).unwrap()][place + 1]);
            let allowed = if place == 7 { 1e-8 } else { 1e-5 };
            assert!((own.abs() - of_run.abs()).abs() < allowed, "{place}: {own} {of_run}");
        }
    }
}

/// The members of a file along an orbit with an event have its default columns but the energy, which isn't known at the event.
/// A file that lists the energy is refused at its list.
#[test]
fn members_along_an_orbit_have_default_columns() {
    let folder = folder("members_along_an_orbit_have_default_columns");
    let text = satellite(GRADIENT, [0.0, 0.0, 1.0], 0.1, "euler = [0.9, 0, 0]\nvelocity = [0, 0, 1e-3]", 780)
        + "[ensemble]\nmembers = 3\ndraw.orbit.phase = { from = \"40 deg\", to = \"41 deg\" }\n\
           [[event]]\nname = \"sideways\"\naxis_x = 0\n";
    let columns = "[output]\ncolumns = [\"quaternion\", \"velocity\", \"energy\", \"spatial-momentum\"]\n";
    fs::write(folder.join("lists.toml"), &text).unwrap();
    let line = 1 + text.lines().position(|line| line.starts_with("columns = ")).unwrap();
    refuses(&folder, &["ensemble", "lists.toml"], 1, &format!("lists.toml:{line}:1"));
    refuses(&folder, &["ensemble", "lists.toml"], 1, "leave `energy` out of `columns`");
    fs::write(folder.join("default.toml"), text.replace(columns, "")).unwrap();
    let told = printed(&folder, &["ensemble", "default.toml", "--out", "."]);
    assert!(told.contains("3 finished") && told.contains("sideways: ") && !told.contains("energy"), "{told}");
    let store = liestep_ensemble::Store::folder(folder.join("default.ensemble")).unwrap();
    let shard = liestep_ensemble::Store::read(&store.files().unwrap()[0].1).unwrap();
    let has = |name: &str| shard.names.iter().any(|own| own == name);
    assert!(has("velocity_x") && has("spatial_momentum_z") && has("q_w") && !has("energy"), "{:?}", shard.names);
}

/// Steps with `dt ∝ r^{3/2}` end with the second revolution, and are of second order in their number.
#[test]
fn steps_follow_an_orbit() {
    let folder = folder("steps_follow_an_orbit");
    let start = "euler = [0.9, 0, 0]\nvelocity = [0, 0, 1e-3]";
    let text = satellite(GRADIENT, [0.0, 0.0, 1.0], 0.7, start, 1).replace("250, 300", "105, 110");
    let text = text.replace("duration = 7800", "duration = 12000");
    let end = |steps: &str| {
        let rows = rows(&folder, &text.replace("step = 7800.0", steps));
        let end = &rows[rows.len() - 1];
        assert!((end[0] - 12_000.0).abs() < 1e-8, "{}", end[0]);
        2.0 * end[4].atan2(end[1])
    };
    let fine = end("step = 0.5");
    let [coarse, short] =
        ["steps_per_orbit = 400", "steps_per_orbit = 800"].map(|steps| (0.5 * (end(steps) - fine)).sin().abs());
    assert!(short < 1e-3 && (3.8..4.2).contains(&(coarse / short)), "{coarse:e} {short:e}");
    let both = text.replace("step = 7800.0", "steps_per_orbit = 400") + DAMPING;
    fs::write(folder.join("both.toml"), both).unwrap();
    let told = [&["check", "both.toml"][..], &["run", "both.toml", "--html"]].map(|words| printed(&folder, words));
    let shown = ["out/both.svg", "out/both.html"].map(|name| fs::read_to_string(folder.join(name)).unwrap());
    assert_eq!([told, shown].as_flattened().concat().matches(" 15 s on the average").count(), 4);
    // The step of (3.13) turns a body at the rate Ω too far by (hΩ)³/6, most in the long steps far from the planet. The
    // geodesic step doesn't.
    let text = text.replace("105, 110]", "105, 110]\nkinetic = \"geodesic\"");
    let geodesic = rows(&folder, &text.replace("step = 7800.0", "steps_per_orbit = 400")).pop().unwrap();
    let geodesic = (geodesic[4].atan2(geodesic[1]) - 0.5 * fine).sin().abs();
    assert!(coarse > 9e-4 && geodesic < 1e-4, "{coarse:e} {geodesic:e}");
}

/// Times in orbits are those in seconds to the bit, and the summary has the orbits with their period.
#[test]
fn times_may_be_in_orbits() {
    let folder = folder("times_may_be_in_orbits");
    let text = satellite(GRADIENT, [0.0, 0.0, 1.0], 0.1, "euler = [0.9, 0, 0]\nvelocity = [0, 0, 1e-3]", 780);
    let in_orbits = text.replace("duration = 7800\nstep = 10.0", "duration = \"1.5 orbits\"\nstep = \"0.0025 orbits\"");
    let in_seconds = text.replace("duration = 7800\nstep = 10.0", "duration = 9000\nstep = 15");
    assert_eq!(rows(&folder, &in_orbits), rows(&folder, &in_seconds));
    let told = printed(&folder, &["run", "scene.toml", "--out", "."]);
    assert!(told.contains("gravity gradient, 1.5 orbits of 6000 s, 600 steps of 15 s"), "{told}");
    for (run, message) in [
        (
            "duration = \"1.5 orbits\"\nstep = 7",
            "which isn't a whole number of steps of 7 s; the nearest is 9002 s; a `step` may be in orbits",
        ),
        ("duration = \"-1 orbit\"\nstep = 7", "a number of orbits is above zero"),
        ("duration = \"one orbit\"\nstep = 7", "a number of orbits is above zero"),
        ("duration = \"3 orbis\"\nstep = 7", "orbis"),
    ] {
        let told = refused(&folder, &text.replace("duration = 7800\nstep = 10.0", run));
        assert!(told.contains(message) && told.contains("top.toml:8:"), "{run}: {told}");
    }
    let free = in_orbits.split("[gravity_gradient]").next().unwrap();
    assert!(refused(&folder, free).contains("top.toml:8:12: the file has no table `[orbit]`: give a time in s"));
}

/// The number behind these words in a text.
fn number_behind(text: &str, words: &str) -> f64 {
    let behind = text.split_once(words).unwrap_or_else(|| panic!("{text}")).1;
    behind.split_whitespace().next().unwrap().parse().unwrap()
}

/// The error at the end of a run by steps per orbit is that against many more of them.
#[test]
fn the_end_of_steps_per_orbit_is_estimated() {
    let folder = folder("the_end_of_steps_per_orbit_is_estimated");
    let text = satellite(GRADIENT, [0.0, 0.0, 1.0], 0.4, "euler = [0.9, 0, 0]\nvelocity = [0, 0, 1e-3]", 780);
    // Whole orbits end at the same place by any number of steps.
    let by = |steps: u32| {
        text.replace("duration = 7800\nstep = 10.0", &format!("duration = \"2 orbits\"\nsteps_per_orbit = {steps}"))
    };
    let quaternion = |row: &[f64]| Quaternion::new(row[1], row[2], row[3], row[4]);
    let exact = quaternion(rows(&folder, &by(6400)).last().unwrap());
    for steps in [400, 425] {
        let end = quaternion(rows(&folder, &by(steps)).last().unwrap());
        let told = printed(&folder, &["run", "scene.toml", "--out", "."]);
        let found = number_behind(&told, "the end is off by about ");
        let off = 2.0 * (end.conjugate() * exact).imag().norm().min(1.0).asin();
        println!("{steps}: {found:e} and {off:e}");
        assert!(found > 0.7 * off && found < 1.4 * off, "{steps}: {found:e} and {off:e}: {told}");
        assert!(told.contains("on the average show"), "{told}");
    }
}
