//! Models of MJCF and SDF as scenes: beside the same arm in URDF, shapes beside their closed forms, loops beside an equation of one
//! angle, and mistakes in files that are included.

use std::fs;

use liestep_scene::{Import, Run, Scene, import};
use nalgebra::Vector3;

use crate::called::folder;

fn imported(test: &str, text: &str) -> Result<Import, String> {
    let path = folder(test).join("model.xml");
    fs::write(&path, text).unwrap();
    import(&path, false).map_err(|mistake| mistake.to_string())
}

fn taken(test: &str, text: &str) -> Import {
    imported(test, text).unwrap_or_else(|mistake| panic!("{mistake}"))
}

fn run(text: &str) -> Run {
    let scene = Scene::parse("model.toml", text).unwrap_or_else(|mistake| panic!("{mistake}\n{text}"));
    scene.run().unwrap_or_else(|mistake| panic!("{mistake}\n{text}"))
}

/// The lines of a scene without remarks, and its numbers.
fn parts(text: &str) -> (Vec<String>, Vec<f64>) {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let words: Vec<&str> =
        lines.flat_map(|line| line.split([' ', ',', '[', ']', '{', '}'])).filter(|word| !word.is_empty()).collect();
    let (numbers, names): (Vec<_>, Vec<_>) = words.into_iter().partition(|word| word.parse::<f64>().is_ok());
    (names.into_iter().map(str::to_owned).collect(), numbers.iter().map(|number| number.parse().unwrap()).collect())
}

/// An arm of a pin, a slider with damping and limits, and a fixed tool, in three formats: one scene, to rounding.
#[test]
fn one_arm_in_three_formats() {
    let urdf = r#"<robot name="arm"><link name="base"/>
        <link name="boom"><inertial><origin xyz="0.4 0.1 0" rpy="0.3 0.2 0.1"/><mass value="2"/><inertia ixx="0.3" iyy="0.2" izz="0.15"/></inertial></link>
        <link name="rod"><inertial><origin xyz="0 0 0.2"/><mass value="0.7"/><inertia ixx="0.05" iyy="0.05" izz="0.01" ixy="0.002"/></inertial></link>
        <link name="tool"><inertial><mass value="0.1"/><inertia ixx="0.001" iyy="0.001" izz="0.001"/></inertial></link>
        <joint name="turn" type="continuous"><parent link="base"/><child link="boom"/><origin xyz="0 0 0.3" rpy="0 0 0.5"/><axis xyz="0 0.6 0.8"/><dynamics damping="0.2"/></joint>
        <joint name="push" type="prismatic"><parent link="boom"/><child link="rod"/><origin xyz="0.8 0 0.1" rpy="0.7 0 0"/><axis xyz="0 1 0"/><dynamics damping="2"/><limit lower="-0.1" upper="0.3"/></joint>
        <joint name="flange" type="fixed"><parent link="rod"/><child link="tool"/><origin xyz="0 0 0.5"/></joint></robot>"#;
    let mjcf = r#"<mujoco model="arm"><compiler angle="radian" eulerseq="XYZ"/><worldbody><body name="boom" pos="0 0 0.3" euler="0 0 0.5">
        <inertial pos="0.4 0.1 0" euler="0.3 0.2 0.1" mass="2" diaginertia="0.3 0.2 0.15"/>
        <joint name="turn" axis="0 0.6 0.8" damping="0.2"/>
        <frame pos="0.8 0 0"><body name="rod" pos="0 0 0.1" euler="0.7 0 0">
          <inertial pos="0 0 0.2" mass="0.7" fullinertia="0.05 0.05 0.01 0.002 0 0"/>
          <joint name="push" type="slide" axis="0 1 0" damping="2" range="-0.1 0.3"/>
          <body name="tool" pos="0 0 0.5"><inertial pos="0 0 0" mass="0.1" diaginertia="0.001 0.001 0.001"/></body>
        </body></frame>
        </body></worldbody></mujoco>"#;
    // The slider's frame is where its axis is z of its own; poses of links are those in the model, or in other links.
    let sdf = r#"<sdf version="1.9"><model name="arm"><link name="boom"><pose>0 0 0.3 0 0 0.5</pose>
        <inertial><pose>0.4 0.1 0 0.3 0.2 0.1</pose><mass>2</mass><inertia><ixx>0.3</ixx><iyy>0.2</iyy><izz>0.15</izz></inertia></inertial></link>
        <frame name="end" attached_to="boom"><pose>0.8 0 0.1 0 0 0</pose></frame>
        <link name="rod"><pose relative_to="end" degrees="true">0 0 0 40.10704565915762 0 0</pose>
        <inertial><pose>0 0 0.2 0 0 0</pose><mass>0.7</mass><inertia><ixx>0.05</ixx><iyy>0.05</iyy><izz>0.01</izz><ixy>0.002</ixy></inertia></inertial></link>
        <link name="tool"><pose relative_to="rod">0 0 0.5 0 0 0</pose><inertial><mass>0.1</mass><inertia><ixx>0.001</ixx><iyy>0.001</iyy><izz>0.001</izz></inertia></inertial></link>
        <joint name="turn" type="revolute"><parent>world</parent><child>boom</child><axis><xyz>0 0.6 0.8</xyz><dynamics><damping>0.2</damping></dynamics></axis></joint>
        <joint name="push" type="prismatic"><parent>end</parent><child>rod</child><pose>0 0 0 1.5707963267948966 0 0</pose>
          <axis><xyz>0 0 -1</xyz><dynamics><damping>2</damping></dynamics><limit><lower>-0.1</lower><upper>0.3</upper></limit></axis></joint>
        <joint name="flange" type="fixed"><parent>rod</parent><child>tool</child></joint></model></sdf>"#;
    let [urdf, mjcf, sdf] = [urdf, mjcf, sdf].map(|text| taken("three-formats", text));
    for (other, gravity) in [(&mjcf, 9.81), (&sdf, 9.8)] {
        assert_eq!(other.remarks, urdf.remarks);
        let text = other.text.replacen(&format!("g = {gravity}"), "g = 9.81", 1);
        let ((names, numbers), (expected, right)) = (parts(&text), parts(&urdf.text));
        assert_eq!(names, expected, "{}\n{}", other.text, urdf.text);
        assert_eq!(numbers.len(), right.len());
        for (found, right) in numbers.iter().zip(right) {
            assert!((found - right).abs() < 1e-14, "{found} {right}\n{}\n{}", other.text, urdf.text);
        }
    }
}

