//! Models of URDF as scenes: their motion against equations of few angles, frames that don't matter, and what is said about
//! elements without a counterpart.

use std::fs;

use liestep_scene::{Import, Run, Scene, import};
use nalgebra::{Matrix3, Vector3};

use crate::called::{folder, printed, refuses, table};

fn imported(test: &str, text: &str, floats: bool) -> Import {
    let path = folder(test).join("robot.urdf");
    fs::write(&path, text).unwrap();
    import(&path, floats).unwrap_or_else(|mistake| panic!("{mistake}"))
}

fn run(text: &str) -> Run {
    let scene = Scene::parse("robot.toml", text).unwrap_or_else(|mistake| panic!("{mistake}\n{text}"));
    scene.run().unwrap_or_else(|mistake| panic!("{mistake}"))
}

fn ends(run: &Run) -> Vec<Vector3<f64>> {
    run.samples().last().unwrap().bodies.iter().map(|body| body.position).collect()
}

fn link(name: &str, mass: f64, origin: &str, inertia: [f64; 6]) -> String {
    let [xx, xy, xz, yy, yz, zz] = inertia;
    format!(
        "<link name=\"{name}\"><inertial>{origin}<mass value=\"{mass}\"/><inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" \
         iyy=\"{yy}\" iyz=\"{yz}\" izz=\"{zz}\"/></inertial></link>\n"
    )
}

fn joint(name: &str, kind: &str, [parent, child]: [&str; 2], inner: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{inner}</joint>\n"
    )
}

fn robot(parts: &[String]) -> String {
    format!("<?xml version=\"1.0\"?>\n<robot name=\"arm\">\n{}</robot>\n", parts.concat())
}

/// Angles and rates of a double pendulum with friction in its joints after a second, by the Runge–Kutta method of order four:
/// rods of 1 m, of these masses, moments about their centres and coefficients.
fn double_pendulum(masses: [f64; 2], moments: [f64; 2], friction: [f64; 2], start: [f64; 2]) -> [f64; 2] {
    let ([m1, m2], [i1, i2], [c1, c2]) = (masses, moments, friction);
    let (l, length, g) = (0.5, 1.0, 9.81);
    let rate = |y: [f64; 4]| {
        let [p, q, u, v] = y;
        let (s, c) = (p - q).sin_cos();
        let (a, b, d) = (i1 + m1 * l * l + m2 * length * length, m2 * length * l * c, i2 + m2 * l * l);
        let f = -m2 * length * l * s * v * v - (m1 * l + m2 * length) * g * p.sin() - c1 * u + c2 * (v - u);
        let k = m2 * length * l * s * u * u - m2 * g * l * q.sin() - c2 * (v - u);
        let determinant = a * d - b * b;
        [u, v, (d * f - b * k) / determinant, (a * k - b * f) / determinant]
    };
    let (mut y, h) = ([start[0], start[1], 0.0, 0.0], 1e-4);
    for _ in 0..10_000 {
        let moved = |y: [f64; 4], slope: [f64; 4], part: f64| core::array::from_fn(|k| y[k] + part * h * slope[k]);
        let k1 = rate(y);
        let k2 = rate(moved(y, k1, 0.5));
        let k3 = rate(moved(y, k2, 0.5));
        let k4 = rate(moved(y, k3, 1.0));
        y = core::array::from_fn(|k| y[k] + h / 6.0 * (k1[k] + 2.0 * (k2[k] + k3[k]) + k4[k]));
    }
    [y[0], y[1]]
}

