//! Values over time in files of several bodies: of joints, springs, gravity and effects on one of them, against integrals, an
//! integration of the equation of motion and the file of one body.

use std::fs;

use crate::called::{apart, called, folder, printed, refused, rows};

/// Two bodies on one axis through both, which turn about it against each other.
fn pair(kind: &str, motor: &str) -> String {
    let body = |name: &str, moments: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nm = 2\nmoments = {moments}\nposition = [0, 0, 0]\nstart.euler = [0, 0, 0]\n\
             start.velocity = [0, 0, 0]\n"
        )
    };
    format!(
        "title = \"Two bodies on an axis\"\n{}{}[[joint]]\nname = \"hinge\"\nkind = \"{kind}\"\nbodies = [\"a\", \"b\"]\n\
         at = [[0, 0, 0], [0, 0, 0]]\naxes = [[0, 0, 1], [0, 0, 1]]\n{motor}\n[run]\nstep = 0.4\nduration = 4\n[output]\n\
         columns = [\"velocity\", \"moving\"]\n",
        body("a", "[1, 2, 2.5]"),
        body("b", "[3, 3, 4]"),
    )
}

const PULSE: &str = "{ times = [0, 0.7, 2.2], values = [0, 2, 0], between = \"steps\" }";

/// The momenta about the axis, and along it, of both bodies of [`pair`] in a row.
fn momenta(row: &[f64]) -> [f64; 4] {
    [row[3] * 2.5, row[6] * 4.0, row[9] * 2.0, row[12] * 2.0]
}

/// A motor that is on from .7 s to 2.2 s gives its bodies opposite impulses, which are the integral of its torque or force by
/// steps of .4 s; on lines, by a table of another file and with the bodies named in the other order, too.
#[test]
fn a_motor_has_its_impulse() {
    let folder = folder("a_motor_has_its_impulse");
    let end = |kind: &str, motor: &str| momenta(rows(&folder, &pair(kind, motor)).last().unwrap());
    let near = |found: [f64; 4], expected: [f64; 4]| {
        let off = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max);
        assert!(off < 1e-13, "{found:?} and not {expected:?}");
    };
    near(end("pin", &format!("torque = {PULSE}")), [-3.0, 3.0, 0.0, 0.0]);
    near(end("slider", &format!("force = {PULSE}")), [0.0, 0.0, -3.0, 3.0]);
    // Up to 1.5 N m at 1 s, and down to zero at 3.1 s: 3.1 · 1.5/2.
    let line = "torque = { times = [0, 1, 3.1, 5], values = [0, 1500, 0, 0], unit = \"mN m\", between = \"lines\" }";
    near(end("pin", line), [-2.325, 2.325, 0.0, 0.0]);
    fs::write(folder.join("motor.csv"), "when, torque\n0, 0\n0.7, 2\n2.2, 0\n").unwrap();
    let csv = "torque = { csv = \"motor.csv\", time = \"when\", columns = [\"torque\"], between = \"steps\" }";
    near(end("pin", csv), [-3.0, 3.0, 0.0, 0.0]);
    // Within the pulse: from .7 s to 1.6 s.
    let rows_of_pulse = rows(&folder, &pair("pin", &format!("torque = {PULSE}")));
    near(momenta(&rows_of_pulse[4]), [-1.8, 1.8, 0.0, 0.0]);
    let to_space =
        pair("pin", &format!("torque = {PULSE}")).replace("bodies = [\"a\", \"b\"]", "bodies = [\"b\", \"space\"]");
    near(momenta(rows(&folder, &to_space).last().unwrap()), [0.0, -3.0, 0.0, 0.0]);
    // Sums of values in the middles of steps have a closed form.
    let formula = end("pin", "torque = { formula = \"2 * sin(1.5 * t)\" }");
    let sum = 2.0 * 0.4 * (1.5_f64 * 4.0 / 2.0).sin().powi(2) / (1.5_f64 * 0.4 / 2.0).sin();
    near(formula, [-sum, sum, 0.0, 0.0]);
    printed(&folder, &["check", "scene.toml"]);
}