/// Masses of shapes by their densities, with defaults of classes, and ends in the place of lengths.
#[test]
fn shapes_have_masses() {
    let body = |shape: &str| {
        let text = format!(
            r#"<mujoco><default><geom density="500"/><default class="heavy"><geom density="2000" type="box"/>
            <joint damping="3"/></default></default><worldbody><body name="a" childclass="heavy"><joint axis="1 0 0"/>{shape}</body></worldbody></mujoco>"#
        );
        let Import { text, .. } = taken("shapes", &text);
        assert!(text.contains("damping = 3.0"), "{text}");
        let list = |key: &str| -> Vec<f64> {
            let line = text.lines().find(|line| line.starts_with(key)).unwrap_or_else(|| panic!("{key}\n{text}"));
            line.split(['=', ',', '[', ']']).filter_map(|word| word.trim().parse().ok()).collect()
        };
        (list("m = ")[0], list("moments = "), list("at = ")[3..].to_vec())
    };
    let near = |(m, J, at): (f64, Vec<f64>, Vec<f64>), (mass, moments, centre): (f64, [f64; 3], [f64; 3])| {
        assert!((m - mass).abs() < 1e-12 * mass, "{m} {mass}");
        for (found, right) in J.iter().zip(moments) {
            assert!((found - right).abs() < 1e-12 * moments[0], "{J:?} {moments:?}");
        }
        for (found, right) in at.iter().zip(centre) {
            assert!((found + right).abs() < 1e-14, "{at:?} {centre:?}");
        }
    };
    let pi = std::f64::consts::PI;
    // A box by its half edges, of the class.
    let m = 2000.0 * 8.0 * 0.1 * 0.2 * 0.3;
    let moments = [0.13, 0.10, 0.05].map(|squares: f64| m / 3.0 * squares);
    near(body(r#"<geom size="0.1 0.2 0.3" pos="1 0 0"/>"#), (m, moments, [1.0, 0.0, 0.0]));
    // A cylinder along x by its ends, with a mass of its own.
    let (along, across) = (3.0 * 0.01 / 2.0, 3.0 * (0.01 / 4.0 + 0.25 / 12.0));
    near(
        body(r#"<geom type="cylinder" size="0.1" fromto="0 0 1 0.5 0 1" mass="3"/>"#),
        (3.0, [along, across, across], [0.25, 0.0, 1.0]),
    );
    // A capsule: a cylinder of .4 m and two halves of a ball of .1 m.
    let [rod, ball] = [pi * 0.01 * 0.4, 4.0 / 3.0 * pi * 0.001].map(|volume| 2000.0 * volume);
    let along = rod * 0.01 / 2.0 + ball * 0.4 * 0.01;
    let across = rod * (0.01 / 4.0 + 0.16 / 12.0) + ball * (0.4 * 0.01 + 0.04 + 0.375 * 0.4 * 0.1);
    near(body(r#"<geom type="capsule" size="0.1 0.2"/>"#), (rod + ball, [across, across, along], [0.0; 3]));
    // An ellipsoid of another class, where shapes of no mass don't count, nor shapes that are seen only.
    let m = 500.0 * 4.0 / 3.0 * pi * 0.1 * 0.2 * 0.3;
    let moments = [0.13, 0.10, 0.05].map(|squares: f64| m / 5.0 * squares);
    let shapes = r#"<geom class="main" type="ellipsoid" size="0.1 0.2 0.3"/><geom size="1 1 1" mass="0"/><geom type="plane" size="1 1 1"/>"#;
    near(body(shapes), (m, moments, [0.0; 3]));
}

/// Degrees, angles that begin at `ref`, springs, and sequences of joints that are one.
#[test]
fn joints_of_mjcf() {
    let of = |joints: &str| {
        let inertial = r#"<inertial pos="0 0 -0.5" mass="1" diaginertia="0.1 0.1 0.1"/>"#;
        let text =
            format!(r#"<mujoco><worldbody><body name="a" pos="0 0 2">{inertial}{joints}</body></worldbody></mujoco>"#);
        taken("joints", &text)
    };
    let pin = of(r#"<joint name="p" pos="0 0 0.1" axis="0 3 0" ref="10" range="-20 100" stiffness="2" springref="40" frictionloss="0.5"/>"#).text;
    for line in [
        "kind = \"pin\"",
        "at = [[0, 0, 2.1], [0, 0, 0.6]]",
        "axes = [[0, 1.0, 0], [0, 1.0, 0]]",
        "friction = { torque = 0.5, below = 0.01 }",
        "stiffness = 2.0\nrest = 0.523598775598299\n",
        "limits = { from = -0.523598775598299, to = 1.5707963267949 }",
    ] {
        assert!(pin.contains(line), "{line}\n{pin}");
    }
    let hinge = |axis: &str| format!(r#"<joint axis="{axis}"/>"#);
    let slide = |axis: &str| format!(r#"<joint type="slide" axis="{axis}"/>"#);
    let [x, y, z] = ["1 0 0", "0 1 0", "0 0 1"];
    for (joints, kind) in [
        ([slide(x), slide(z), hinge(y)].concat(), "plane"),
        ([hinge(x), slide(x)].concat(), "cylinder"),
        ([hinge(z), hinge(x)].concat(), "universal"),
        ([hinge(z), hinge(x), hinge(y)].concat(), "ball"),
        ("<joint type=\"ball\"/>".to_owned(), "ball"),
    ] {
        let Import { text, remarks } = of(&joints);
        assert!(text.contains(&format!("kind = \"{kind}\"")), "{kind}\n{text}");
        assert_eq!(text.matches("[[joint]]").count(), 1, "{text}");
        assert!(remarks.is_empty(), "{remarks:?}");
        run(&text);
    }
    for joints in [[slide(x), slide(y), slide(z), hinge(x), hinge(y), hinge(z)].concat(), "<freejoint/>".to_owned()] {
        let Import { text, .. } = of(&joints);
        assert!(!text.contains("[[joint]]") && text.contains("position = [0, 0, 1.5]"), "{text}");
    }
    // Two rails have no joint of a scene: a body of little mass is between.
    let Import { text, remarks } = of(&[slide(x), slide(y)].concat());
    assert_eq!(text.matches("kind = \"slider\"").count(), 2, "{text}");
    assert_eq!(remarks[0], "link a-link-1: without a mass between joints, given 0.001 kg");
    let Import { remarks, .. } =
        of(r#"<joint axis="1 0 0" damping="1"/><joint axis="0 1 0" damping="2" armature="0.1"/>"#);
    assert_eq!(remarks, ["body a: its 2 joints are one, without their springs, friction, rotors and limits"]);
    for (joint, lines) in [
        (slide(x).replace("/>", r#" frictionloss="3" armature="0.2"/>"#), ["force = 3.0", "armature = 0.2"]),
        (hinge(y).replace("/>", r#" frictionloss="3" armature="0.2"/>"#), ["torque = 3.0", "armature = 0.2"]),
    ] {
        let Import { text, remarks } = of(&joint);
        assert!(remarks.is_empty() && lines.iter().all(|line| text.contains(line)), "{text}");
        run(&text);
    }
}

/// The angle of a parallelogram of three rods after a second, by the Runge–Kutta method of order four: cranks of 1 m with their
/// moments about their centres, and a bar that only shifts.
fn parallelogram(angle: f64) -> f64 {
    let (crank, moment, bar, g) = (0.5, 0.05, 2.0, 9.81);
    let inertia = 2.0 * (moment + crank * 0.25) + bar;
    let pull = g * (2.0 * crank * 0.5 + bar);
    let rate = |[p, u]: [f64; 2]| [u, -pull / inertia * p.sin()];
    let (mut y, h) = ([angle, 0.0], 1e-4);
    for _ in 0..10_000 {
        let moved = |slope: [f64; 2], part: f64| [y[0] + part * h * slope[0], y[1] + part * h * slope[1]];
        let k1 = rate(y);
        let k2 = rate(moved(k1, 0.5));
        let k3 = rate(moved(k2, 0.5));
        let k4 = rate(moved(k3, 1.0));
        y = core::array::from_fn(|k| y[k] + h / 6.0 * (k1[k] + 2.0 * (k2[k] + k3[k]) + k4[k]));
    }
    y[0]
}

/// A loop of four pins in SDF, whose joints are listed in any order and in part from the child, and one of MJCF that is closed by
/// `connect`: the motion of one angle.
#[test]
fn loops() {
    let (s, c) = 0.4_f64.sin_cos();
    let inertial = |m: f64| {
        format!("<inertial><mass>{m}</mass><inertia><ixx>0.05</ixx><iyy>0.05</iyy><izz>0.05</izz></inertia></inertial>")
    };
    // All frames are at the rods' centres; the first angle is 0.4 rad, by which the cranks' frames aren't turned.
    let link = |name: &str, m: f64, [x, z]: [f64; 2]| {
        format!("<link name=\"{name}\"><pose>{x} 0 {z} 0 0 0</pose>{}</link>", inertial(m))
    };
    let pin = |name: &str, [parent, child]: [&str; 2], [x, z]: [f64; 2]| {
        format!(
            "<joint name=\"{name}\" type=\"revolute\"><parent>{parent}</parent><child>{child}</child><pose>{x} 0 {z} 0 0 0</pose><axis><xyz>0 1 0</xyz></axis></joint>"
        )
    };
    let [x, z] = [-s / 2.0, -c / 2.0];
    let sdf = [
        "<sdf version=\"1.9\"><world name=\"w\"><gravity>0 0 -9.81</gravity><model name=\"four\">".to_owned(),
        pin("a", ["bar", "left"], [x, z]),
        link("left", 0.5, [x, z]),
        link("bar", 2.0, [0.5 - s, -c]),
        link("right", 0.5, [1.0 + x, z]),
        pin("b", ["world", "left"], [-x, -z]),
        pin("c", ["bar", "right"], [x, z]),
        pin("d", ["world", "right"], [-x, -z]),
        "</model></world></sdf>".to_owned(),
    ]
    .concat();
    let mjcf = format!(
        r#"<mujoco><worldbody><body name="left" pos="{x} 0 {z}"><inertial pos="0 0 0" mass="0.5" diaginertia="0.05 0.05 0.05"/><joint pos="{} 0 {}" axis="0 1 0"/>
          <body name="bar" pos="{} 0 {z}"><inertial pos="0 0 0" mass="2" diaginertia="0.05 0.05 0.05"/><joint pos="-0.5 0 0" axis="0 1 0"/></body></body>
        <body name="right" pos="{} 0 {z}"><inertial pos="0 0 0" mass="0.5" diaginertia="0.05 0.05 0.05"/><joint pos="{} 0 {}" axis="0 1 0"/></body></worldbody>
        <equality><connect body1="bar" body2="right" anchor="0.5 0 0"/></equality></mujoco>"#,
        -x,
        -z,
        0.5 + x,
        1.0 + x,
        -x,
        -z
    );
    let angle = parallelogram(0.4);
    let expected = [
        ("left", Vector3::new(-angle.sin(), 0.0, -angle.cos()) * 0.5),
        ("bar", Vector3::new(0.5 - angle.sin(), 0.0, -angle.cos())),
        ("right", Vector3::new(1.0 - angle.sin() / 2.0, 0.0, -angle.cos() / 2.0)),
    ];
    for text in [sdf, mjcf] {
        let Import { text, remarks } = taken("loops", &text);
        assert!(remarks.is_empty(), "{remarks:?}");
        let off = ["\"2 ms\"", "\"1 ms\""].map(|step| {
            let run = run(&text.replace("\"1 ms\"", step));
            let end = &run.samples().last().unwrap().bodies;
            let names: Vec<&str> =
                text.lines().filter_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"')).take(3).collect();
            let of = |(name, place): &(&str, Vector3<f64>)| {
                let number = names.iter().position(|own| own == name).unwrap();
                (end[number].position - place).norm()
            };
            expected.iter().map(of).fold(0.0, f64::max)
        });
        println!("{off:?}");
        assert!((off[0] / off[1] - 4.0).abs() < 0.1 && off[1] < 1e-5, "{off:?}\n{text}");
    }
}

/// Links of SDF without a way to the world are free, static models stay, and older versions have their axes in the model.
#[test]
fn frames_of_sdf() {
    let inertial = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>";
    let model = |version: &str, inner: &str| {
        let text = format!(
            "<sdf version=\"{version}\"><model name=\"m\"><pose>0 0 1 0 0 0</pose>{inner}<link name=\"a\"><pose>1 0 0 0 0 1.5707963267948966</pose>{inertial}</link>\
             <link name=\"b\"><pose>2 0 0 0 0 1.5707963267948966</pose>{inertial}</link>\
             <joint name=\"j\" type=\"revolute\"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis></joint></model></sdf>"
        );
        imported("frames-of-sdf", &text)
    };
    let new = model("1.6", "").unwrap();
    assert!(new.text.contains("axes = [[1.0, 0, 0], [1.0, 0, 0]]"), "{}", new.text);
    assert!(new.text.contains("position = [1.0, 0, 1.0]") && new.text.matches("[[body]]").count() == 2, "{}", new.text);
    // The first axis of the model is minus the second one of the links.
    let old = model("1.4", "").unwrap();
    assert!(old.text.contains("axes = [[0, -1.0, 0], [0, -1.0, 0]]"), "{}", old.text);
    let fixed = model("1.6", "<static>true</static>").unwrap();
    assert_eq!(fixed.text.matches("[[body]]").count(), 1, "{}", fixed.text);
    let nested = format!(
        "<model name=\"n\"><pose>0 0 3 0 0 0</pose><link name=\"c\">{inertial}</link></model><joint name=\"k\" type=\"ball\"><parent>b</parent><child>n::c</child></joint>"
    );
    let nested = model("1.8", &nested).unwrap();
    assert!(nested.text.contains("bodies = [\"b\", \"n--c\"]\nat = [[0, 2.0, 3.0], [0, 0, 0]]"), "{}", nested.text);
    // A joint whose child is nearer to the world turns the other way about the opposite axis.
    let turned = format!(
        "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"><pose>1 0 0 0 0 1.5707963267948966</pose>{inertial}</link><link name=\"b\">{inertial}</link>\
         <joint name=\"i\" type=\"fixed\"><parent>world</parent><child>a</child></joint>\
         <joint name=\"j\" type=\"revolute\"><parent>b</parent><child>a</child><axis><xyz>1 0 0</xyz><limit><lower>0</lower><upper>1</upper></limit></axis></joint></model></sdf>"
    );
    let turned = taken("frames-of-sdf", &turned).text;
    assert!(
        turned.contains(
            "bodies = [\"space\", \"b\"]\nat = [[1.0, 0, 0], [1.0, 0, 0]]\naxes = [[0, -1.0, 0], [0, -1.0, 0]]"
        ),
        "{turned}"
    );
    let circle = "<frame name=\"f\"><pose relative_to=\"g\"/></frame><frame name=\"g\"><pose relative_to=\"f\"/></frame><link name=\"c\"><pose relative_to=\"f\"/></link>";
    let refused = model("1.8", circle).unwrap_err();
    assert!(refused.contains("the frames below `c` lead in a circle"), "{refused}");
    let refused =
        model("1.8", "<joint name=\"k\" type=\"screw\"><parent>a</parent><child>b</child></joint>").unwrap_err();
    assert!(refused.contains("the joint `k` has the type `screw`, expected one of"), "{refused}");
    let refused =
        model("1.8", "<joint name=\"k\" type=\"ball\"><parent>a</parent><child>q</child></joint>").unwrap_err();
    assert!(refused.contains("`q` is no link, and no frame of one"), "{refused}");
}

/// Mistakes have their places, in the file that has them.
#[test]
fn wrong_models() {
    let folder = folder("included");
    let main = "<mujoco>\n<include file=\"parts/defaults.xml\"/>\n<worldbody><body><joint class=\"a\"/>\n<geom size=\"0.1\"/></body>\n<body><geom size=\"-1\"/></body></worldbody>\n</mujoco>\n";
    fs::create_dir_all(folder.join("parts")).unwrap();
    fs::write(folder.join("model.xml"), main).unwrap();
    let refused = |defaults: &str| {
        fs::write(folder.join("parts/defaults.xml"), defaults).unwrap();
        import(folder.join("model.xml"), false)
            .map_or_else(|mistake| mistake.to_string(), |import| panic!("{}", import.text))
    };
    for (defaults, place, message) in [
        (
            "<mujoco>\n<default>\n  <default class=\"a\"/></default></mujoco>",
            "model.xml:5:7",
            "a sphere has a `size` of 1 numbers above zero",
        ),
        (
            "<mujoco>\n<default>\n  <default/></default></mujoco>",
            "defaults.xml:3:3",
            "a `default` inside of another has a `class`",
        ),
        (
            "<mujoco>\n<default/>\n<compiler angle=\"turns\"/></mujoco>",
            "defaults.xml:3:1",
            "`angle` is `turns`, expected `degree` or `radian`",
        ),
        ("<mujoco>\n<default/></mujoco>", "model.xml:3:18", "there is no class `a` of defaults"),
        ("<mujoco><include file=\"model.xml\"/></mujoco>", "defaults.xml:1:9", "`model.xml` is included a second time"),
        ("<mujoco>\n", "defaults.xml", "isn't XML"),
    ] {
        let refused = refused(defaults);
        assert!(refused.contains(place) && refused.contains(message), "{refused}");
    }
    let of =
        |text: &str| imported("wrong-model", text).map_or_else(|mistake| mistake, |import| panic!("{}", import.text));
    assert!(of("<scene/>").contains("a model is an element `robot` of URDF, `sdf` or `mujoco`, and this is `scene`"));
    assert!(of("<sdf version=\"one\"/>").contains("the `version` of a file of SDF is like `1.9`"));
    assert!(of("<mujoco/>").contains("the model has no body with a mass that moves"));
    assert!(of("<mujoco><compiler coordinate=\"global\"/></mujoco>").contains("expected `local`"));
    let joint =
        "<mujoco><worldbody><body name=\"b\"><joint type=\"screw\"/><geom size=\"1\"/></body></worldbody></mujoco>";
    assert!(of(joint).contains("the joint `b` has the type `screw`, expected one of `hinge`, `slide`, `ball`, `free`"));
    let floating = import(folder.join("model.xml"), true);
    assert!(floating.is_err());
}