/// A double pendulum with friction, whose frames are turned, whose lower rod is two fixed halves, and which ends in a frame for a
/// tool.
#[test]
fn a_double_pendulum() {
    let upper = link("upper", 2.0, "<origin xyz=\"0 0 -0.5\"/>", [0.24, 0.0, 0.0, 0.25, 0.0, 0.05]);
    // The lower frame is turned by 90 degrees about z, and by 180 degrees about x, against the upper one.
    let origin = "<origin xyz=\"0 0 -1\" rpy=\"3.141592653589793 0 1.5707963267948966\"/>";
    let half = |name: &str| {
        link(name, 0.5, "<origin xyz=\"0 0 0.25\" rpy=\"0.3 0.4 0.5\"/>", [0.02, 0.0, 0.0, 0.02, 0.0, 0.02])
    };
    let text = robot(&[
        "<link name=\"base\"/>\n".to_owned(),
        upper,
        half("near"),
        half("far"),
        "<link name=\"tool\"/>\n".to_owned(),
        joint(
            "shoulder",
            "revolute",
            ["base", "upper"],
            "<axis xyz=\"0 1 0\"/><dynamics damping=\"0.3\"/><limit lower=\"-1\" upper=\"1\"/>",
        ),
        // The lower joint's axis is y of the upper frame, x of the lower one.
        joint(
            "elbow",
            "continuous",
            ["upper", "near"],
            &format!("{origin}<axis xyz=\"2 0 0\"/><dynamics damping=\"0.1\" friction=\"0\"/>"),
        ),
        joint("halves", "fixed", ["near", "far"], "<origin xyz=\"0 0 0.5\"/>"),
        joint("flange", "fixed", ["far", "tool"], "<origin xyz=\"0 0 0.5\"/>"),
    ]);
    let Import { text: scene, remarks } = imported("double-pendulum", &text, false);
    assert_eq!(remarks, ["limits of joints: 1, watched as events and not imposed"]);
    assert!(
        scene.starts_with("# limits of joints: 1, watched as events and not imposed\ntitle = \"arm\"\n"),
        "{scene}"
    );
    assert!(
        scene.contains("name = \"shoulder\"\n") && scene.contains("limits = { from = -1.0, to = 1.0 }\n"),
        "{scene}"
    );
    // The first angle is 0.7 rad about y, the second 0.5 rad more.
    let [first, second] = [0.7, 1.2];
    let moved = scene.replacen("angle = 0\n", "angle = 0.7\n", 1).replacen("angle = 0\n", "angle = 0.5\n", 1);
    // Two halves of 0.5 kg at 0.25 m from the middle.
    let moments = [0.25, 2.0 * (0.02 + 0.5 * 0.0625)];
    let [p, q] = double_pendulum([2.0, 1.0], moments, [0.3, 0.1], [first, second]);
    let [elbow, end] = [p, q].map(|angle| -Vector3::new(angle.sin(), 0.0, angle.cos()));
    let expected = [elbow * 0.5, elbow + end * 0.5];
    let off = ["\"2 ms\"", "\"1 ms\""].map(|step| {
        let run = run(&moved.replace("\"1 ms\"", step));
        ends(&run).iter().zip(expected).map(|(found, expected)| (found - expected).norm()).fold(0.0, f64::max)
    });
    println!("{off:?}");
    assert!((off[0] / off[1] - 4.0).abs() < 0.05 && off[1] < 1e-5, "{off:?}");
}

/// The same arm in other frames: each link's frame turned and shifted by the joints' origins and back in the masses. Its bodies
/// move the same way.
#[test]
fn frames_dont_matter() {
    let arm = |turn: f64| {
        let (s, c) = f64::sin_cos(turn);
        // Frames turned about z; a diagonal inertia gets a product.
        let turned = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
        let J = turned * Matrix3::from_diagonal(&Vector3::new(0.3, 0.2, 0.15)) * turned.transpose();
        let inertia = [J[(0, 0)], J[(0, 1)], J[(0, 2)], J[(1, 1)], J[(1, 2)], J[(2, 2)]];
        let list = |v: Vector3<f64>| format!("{} {} {}", v.x, v.y, v.z);
        let seen = |x: f64, y: f64, z: f64| list(turned * Vector3::new(x, y, z));
        robot(&[
            link("base", 3.0, "", [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]),
            link("boom", 2.0, &format!("<origin xyz=\"{}\"/>", seen(0.4, 0.1, 0.0)), inertia),
            link("rod", 0.7, "<origin xyz=\"0 0 0.2\"/>", [0.05, 0.0, 0.0, 0.05, 0.0, 0.01]),
            joint(
                "turn",
                "continuous",
                ["base", "boom"],
                &format!(
                    "<origin xyz=\"0 0 0.3\" rpy=\"0 0 {turn}\"/><axis xyz=\"{}\"/><dynamics friction=\"0.02\"/>",
                    seen(0.0, 0.6, 0.8)
                ),
            ),
            joint(
                "push",
                "prismatic",
                ["boom", "rod"],
                &format!(
                    "<origin xyz=\"{}\" rpy=\"0 0 {}\"/><axis xyz=\"0 1 0\"/><dynamics damping=\"2\"/>",
                    seen(0.8, 0.0, 0.1),
                    -turn
                ),
            ),
        ])
    };
    let [one, other] = [0.0, 0.9].map(|turn| imported(&format!("frames-{turn}"), &arm(turn), true));
    assert_eq!(one.remarks, other.remarks);
    assert!(one.remarks.is_empty(), "{:?}", one.remarks);
    let ends = [one, other].map(|import| {
        ends(&run(&import.text.replacen("angle = 0\n", "rate = 1.5\n", 1).replacen("g = 9.81", "g = 0.1", 1)))
    });
    assert_eq!(ends[0].len(), 3);
    for (one, other) in ends[0].iter().zip(&ends[1]) {
        assert!((one - other).amax() < 1e-9, "{one} {other}");
    }
    assert!((ends[0][1] - Vector3::new(0.4, 0.1, 0.3)).norm() > 0.1);
}