/// An arm on a motor, with a spring and friction in its pin, in a gravity that changes.
fn arm(terms: &str, run: &str) -> String {
    format!(
        "title = \"A driven arm\"\ngravity = {{ g = {{ formula = \"9.81 + sin(3 * t)\" }}, up = [0, 0, 1] }}\n\
         [[body]]\nname = \"arm\"\nm = 1.5\nmoments = [0.2, 0.3, 0.25]\n[[joint]]\nname = \"shoulder\"\nkind = \"pin\"\n\
         bodies = [\"space\", \"arm\"]\nat = [[0, 0, 0], [0, 0, 0.4]]\naxes = [[0, 1, 0], [0, 1, 0]]\nangle = 0.5\nrate = -0.3\n\
         {terms}\n[run]\nduration = 4\n{run}\n[output]\ncolumns = [\"angle\", \"velocity\"]\n"
    )
}

const SPRING: &str = "stiffness = { formula = \"2 + sin(t)\" }\nrest = { formula = \"0.3 * cos(2 * t)\" }\n";

/// Angle and rate of [`arm`] after 4 s by the method of Runge and Kutta, with these torques and coefficients of friction at a time.
fn integrated(torque: fn(f64) -> f64, friction: fn(f64) -> f64) -> [f64; 2] {
    let (m, l) = (1.5, 0.4);
    let slope = |t: f64, [angle, rate]: [f64; 2]| {
        let (g, k, rest) = (9.81 + (3.0 * t).sin(), 2.0 + t.sin(), 0.3 * (2.0 * t).cos());
        let moment = torque(t) - k * (angle - rest) - friction(t) * rate - m * g * l * angle.sin();
        [rate, moment / (0.3 + m * l * l)]
    };
    let beside = |state: [f64; 2], slope: [f64; 2], h: f64| [state[0] + h * slope[0], state[1] + h * slope[1]];
    let (mut state, h) = ([0.5, -0.3], 1e-3);
    for step in 0..4000 {
        let t = f64::from(step) * h;
        let first = slope(t, state);
        let second = slope(t + 0.5 * h, beside(state, first, 0.5 * h));
        let third = slope(t + 0.5 * h, beside(state, second, 0.5 * h));
        // The corners of lines are between steps, so that a torque at one is that of either side.
        let fourth = slope(t + h, beside(state, third, h));
        let all = [0, 1].map(|at| (first[at] + 2.0 * second[at] + 2.0 * third[at] + fourth[at]) / 6.0);
        state = beside(state, all, h);
    }
    state
}

/// A number on lines between those at 0, 1, 2 and 4 s.
fn on_lines(t: f64, [a, b, c, d]: [f64; 4]) -> f64 {
    let on = |share: f64, from: f64, to: f64| from + (to - from) * share;
    if t < 1.0 {
        on(t, a, b)
    } else if t < 2.0 {
        on(t - 1.0, b, c)
    } else {
        on((t - 2.0) / 2.0, c, d)
    }
}