/// Links without a mass, inertias that no body has, and elements without a counterpart are listed, and the scene runs.
#[test]
fn whatever_has_no_counterpart_is_listed() {
    let text = robot(&[
        "<link name=\"world\"/><transmission name=\"gears\"/><gazebo reference=\"thin\"/>\n".to_owned(),
        "<link name=\"thin\"><visual/><visual/><collision/><inertial><mass value=\"2\"/><inertia ixx=\"1\" iyy=\"0.2\" izz=\"0.3\"/></inertial></link>\n".to_owned(),
        "<link name=\"cross\"/>\n".to_owned(),
        link("tip", 1.0, "", [0.0; 6]),
        "<link name=\"camera\"/>\n".to_owned(),
        joint("first", "revolute", ["world", "thin"], "<safety_controller/><limit/>"),
        joint("second", "revolute", ["thin", "cross"], "<axis xyz=\"0 1 0\"/><mimic joint=\"first\"/>"),
        joint("third", "prismatic", ["cross", "tip"], "<dynamics friction=\"3\"/>"),
        joint("lens", "revolute", ["tip", "camera"], ""),
    ]);
    let Import { text, remarks } = imported("listed", &text, false);
    let expected = [
        "`transmission` gears: no counterpart",
        "`gazebo` thin: no counterpart",
        "link thin: `visual` is a shape, and shapes aren't read",
        "link thin: `collision` is a shape, and shapes aren't read",
        "joint first: `safety_controller`: no counterpart",
        "joint first: its limits leave it no way, left out",
        "joint second: it moves by itself, and doesn't follow first",
        "link camera and joint lens: without a mass at the end of an arm, left out",
        "link thin: no body has its inertia, as a principal moment is at most the sum of the others; the least one is raised",
        "link cross: without a mass between joints, given 0.001 kg",
        "link cross: its inertia isn't positive, given that of a ball of 1 cm, 4e-8 kg m²",
        "link tip: its inertia isn't positive, given that of a ball of 1 cm, 4e-5 kg m²",
    ];
    assert_eq!(remarks, expected);
    assert!(text.contains("friction = { force = 3.0, below = 0.01 }"), "{text}");
    let run = run(&text.replace("duration = 1\n", "duration = 0.05\n"));
    assert!(run.samples().iter().all(|sample| sample.energy.is_finite()));
}

/// The guide's arm: its model is imported, its joints get the drives of the listings, and it comes to rest where they carry its
/// weight; the run has a page.
#[test]
fn the_arm_of_the_guide() {
    let guide = include_str!("../../../src/guide/bodies.md").split("# A robot arm\n").nth(1).unwrap();
    let listings = |kind: &str| -> Vec<&str> {
        let fence = format!("```{kind}\n");
        guide.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
    };
    let folder = folder("arm");
    fs::write(folder.join("arm.urdf"), listings("xml")[0]).unwrap();
    printed(&folder, &["import", "arm.urdf", "--out", "."]);
    let mut scene = fs::read_to_string(folder.join("arm.toml")).unwrap();
    let [turn, shoulder, elbow, end] = listings("toml")[..] else { panic!("four listings") };
    for keys in [turn, shoulder, elbow] {
        let (name, keys) = keys.strip_prefix("# ").unwrap().split_once('\n').unwrap();
        let head = format!("[[joint]]\nname = \"{name}\"\n");
        assert!(scene.contains(&head), "{scene}");
        scene = scene.replace(&head, &format!("{head}{keys}"));
    }
    let scene = scene.split("[run]").next().unwrap().to_owned() + end;
    fs::write(folder.join("arm.toml"), scene).unwrap();
    printed(&folder, &["run", "arm.toml", "--html", "--csv", "--out", "."]);
    let page = fs::read_to_string(folder.join("arm.html")).unwrap();
    assert!(page.contains("title: \"Angles of joints\"") && page.contains("{name: \"shoulder_angle\""));
    let rows = table(&fs::read_to_string(folder.join("arm.csv")).unwrap());
    let last = rows.last().unwrap();
    let [turned, leant, bent] = [1, 2, 3].map(|at| last[at]);
    // At rest the torque of each drive is that of the weight that it carries: k (φ − rest) = Σ m g x, by the arms x of all bodies
    // beyond the joint.
    let (upper, fore) = (0.2 * leant.sin(), 0.4 * leant.sin() + 0.15 * (leant + bent).sin());
    let weight = [9.81 * (2.5 * upper + 1.2 * fore), 9.81 * 1.2 * (fore - 0.4 * leant.sin())];
    let of_drives = [(leant - 50.0_f64.to_radians()) * 300.0, (bent - 70.0_f64.to_radians()) * 80.0];
    println!("{turned} {leant} {bent}, {weight:?} {of_drives:?}");
    assert!((turned - std::f64::consts::FRAC_PI_2).abs() < 1e-3, "{turned}");
    for (weight, drive) in weight.iter().zip(of_drives) {
        assert!((weight - drive).abs() < 1e-3 * weight, "{weight} {drive}");
    }
    // The lowest joint carries all.
    assert!((last[6] - 9.81 * 9.7).abs() < 1e-3, "{last:?}");
}

/// A link with a mass and no inertia has that of its shape, in the shape's axes.
#[test]
fn an_inertia_by_a_shape() {
    let link = |shape: &str| {
        let text = robot(&[
            "<link name=\"base\"/>\n".to_owned(),
            format!(
                "<link name=\"rod\"><visual><geometry><mesh filename=\"a\"/></geometry></visual><collision><origin rpy=\"0 1.5707963267948966 0\"/><geometry>{shape}</geometry></collision><inertial><mass value=\"3\"/><inertia/></inertial></link>\n"
            ),
            joint("pin", "continuous", ["base", "rod"], ""),
        ]);
        imported("by-a-shape", &text, false)
    };
    let Import { text, remarks } = link("<cylinder radius=\"0.1\" length=\"0.6\"/>");
    let remark = "link rod: its inertia is zero, given that of its `collision` of one material";
    assert_eq!(remarks, ["link rod: `visual` is a shape, and shapes aren't read", remark]);
    // The axis of the cylinder is x of the link.
    let line = text.lines().find(|line| line.starts_with("moments")).unwrap();
    let numbers: Vec<f64> = line.split(['[', ',', ']']).filter_map(|number| number.trim().parse().ok()).collect();
    let across = 3.0 * (0.01 / 4.0 + 0.36 / 12.0);
    for (found, expected) in numbers.iter().zip([0.015, across, across]) {
        assert!((found - expected).abs() < 1e-15, "{line}");
    }
    let of_mesh = link("<mesh filename=\"b\"/>");
    assert!(of_mesh.remarks.iter().any(|one| one.contains("its inertia isn't positive")), "{:?}", of_mesh.remarks);
}

/// Mistakes have places in the model.
#[test]
fn wrong_models() {
    let folder = folder("wrong-models");
    let refused = |text: &str, message: &str| {
        fs::write(folder.join("robot.urdf"), text).unwrap();
        refuses(&folder, &["import", "robot.urdf"], 1, message);
    };
    refused("<robot", "robot.urdf:1:1: isn't XML");
    refused("<sdf/>", "robot.urdf:1:1: the model has no body with a mass that moves");
    refused("<robot name=\"a\"/>", "robot.urdf:1:1: a model has one link without a parent");
    let link = "<link name=\"a\"/>\n";
    let of = |inner: &str| format!("<robot name=\"a\">\n{inner}</robot>");
    refused(&of(link), "robot.urdf:2:1: the model has no body with a mass that moves");
    refused(&of(&link.repeat(2)), "robot.urdf:3:1: there are two links called `a`");
    refused(&of("<link/>"), "robot.urdf:2:1: `link` has no `name`");
    refused(&of("<link name=\"a\"><inertial/></link>"), "`inertial` has no `mass` with a `value`");
    refused(&of("<link name=\"a\"><inertial><mass value=\"1 kg\"/></inertial></link>"), "`1 kg` isn't a finite number");
    refused(&of("<link name=\"a\"><inertial><mass value=\"-1\"/></inertial></link>"), "the mass -1 is negative");
    refused(&of(&joint("j", "revolute", ["a", "b"], "")), "robot.urdf:2:1: the joint `j` is at `a`, which is no link");
    refused(&of(&joint("j", "screw", ["a", "b"], "")), "the joint `j` has the type `screw`, expected one of");
    refused(&of("<joint name=\"j\"/>"), "the joint `j` has no `parent` with a `link`");
    refused(&of(&joint("j", "revolute", ["a", "b"], "<axis xyz=\"0 0 0\"/>")), "an axis can't be zero");
    refused(&of(&joint("j", "revolute", ["a", "b"], "<origin xyz=\"0 0\"/>")), "`xyz` has three numbers, found 2");
    let two = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>\n";
    let circle = joint("j", "fixed", ["b", "c"], "") + &joint("k", "fixed", ["c", "b"], "");
    refused(&of(&format!("{two}{circle}")), "joints lead in a circle");
    let both = joint("j", "fixed", ["a", "c"], "") + &joint("k", "fixed", ["b", "c"], "");
    refused(&of(&format!("{two}{both}")), "the link `c` has a parent already");
}