/// An arm whose motor, spring, friction and weight change with time moves as its equation says: by the step with its order of
/// two, and without friction by a composition with its order of four.
#[test]
fn a_driven_arm_has_its_order() {
    let folder = folder("a_driven_arm_has_its_order");
    let off = |terms: &str, run: String, exact: [f64; 2]| {
        let rows = rows(&folder, &arm(terms, &run));
        let end = rows.last().unwrap();
        (end[1] - exact[0]).hypot(end[3] - exact[1])
    };
    let torque = "torque = { times = [0, 1, 2, 4], values = [0, 3, -2, 1], between = \"lines\" }\n\
                  damping = { times = [0, 1, 2, 4], values = [0, 0.5, 0.1, 0.3], between = \"lines\" }\n";
    let exact = integrated(|t| on_lines(t, [0.0, 3.0, -2.0, 1.0]), |t| on_lines(t, [0.0, 0.5, 0.1, 0.3]));
    let steps = |steps: [&'static str; 2], method: &'static str| steps.map(|step| format!("step = {step}\n{method}"));
    let [coarse, fine] = steps(["0.02", "0.01"], "").map(|run| off(&format!("{SPRING}{torque}"), run, exact));
    let order = (coarse / fine).log2();
    println!("step: {coarse:e}, {fine:e}, of order {order}");
    assert!(fine < 2e-3 && (order - 2.0).abs() < 0.02, "{coarse:e}, {fine:e}, of order {order}");
    let exact = integrated(|t| 3.0 * (5.0 * t).sin(), |_| 0.0);
    let suzuki = steps(["0.1", "0.05"], "method = { composition = \"Suzuki 4\" }");
    let smooth = format!("{SPRING}torque = {{ formula = \"3 * sin(5 * t)\" }}");
    let [coarse, fine] = suzuki.map(|run| off(&smooth, run, exact));
    let order = (coarse / fine).log2();
    println!("composition: {coarse:e}, {fine:e}, of order {order}");
    assert!(fine < 1e-4 && (order - 4.0).abs() < 0.2, "{coarse:e}, {fine:e}, of order {order}");
}

/// An accuracy chooses a method beside values over time, whose error is as small as is asked for: a composition of an arm, and the
/// step where there is friction; of one body, too.
#[test]
fn an_accuracy_is_kept_beside_values_over_time() {
    let folder = folder("an_accuracy_is_kept_beside_values_over_time");
    let off = |terms: &str, accuracy: f64, exact: [f64; 2]| {
        let rows = rows(&folder, &arm(&format!("{SPRING}{terms}"), &format!("accuracy = {accuracy:e}")));
        let end = rows.last().unwrap();
        let told = printed(&folder, &["run", "scene.toml", "--out", "."]);
        println!("{told}");
        ((end[1] - exact[0]).hypot(end[3] - exact[1]), told)
    };
    let exact = integrated(|t| 3.0 * (5.0 * t).sin(), |_| 0.0);
    let (smooth, told) = off("torque = { formula = \"3 * sin(5 * t)\" }", 1e-7, exact);
    // Attitudes and velocities count relative to theirs, of some 2 and 5 rad/s.
    assert!(smooth < 1e-6 && smooth > 1e-10 && told.contains("composition"), "{smooth:e}\n{told}");
    let exact = integrated(|t| on_lines(t, [0.0, 3.0, -2.0, 1.0]), |t| on_lines(t, [0.0, 0.5, 0.1, 0.3]));
    let lines = |key: &str, values: &str| {
        format!("{key} = {{ times = [0, 1, 2, 4], values = {values}, between = \"lines\" }}\n")
    };
    let (rough, told) = off(&(lines("torque", "[0, 3, -2, 1]") + &lines("damping", "[0, 0.5, 0.1, 0.3]")), 1e-4, exact);
    assert!(rough < 1e-3 && !told.contains("composition"), "{rough:e}\n{told}");
    // A pulse that is on from .7 s to 2.2 s on a body at rest, which turns by 2 · (1.5²/2 + 1.5 · 1.8)/2.5 until 4 s.
    let one = format!(
        "title = \"One\"\nbody.moments = [1, 2, 2.5]\nstart = {{ euler = [0, 0, 0], velocity = [0, 0, 0] }}\n[torque]\ntorque = \
         {}\n[run]\naccuracy = 1e-6\nduration = 4\n[output]\ncolumns = [\"quaternion\", \"momentum\"]\n",
        PULSE.replace("[0, 2, 0]", "[[0, 0, 0], [0, 0, 2], [0, 0, 0]]")
    );
    let rows = rows(&folder, &one);
    let end = rows.last().unwrap();
    let half: f64 = (1.5 * 1.5 / 2.0 + 1.5 * 1.8) / 2.5;
    assert!((end[1] - half.cos()).hypot(end[4] - half.sin()) < 2e-6 && (end[7] - 3.0).abs() < 1e-13, "{end:?}");
}

/// Dry friction in a slider that is on from .7 s to 2.2 s takes its impulse from one body, and gives it to the other.
#[test]
fn dry_friction_in_a_slider_has_its_impulse() {
    let folder = folder("dry_friction_in_a_slider_has_its_impulse");
    let friction = PULSE.replace("[0, 2, 0]", "[0, 0.4, 0]");
    let text = pair("slider", &format!("friction = {{ force = {friction}, below = 1e-7 }}"));
    let moving = text.replacen("position = [0, 0, 0]", "position = [0, 0, 0]\nmoving = [0, 0, 1]", 1);
    let found = momenta(rows(&folder, &moving).last().unwrap());
    assert!((found[2] - 1.4).abs() < 1e-12 && (found[3] - 0.6).abs() < 1e-12, "{found:?}");
}

/// Torques and drag on one of several bodies have steps back, so that a composition has its order.
#[test]
fn compositions_beside_forces_on_bodies_have_their_order() {
    let folder = folder("compositions_beside_forces_on_bodies_have_their_order");
    let end = |step: &str, method: &str| {
        let text = arm("", &format!("step = {step}\nmethod = {{ composition = \"{method}\" }}"));
        let effects = "torque.torque = { formula = \"[0, sin(5 * t), 0]\" }\ndrag.c = 0.2\n[[joint]]";
        let rows = rows(&folder, &text.replacen("[[joint]]", effects, 1));
        let end = rows.last().unwrap();
        [end[1], end[3]]
    };
    let exact = end("0.0125", "Kahan-Li 8");
    let off = |step: &str| end(step, "Suzuki 4").iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let [coarse, fine] = [off("0.1"), off("0.05")];
    let order = (coarse / fine).log2();
    println!("{coarse:e}, {fine:e}, of order {order}");
    assert!(fine < 1e-3 && (order - 4.0).abs() < 0.3, "{coarse:e}, {fine:e}, of order {order}");
}

const FIELD: &str =
    "{ times = [0, 0.7, 2], values = [[0.2, 0.5, 1], [1, -0.3, 0.4], [-0.5, 0.5, 0.2]], between = \"lines\" }";

/// The effects of [`FIELD`] on a body, and others over time.
fn effects(prefix: &str) -> String {
    format!(
        "{prefix}dipole = {{ moment = [0.3, 0.1, -0.2], field = {FIELD} }}\n\
         {prefix}torque.torque = {{ csv = \"torque.csv\", time = \"t\", columns = [\"x\", \"y\", \"z\"], between = \"steps\" }}\n\
         {prefix}drag = {{ c = {{ times = [0, 0.4, 1.3], values = [0, 0.2, 0], between = \"steps\" }} }}\n\
         {prefix}rotor = {{ spin = {{ formula = \"[0.1 * t, 0, sin(t)]\" }} }}\n"
    )
}

/// Effects over time on one of several bodies are those on a body alone, also on one that a pin without a torque holds.
#[test]
fn effects_over_time_are_those_of_one_body() {
    let folder = folder("effects_over_time_are_those_of_one_body");
    fs::write(folder.join("torque.csv"), "t,x,y,z\n0,0,0.2,0\n0.33,0.5,0,0.1\n1.5,0,0,0\n").unwrap();
    let start = "start.quaternion = [0.8, 0.1, -0.5, 0.3]\nstart.velocity = [0.3, -0.2, 0.5]\n";
    let run = "[run]\nduration = 2\nstep = 0.05\n[output]\ncolumns = [\"quaternion\", \"velocity\"]\n";
    let one = format!(
        "title = \"One\"\n{start}body = {{ moments = [1, 2, 2.5], kinetic = \"geodesic\" }}\n{}{run}",
        effects("")
    );
    let body =
        format!("[[body]]\nname = \"a\"\nm = 3\nmoments = [1, 2, 2.5]\nposition = [0, 0, 0]\n{start}{}", effects(""));
    let other = "[[body]]\nname = \"b\"\nm = 1\nmoments = [1, 1, 1]\nposition = [1, 0, 0]\nstart.euler = [0, 0, 0]\n\
                 start.velocity = [0, 0, 1]\ntorque.torque = { formula = \"[0, 0, t]\" }\n";
    let ball = "[[joint]]\nkind = \"ball\"\nbodies = [\"space\", \"a\"]\nat = [[0, 0, 0], [0, 0, 0]]\n";
    let one = rows(&folder, &one);
    for joint in ["", ball] {
        let several = rows(&folder, &format!("title = \"Two\"\n{body}{other}{joint}{run}"));
        let own: Vec<Vec<f64>> = several.iter().map(|row| [&row[..5], &row[9..12]].concat()).collect();
        println!("{:e}", apart(&one, &own));
        assert!(apart(&one, &own) < 1e-13, "{:e}", apart(&one, &own));
        // The moment of the other body is one: its rate is 1 + t²/2.
        assert!(several.iter().all(|row| (row[14] - 1.0 - row[0] * row[0] / 2.0).abs() < 1e-13));
    }
}

/// Values that don't change are those of a file without times.
#[test]
fn constant_values_over_time_are_constants() {
    let folder = folder("constant_values_over_time_are_constants");
    let text = |value: fn(&str) -> String| {
        VALUES.into_iter().fold(CHAIN.to_owned(), |text, (name, number)| text.replace(name, &value(number)))
    };
    let fixed = rows(&folder, &text(str::to_owned));
    for way in ["steps", "lines"] {
        let over = match way {
            "steps" => text(|number| format!("{{ times = [0], values = [{number}], between = \"steps\" }}")),
            _ => text(|number| {
                format!("{{ times = [-1, 0.33, 9], values = [{number}, {number}, {number}], between = \"lines\" }}")
            }),
        };
        let off = apart(&fixed, &rows(&folder, &over));
        println!("{way}: {off:e}");
        assert!(off < 1e-11, "{way}: {off:e}");
    }
}

/// Values of [`CHAIN`] by their names in its text.
const VALUES: [(&str, &str); 10] = [
    ("GRAVITY", "9.81"),
    ("TORQUE", "0.4"),
    ("DAMPING", "0.2"),
    ("STIFFNESS", "1.5"),
    ("REST", "0.3"),
    ("SLIDING", "0.1"),
    ("BELOW", "0.5"),
    ("SPRING", "20"),
    ("LENGTH", "0.6"),
    ("FORCE", "-0.7"),
];

const CHAIN: &str = r#"title = "A chain"
gravity = { g = GRAVITY, up = [0, 0, 1] }
[[body]]
name = "arm"
m = 1.5
moments = [0.2, 0.3, 0.25]
[[body]]
name = "hand"
m = 0.5
moments = [0.1, 0.1, 0.15]
[[body]]
name = "sled"
m = 2
moments = [0.4, 0.4, 0.4]
[[joint]]
kind = "pin"
bodies = ["space", "arm"]
at = [[0, 0, 0], [0, 0, 0.4]]
axes = [[0, 1, 0], [0, 1, 0]]
angle = 0.5
torque = TORQUE
damping = DAMPING
stiffness = STIFFNESS
rest = REST
[[joint]]
kind = "ball"
bodies = ["hand", "arm"]
at = [[0, 0, 0.3], [0, 0, -0.4]]
friction = { torque = SLIDING, below = BELOW }
[[joint]]
kind = "slider"
bodies = ["sled", "space"]
at = [[0, 0, 0], [1, 0, 0]]
axes = [[1, 0, 0], [1, 0, 0]]
force = FORCE
stiffness = STIFFNESS
damping = DAMPING
[[spring]]
bodies = ["hand", "sled"]
at = [[0, 0, 0], [0, 0.1, 0]]
k = SPRING
length = LENGTH
[run]
duration = 1
step = 0.01
[output]
columns = ["position", "quaternion", "velocity", "energy"]
"#;

/// A sweep and an ensemble vary constants beside values over time, and an event is found between steps.
#[test]
fn scenes_over_time_have_sweeps_ensembles_and_events() {
    let folder = folder("scenes_over_time_have_sweeps_ensembles_and_events");
    let event = "[[event]]\nname = \"quick\"\ncolumn = \"b_velocity_z\"\nvalue = 0.45\n";
    let scene = pair("pin", &format!("torque = {PULSE}")) + event;
    fs::write(folder.join("scene.toml"), format!("{scene}[sweep]\njoint.hinge.damping = [0.1, 0.2]\n")).unwrap();
    let told = printed(&folder, &["run", "scene.toml", "--out", "."]);
    // A torque of 2 N m for .9 s makes 4 · .45.
    assert!(told.contains("quick: once, first at t = 1.6 s"), "{told}");
    let told = printed(&folder, &["sweep", "scene.toml", "--out", "."]);
    assert!(told.contains("0.1") && told.contains("0.2"), "{told}");
    let draws = "[ensemble]\nmembers = 20\n[ensemble.draw]\nbody.b.moments = [3, 3, { from = 4, to = 5 }]\n";
    fs::write(folder.join("scene.toml"), format!("{scene}{draws}")).unwrap();
    let told = printed(&folder, &["ensemble", "scene.toml", "--out", "."]);
    assert!(told.contains("20 finished") && told.contains("quick: in 20 of 20 members"), "{told}");
}

/// Mistakes of values over time have their place and say what to write.
#[test]
fn mistakes_over_time_have_their_place() {
    let folder = folder("mistakes_over_time_have_their_place");
    for (motor, message) in [
        ("torque = { times = [1], values = [2], between = \"steps\" }", "a run starts at the time 0"),
        ("torque = { times = [0, 1], values = [2, 1], between = \"lines\" }", "the run ends at 4 s"),
        ("torque = { times = [0], values = [[0, 0, 2]], between = \"steps\" }", "invalid type"),
        ("damping = { times = [0, 1], values = [1, -1], between = \"steps\" }", "`damping` of `joint` can't be [-1.0]"),
        ("angle = { times = [0, 1], values = [1, 2], between = \"steps\" }", "both bodies of this joint have places"),
        ("limits = { from = { formula = \"t\" }, to = 1 }", "`limits.from` of `joint` can't change with time"),
        ("torque = { formula = \"1 / t\" }", "this has no value at the start, but [inf]"),
        ("torque = { formula = \"sin(x)\" }", "`x`"),
        ("torque = { formula = 3 }", "a formula is a text over the time `t`"),
        ("torque = { formula = \"t\", unit = \"mN m\" }", "a formula is a text over the time `t`"),
        ("force = { formula = \"t\" }", "a pin has no `force`; a motor that turns has a `torque`"),
    ] {
        let found = refused(&folder, &pair("pin", motor));
        assert!(found.contains(message) && found.contains("top.toml:22:"), "{motor}: {found}");
    }
    let pulse = pair("pin", &format!("torque = {PULSE}"));
    let mass = pulse.replacen("m = 2", "m = { formula = \"2 - t\" }", 1);
    let told = refused(&folder, &mass);
    assert!(told.contains("stopped at t = 2 s") && told.contains("value over time"), "{told}");
    let point = "m = 2\nmoments = { times = [0, 4], values = [[0, 0, 0], [1, 1, 1]], between = \"steps\" }";
    let told = refused(&folder, &pulse.replacen("m = 2\nmoments = [3, 3, 4]", point, 1));
    assert!(told.contains("`moments` of `body` can't be [0.0, 0.0, 0.0]"), "{told}");
    let dipole = pulse.replacen("m = 2", "m = 2\ndipole = { moment = { formula = \"t\" }, field = [0, 0, 1] }", 1);
    assert!(refused(&folder, &dipole).contains("top.toml:5:"));
    // A formula without a value later on ends the run there.
    let told = refused(&folder, &pair("pin", "torque = { formula = \"sqrt(1 - t)\" }"));
    assert!(told.contains("stopped at t = 1.2 s") && told.contains("value over time"), "{told}");
    let spring = "[[spring]]\nbodies = [\"a\", \"b\"]\nat = [[0, 0, 0], [0, 0, 1]]\nk = { formula = \"1 + 200 * t\" }\nlength = 0\n";
    let told = refused(&folder, &pair("ball", spring).replace("axes", "# axes"));
    assert!(told.contains("the fastest vibration"), "{told}");
}

/// A body among several along an orbit has the steps per orbit that it has alone, a formula beside, and the error at its end.
#[test]
fn steps_per_orbit_are_those_of_one_body() {
    let folder = folder("steps_per_orbit_are_those_of_one_body");
    let orbit = "orbit = { period = 60, normal = [0, 0, 1], eccentricity = 0.4, phase = \"40 deg\" }\n\
                 gravity_gradient.direction = \"nadir\"\n";
    let run = "[run]\nduration = \"1.5 orbits\"\nsteps_per_orbit = 300\nmethod = { composition = \"Suzuki 4\" }\n[output]\n\
               columns = [\"quaternion\", \"velocity\", \"energy\"]\n";
    let start = "start.quaternion = [0.8, 0.1, -0.5, 0.3]\nstart.velocity = [0.03, -0.02, 0.05]\n";
    let torque = "torque.torque = { formula = \"0.01 * [sin(t), 0, cos(t)]\" }\n";
    let one = format!(
        "title = \"One\"\n{start}{torque}body = {{ moments = [1, 2, 2.5], kinetic = \"geodesic\" }}\n{orbit}{}",
        run.replace("method = { composition = \"Suzuki 4\" }\n", "")
    );
    let dipole = "dipole = { moment = [0.03, 0, 0.01], field = { formula = \"[sin(t), 1, 0.1 * t]\" } }\n";
    let several = |effect: &str, run: &str| {
        format!(
            "title = \"Several\"\n{orbit}[[body]]\nname = \"a\"\nm = 3\nmoments = [1, 2, 2.5]\nposition = [0, 0, 0]\n\
             {start}{effect}{run}"
        )
    };
    let plain = run.replace("method = { composition = \"Suzuki 4\" }\n", "");
    let [alone, among] = [one, several(torque, &plain)].map(|text| rows(&folder, &text));
    println!("{:e}", apart(&alone, &among));
    assert!(alone.len() > 400 && apart(&alone, &among) < 1e-11, "{:e}", apart(&alone, &among));
    let told = printed(&folder, &["run", "scene.toml", "--out", "."]);
    assert!(told.contains("1.5 orbits of 60 s") && told.contains("the end is off by about"), "{told}");
    // A potential has steps back, and each stage its own time.
    let end = |steps: &str| {
        rows(&folder, &several(dipole, &run.replace("300", steps).replace("1.5 orbits", "1 orbit"))).last().unwrap()
            [1..8]
            .to_vec()
    };
    let exact = end("1600");
    let off = |steps: &str| end(steps).iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let [coarse, fine] = [off("100"), off("200")];
    println!("{coarse:e}, {fine:e}");
    assert!(((coarse / fine).log2() - 4.0).abs() < 0.3, "{coarse:e}, {fine:e}");
}

/// An angle that is a number alone in limits, an event or a histogram is said to be in rad, once.
#[test]
fn bare_angles_are_said_to_be_in_rad() {
    let folder = folder("bare_angles_are_said_to_be_in_rad");
    let hinge = |limits: &str, event: &str| {
        pair("pin", &format!("torque = 0.001\nlimits = {limits}"))
            + &format!("[[event]]\nname = \"far\"\ncolumn = \"hinge_angle\"\nvalue = {event}\n")
    };
    let told = |text: &str, command: &str| {
        fs::write(folder.join("scene.toml"), text).unwrap();
        let _ = fs::remove_dir_all(folder.join("out"));
        let output = called(&folder, &[command, "scene.toml", "--out", "out"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
    };
    let note = "angles by numbers alone are in rad, so this is 286 deg: write \"5 rad\", or \"5 deg\" if that is meant";
    for (limits, event, count) in [
        ("{ from = \"-1 rad\", to = 5.0 }", "5.0", 1),
        ("{ from = \"-1 rad\", to = \"5 rad\" }", "5.0", 1),
        ("{ from = 0, to = \"5 deg\" }", "\"5 deg\"", 0),
    ] {
        let told = told(&hinge(limits, event), "run");
        assert_eq!((told.matches(note).count(), told.matches("in rad").count()), (count, count), "{told}");
    }
    for (begin, end, count) in [("0", "5.0", 1), ("\"0 rad\"", "\"5 rad\"", 0)] {
        let ensemble = format!(
            "[ensemble]\nmembers = 2\ndraw.joint.hinge.damping = {{ from = 1, to = 2 }}\n\
             histogram.hinge_angle = {{ from = {begin}, to = {end}, count = 2 }}\n"
        );
        let text = pair("pin", "damping = 1").replace("columns = [", "columns = [\"angle\", ") + &ensemble;
        let told = told(&text, "ensemble");
        assert_eq!(told.matches(note).count(), count, "{told}");
    }
}

/// A mass that falls and grows, `d(m v)/dt = −m g` with `m = 1 + t/2`, and moments over time beside it, which are those of one body.
#[test]
fn masses_and_moments_change_with_time() {
    let folder = folder("masses_and_moments_change_with_time");
    let moments = "{ formula = \"[2 - 0.3 * t, 2.5 - 0.3 * t, 1.4 + 0.1 * sin(2 * t)]\" }";
    let body = format!("moments = {moments}\nkinetic = \"geodesic\"\nstart.velocity = [0.6, 2, 0.3]\n");
    let run = |step: f64| format!("[run]\nduration = 2\nstep = {step}\n[output]\nevery = 1\n");
    let several = |step: f64| {
        format!(
            "title = \"Several\"\n[gravity]\ng = 9.81\nup = [0, 0, 1]\n[[body]]\nname = \"a\"\nm = {{ formula = \"1 + t / 2\" }}\n\
             position = [0, 0, 0]\n{body}{}columns = [\"position\", \"velocity\"]\n",
            run(step)
        )
    };
    let one = |step: f64| {
        let start = "[start]\nvelocity = [0.6, 2, 0.3]\n";
        let body = format!("[body]\nmoments = {moments}\nkinetic = \"geodesic\"\n");
        format!("title = \"One\"\n{body}{start}{}columns = [\"velocity\"]\n", run(step))
    };
    // The integral of −g (t + t²/4)/(1 + t/2), by Simpson's rule.
    let speed = |t: f64| -9.81 * (t + t * t / 4.0) / (1.0 + t / 2.0);
    let parts = (0..200).map(|k| f64::from(k) * 0.01);
    let fallen: f64 = parts.map(|t| (speed(t) + 4.0 * speed(t + 0.005) + speed(t + 0.01)) / 600.0).sum();
    let off = |step: f64| {
        let [rows, alone] = [several(step), one(step)].map(|text| rows(&folder, &text));
        let last = rows.last().unwrap();
        let apart = (0..rows.len()).flat_map(|at| (0..3).map(move |k| (at, k)));
        let apart = apart.map(|(at, k)| (rows[at][4 + k] - alone[at][1 + k]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-11 && last[1] == 0.0, "{apart:e}");
        (last[3] - fallen).abs()
    };
    let [coarse, fine] = [0.04, 0.02].map(off);
    let order = (coarse / fine).log2();
    assert!(fine < 1e-3 && (order - 2.0).abs() < 0.05, "{coarse:e}, {fine:e}, of order {order}");
    // A sphere of radius 1 m, whose inertia 2/5 m grows with its mass: it turns by the momentum at the start.
    let sphere = several(0.02).replace(&format!("moments = {moments}"), "sphere.radius = 1");
    let sphere = rows(&folder, &sphere);
    let last = sphere.last().unwrap();
    assert!([0.6, 2.0, 0.3].iter().zip(&last[4..]).all(|(of, found)| (of / 2.0 - found).abs() < 1e-13), "{last:?}");
    for (formula, message) in [("t", "must be above zero"), ("[1, 1, 1]", "7:5: ")] {
        let found = refused(&folder, &several(0.04).replace("1 + t / 2", formula));
        assert!(found.contains(message), "{found}");
    }
}
