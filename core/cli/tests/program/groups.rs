//! Scenes on any group: orders, momenta and defects, and starts.

use std::fmt::Write as _;
use std::fs;

use liestep::groups::{Heisenberg, LieGroup, SE2, SE3, SL2, SO2, SO3, SU2};
use liestep::numbers::{Coordinates, Entries};
use liestep_scene::Sample;
use nalgebra::{DMatrix, DVector};

use crate::called::{folder, printed};
use crate::reference::{
    Generators, Reference, affine, apart, assert_orders, blocks, drifts, in_space, last, metric, moving, of_traces,
    one, orthogonal, poses, product, second, special_linear, symplectic, turns, velocity, written,
};

const RIGID: &str = "((F - I) * J * (F - I).transpose()).trace() / (2 * h)";
/// Half of it is that of `I − F⁻¹` where the group isn't rigid, or the order is one.
const ANY: &str = "(((F - I) * J * (F - I).transpose()).trace()
    + ((I - inverse(F)) * J * (I - inverse(F)).transpose()).trace()) / (4 * h)";

/// Free motion on groups by generators: orders, momentum in space, defect. SE(3) × SO(3) is one of them, by blocks.
#[test]
fn groups_of_the_files_own() {
    let groups: [(&str, Generators, &str); 7] = [
        ("SL(3)", special_linear(), ANY),
        ("Sp(4)", symplectic(), ANY),
        ("SO(4)", orthogonal(4), RIGID),
        ("SE_2(3)", poses(5), RIGID),
        ("affine maps of the plane", affine(2), ANY),
        ("affine maps of space", affine(3), ANY),
        ("SE(3) x SO(3)", product(&[poses(4), turns()]), RIGID),
    ];
    for (name, generators, l_d) in groups {
        let (n, J) = (generators[0].nrows(), metric(generators[0].nrows()));
        let list: Vec<_> = generators.iter().map(written).collect();
        let xi = moving(generators.len());
        let text = format!(
            "[lagrangian]\ngroup = \"Own\"\ngenerators = [{}]\nl_d = \"\"\"\n{l_d}\"\"\"\nJ = {}\n[start]\nvelocity = {xi:?}\n",
            list.join(", "),
            written(&J)
        );
        let reference = Reference::free(&generators, of_traces(&generators, &J));
        let (_, exact) = reference.end(DMatrix::identity(n, n), &xi, 1.0, 400);
        assert_orders(name, &text, &exact);
        for method in ["", "Suzuki 4"] {
            let [momentum, defect] = drifts(&second(&text, method, 100), generators.len());
            assert!(momentum < 1e-14 && defect < 1e-13, "{name} {method}: {momentum:e} {defect:e}");
        }
    }
}

fn library<G: LieGroup<Scalar = f64>>() -> Generators {
    let generator = |k| {
        let mut entries = Vec::new();
        G::hat(&G::Vector::axis(k)).each(&mut |entry| entries.push(entry));
        let n = (1..=entries.len()).find(|n| n * n == entries.len()).unwrap();
        DMatrix::from_row_slice(n, n, &entries)
    };
    (0..G::DIMENSION).map(generator).collect()
}

/// Geodesics of a dense left-invariant metric on the groups of the library, against their structure constants.
#[test]
fn geodesics_on_the_librarys_groups() {
    let groups: [(&str, Generators); 7] = [
        ("SO2", library::<SO2<f64>>()),
        ("SO3", library::<SO3<f64>>()),
        ("SE2", library::<SE2<f64>>()),
        ("SE3", library::<SE3<f64>>()),
        ("SU2", library::<SU2<f64>>()),
        ("SL2", library::<SL2<f64>>()),
        ("Heisenberg", library::<Heisenberg<f64>>()),
    ];
    for (name, generators) in groups {
        let (n, K) = (generators[0].nrows(), metric(generators.len()));
        let xi: Vec<f64> = moving(generators.len()).iter().map(|part| 3.0 * part).collect();
        let (kinetic, value) = if n == 2 && generators.len() == 1 {
            ("k * xi.norm_squared() / 2", "k = 1".to_owned())
        } else {
            ("xi.dot(K * xi) / 2", format!("K = {}", written(&K)))
        };
        let euler = if name == "SO3" { "euler = [0, 0, 0]\n" } else { "" };
        let text = format!(
            "[lagrangian]\ngroup = \"{name}\"\nvelocity = \"xi\"\ndiscretise = \"trapezoid(Cayley)\"\nl = \"{kinetic}\"\n\
             {value}\n[start]\n{euler}velocity = {xi:?}\n"
        );
        let [momentum, defect] = drifts(&second(&text, "", 100), generators.len());
        assert!(momentum < 1e-14 && defect < 1e-13, "{name}: {momentum:e} {defect:e}");
        if generators.len() > 1 {
            let reference = Reference::free(&generators, K);
            assert_orders(name, &text, &reference.end(DMatrix::identity(n, n), &xi, 1.0, 400).1);
        }
    }
}

/// Geodesics of a metric that couples the factors of a product, some of them of the file's own, against the structure constants of both.
#[test]
fn geodesics_on_products() {
    let groups: [(&str, Generators, &str, Generators); 6] = [
        ("Map", affine(2), "SO3", library::<SO3<f64>>()),
        ("SE3", library::<SE3<f64>>(), "SO4", orthogonal(4)),
        ("SE2", library::<SE2<f64>>(), "SL2", library::<SL2<f64>>()),
        ("SU2", library::<SU2<f64>>(), "Heisenberg", library::<Heisenberg<f64>>()),
        ("SE3", library::<SE3<f64>>(), "SO3", library::<SO3<f64>>()),
        ("SO3", library::<SO3<f64>>(), "SE2", library::<SE2<f64>>()),
    ];
    let attitude = |name: &str| if name == "SO3" { "euler = [0, 0, 0], " } else { "" };
    for (first, A, second_name, B) in groups {
        let ([m, n], [K, M]) = ([A.len(), B.len()], [metric(A.len()), metric(B.len())]);
        let mut whole = blocks(&[&K, &M]);
        (whole[(0, m + 1)], whole[(m + 1, 0)]) = (0.3, 0.3);
        let xi: Vec<f64> = moving(m + n).iter().map(|part| 3.0 * part).collect();
        let own = [(first, &A), (second_name, &B)].into_iter().find(|(name, _)| ["Map", "SO4"].contains(name));
        let own = own.map(|(name, all)| {
            format!("generators = {{ {name} = [{}] }}\n", all.iter().map(written).collect::<Vec<_>>().join(", "))
        });
        let own = own.unwrap_or_default();
        let text = format!(
            "[lagrangian]\ngroup = {{ A = \"{first}\", B = \"{second_name}\" }}\n{own}velocity = [\"xi\", \"eta\"]\n\
             discretise = \"trapezoid(Cayley)\"\nl = \"xi.dot(K * xi) / 2 + eta.dot(M * eta) / 2 + c * xi[0] * eta[1]\"\n\
             K = {}\nM = {}\nc = 0.3\n[start]\nA = {{ {}velocity = {:?} }}\nB = {{ {}velocity = {:?} }}\n",
            written(&K),
            written(&M),
            attitude(first),
            &xi[..m],
            attitude(second_name),
            &xi[m..]
        );
        let [momentum, defect] = drifts(&second(&text, "", 100), m + n);
        assert!(momentum < 1e-14 && defect < 1e-13, "{first}, {second_name}: {momentum:e} {defect:e}");
        let generators = product(&[A, B]);
        let rows = generators[0].nrows();
        let reference = Reference::free(&generators, whole);
        assert_orders(
            &format!("{first} x {second_name}"),
            &text,
            &reference.end(DMatrix::identity(rows, rows), &xi, 1.0, 400).1,
        );
    }
}

/// The letter, generators and name of each factor of a product.
type Factors = Vec<(&'static str, Generators, &'static str)>;

/// Products with groups of the file's own, free and with kinetic energies that the Cayley map couples: orders, momentum in
/// space, distance from the group.
#[test]
fn products_with_groups_of_the_files_own() {
    let matrices = |all: &Generators| format!("[{}]", all.iter().map(written).collect::<Vec<_>>().join(", "));
    let metrics = |all: &[Generators]| all.iter().map(|one| metric(one[0].nrows())).collect::<Vec<_>>();
    // A drop beside a body in space, in this order and the other; a map of the plane beside a translation of space, and a drop.
    let free: [(&str, Factors); 3] = [
        ("drop, body", vec![("A", special_linear(), "SL3"), ("B", poses(4), "SE3")]),
        ("body, drop", vec![("A", poses(4), "SE3"), ("B", special_linear(), "SL3")]),
        ("map, drop, turn", vec![("A", affine(2), "Map"), ("B", special_linear(), "SL3"), ("C", turns(), "SO3")]),
    ];
    for (name, factors) in free {
        let all: Vec<Generators> = factors.iter().map(|(_, all, _)| all.clone()).collect();
        let own = factors.iter().filter(|(.., group)| ["SL3", "Map"].contains(group));
        let own: Vec<String> = own.map(|(_, all, group)| format!("{group} = {}", matrices(all))).collect();
        let (group, kinetic): (Vec<String>, Vec<String>) = factors
            .iter()
            .map(|(F, _, group)| (format!("{F} = \"{group}\""), ANY.replace('F', F).replace('J', &format!("J_of_{F}"))))
            .unzip();
        let (J, generators) = (metrics(&all), product(&all));
        let xi = moving(generators.len());
        let mut text = format!(
            "[lagrangian]\ngroup = {{ {} }}\ngenerators = {{ {} }}\nl_d = \"\"\"\n{}\"\"\"\n",
            group.join(", "),
            own.join(", "),
            kinetic.join(" + ")
        );
        let mut starts = String::from("[start]\n");
        let mut before = 0;
        for ((F, own, group), J) in factors.iter().zip(&J) {
            let _ = writeln!(text, "J_of_{F} = {}", written(J));
            let euler = if *group == "SO3" { "euler = [0, 0, 0], " } else { "" };
            let _ = writeln!(starts, "{F} = {{ {euler}velocity = {:?} }}", &xi[before..before + own.len()]);
            before += own.len();
        }
        text += &starts;
        let blocks = blocks(&J.iter().collect::<Vec<_>>());
        let reference = Reference::free(&generators, of_traces(&generators, &blocks));
        let n = generators[0].nrows();
        let (_, exact) = reference.end(DMatrix::identity(n, n), &xi, 1.0, 400);
        assert_orders(name, &text, &exact);
        for method in ["", "Suzuki 4"] {
            let [momentum, defect] = drifts(&second(&text, method, 100), generators.len());
            assert!(momentum < 1e-14 && defect < 1e-13, "{name} {method}: {momentum:e} {defect:e}");
        }
    }
}

/// A body in space whose weight depends on the direction of a wheel's axis, which it doesn't touch: SE(3) × SO(3) by factors.
#[test]
fn a_body_in_space_and_a_wheel() {
    let text = r#"[lagrangian]
group = { F = "SE3", Q = "SO3" }
advected = { w = "height.seen_from(F)", u = "up.seen_from(Q)" }
l_d = """
((F - I) * K * (F - I).transpose()).trace() / (2 * h) + ((Q - I) * J * (Q - I).transpose()).trace() / (2 * h)
  - h / 2 * (w.dot(weight) * (1 + c * u.z) + (F.transpose() * w).dot(weight) * (1 + c * (Q.transpose() * u).z))"""
K = [[2, 0.1, 0, 0.2], [0.1, 1.5, 0, 0], [0, 0, 1.1, 0], [0.2, 0, 0, 1.3]]
J = [[0.3, 0, 0.02], [0, 0.4, 0], [0.02, 0, 0.5]]
c = 0.4
weight = [0.3, -0.2, 0.4, 3]
height = [0, 0, 1, 0]
up = [0, 0, 1]
[start]
F = { euler = [0, 0, 0], position = [0, 0, 1], velocity = [0.3, -0.7, 1.1, 0.2, 0.5, -0.4] }
Q = { euler = [0, 0, 0], velocity = [0.9, 0.4, -2] }
"#;
    let K = [2.0, 0.1, 0.0, 0.2, 0.1, 1.5, 0.0, 0.0, 0.0, 0.0, 1.1, 0.0, 0.2, 0.0, 0.0, 1.3];
    let (K, J) = (DMatrix::from_row_slice(4, 4, &K), [0.3, 0.0, 0.02, 0.0, 0.4, 0.0, 0.02, 0.0, 0.5]);
    let generators = product(&[poses(4), turns()]);
    let kinetic = of_traces(&generators, &blocks(&[&K, &DMatrix::from_row_slice(3, 3, &J)]));
    let potential = |g: &DMatrix<f64>| {
        let weight: f64 = (0..4).map(|k| g[(2, k)] * [0.3, -0.2, 0.4, 3.0][k]).sum();
        weight * (1.0 + 0.4 * g[(6, 6)])
    };
    let reference = Reference { bias: DVector::zeros(9), generators: &generators, kinetic, potential: &potential };
    let mut g = DMatrix::identity(7, 7);
    g[(2, 3)] = 1.0;
    let (_, exact) = reference.end(g, &[0.3, -0.7, 1.1, 0.2, 0.5, -0.4, 0.9, 0.4, -2.0], 1.0, 400);
    assert_orders("a body in space and a wheel", text, &exact);
}

/// Three bodies that see each other by potentials of their relative attitudes: orders, and the sum of their momenta.
#[test]
fn three_bodies_that_see_each_other() {
    let text = r#"[lagrangian]
group = { F_1 = "SO3", F_2 = "SO3", F_3 = "SO3" }
advected = { Q = "F_2.seen_from(F_1)", P = "F_3.seen_from(F_1)" }
l_d = """
(((F_1 - I) * A * (F_1 - I).transpose()).trace() + ((F_2 - I) * B * (F_2 - I).transpose()).trace()
  + ((F_3 - I) * B * (F_3 - I).transpose()).trace()) / (2 * h)
  + h * k * ((D * Q).trace() + (D * F_1.transpose() * Q * F_2).trace() + P.trace()
    + (F_1.transpose() * P * F_3).trace()) / 2"""
A = [[1, 0, 0], [0, 1.5, 0], [0, 0, 2]]
B = [[1, 0, 0.1], [0, 1.5, 0], [0.1, 0, 2]]
D = [[1, 0.5, 0], [0, 1, 0], [0.2, 0, 2]]
k = 2
[start]
F_1 = { euler = [0, 0, 0], velocity = [0.1, 1, 0.2] }
F_2 = { euler = [0, "30 deg", 0], velocity = [0.1, 0, 0.2] }
F_3 = { quaternion = [1, 0.2, 0, 0], velocity = [0.1, 0, -1] }
"#;
    let J = |rows: [f64; 9]| DMatrix::from_row_slice(3, 3, &rows);
    let (A, B) = (J([1.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 2.0]), J([1.0, 0.0, 0.1, 0.0, 1.5, 0.0, 0.1, 0.0, 2.0]));
    let D = J([1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.2, 0.0, 2.0]);
    let generators = product(&[turns(), turns(), turns()]);
    let kinetic = of_traces(&generators, &blocks(&[&A, &B, &B]));
    let potential = |g: &DMatrix<f64>| {
        let part = |k: usize| g.view((3 * k, 3 * k), (3, 3)).into_owned();
        let seen = |other: usize| part(0).transpose() * part(other);
        -2.0 * ((&D * seen(1)).trace() + seen(2).trace())
    };
    let reference = Reference { bias: DVector::zeros(9), generators: &generators, kinetic, potential: &potential };
    let about_x = |angle: f64| {
        let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::x_axis(), angle);
        DMatrix::from_row_slice(3, 3, turn.matrix().transpose().as_slice())
    };
    let g = blocks(&[&DMatrix::identity(3, 3), &about_x(30_f64.to_radians()), &about_x(2.0 * 0.2_f64.atan())]);
    let (_, exact) = reference.end(g, &[0.1, 1.0, 0.2, 0.1, 0.0, 0.2, 0.1, 0.0, -1.0], 1.0, 400);
    assert_orders("three bodies", text, &exact);
    let sum = |sample: &Sample| -> Vec<f64> {
        let momentum = in_space(sample, 9);
        (0..3).map(|k| momentum[k] + momentum[3 + k] + momentum[6 + k]).collect()
    };
    // Potentials of relative attitudes turn nothing as a whole.
    let plain = text.replace("(D * Q)", "Q").replace("D * F_1.transpose()", "F_1.transpose()");
    let plain = plain.replace("D = [[1, 0.5, 0], [0, 1, 0], [0.2, 0, 2]]\n", "");
    for text in [text, &plain] {
        let run = second(text, "", 100);
        let first = sum(&run.samples()[0]);
        let drift = run.samples().iter().map(|sample| apart(&sum(sample), &first)).fold(0.0, f64::max);
        assert!(drift < 1e-13, "{drift:e}");
    }
    // Without a step, to 1e-6.
    let scene = one(&format!("title = \"three\"\n{text}[run]\nduration = 1\n"));
    let run = scene.run().unwrap();
    let off = apart(velocity(last(&run), 9), exact.as_slice());
    assert!(off < 1e-6 && scene.summary(&run).contains("the end is off by at most about"), "{off:e}");
}

/// A body with a centre of mass aside, on SE(3): gravity by an advected covector, a start by euler angles and position,
/// by a matrix, and by a momentum.
#[test]
fn a_body_on_se3() {
    let text = r#"[lagrangian]
group = "SE3"
advected = { w = "up" }
l_d = """
((F - I) * K * (F - I).transpose()).trace() / (2 * h) - h * (w.dot(rho) + w.dot(F * rho)) / 2
    - h * k * (w.dot(rho).powi(2) + w.dot(F * rho).powi(2)) / 2"""
K = [[1, 0, 0, 0.2], [0, 1.5, 0, 0], [0, 0, 2, 0], [0.2, 0, 0, 2]]
k = 3
rho = [0.1, 0.2, 0.5, 1]
up = [0, 0, 1, 0]
[start]
euler = [0, "30 deg", 0]
position = [0, 0, 1]
velocity = [0.1, 0.2, 3, 0, 1, 0]
"#;
    let K = DMatrix::from_row_slice(
        4,
        4,
        &[1.0, 0.0, 0.0, 0.2, 0.0, 1.5, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.2, 0.0, 0.0, 2.0],
    );
    let generators = poses(4);
    let potential = |g: &DMatrix<f64>| {
        let height = (g * DVector::from_column_slice(&[0.1, 0.2, 0.5, 1.0]))[2];
        height + 3.0 * height.powi(2)
    };
    let kinetic = of_traces(&generators, &K);
    let reference = Reference { bias: DVector::zeros(6), generators: &generators, kinetic, potential: &potential };
    let (sine, cosine) = 30_f64.to_radians().sin_cos();
    let mut g = DMatrix::identity(4, 4);
    (g[(1, 1)], g[(1, 2)], g[(2, 1)], g[(2, 2)], g[(2, 3)]) = (cosine, -sine, sine, cosine, 1.0);
    let (place, exact) = reference.end(g.clone(), &[0.1, 0.2, 3.0, 0.0, 1.0, 0.0], 1.0, 400);
    assert_orders("SE(3)", text, &exact);
    let fine = second(text, "Kahan-Li 8", 100);
    let entries = &last(&fine).numbers[..16];
    assert!(apart(entries, place.transpose().as_slice()) < 1e-9, "{place}");
    // Other words for one start.
    let same = second(text, "", 100);
    let by_matrix =
        text.replace("euler = [0, \"30 deg\", 0]\nposition = [0, 0, 1]", &format!("attitude = {}", written(&g)));
    assert!(apart(&last(&second(&by_matrix, "", 100)).numbers, &last(&same).numbers) < 1e-12);
    let momentum = &same.samples()[0].numbers[22..28];
    let by_momentum = text.replace("velocity = [0.1, 0.2, 3, 0, 1, 0]", &format!("momentum = {momentum:?}"));
    assert!(apart(&last(&second(&by_momentum, "", 100)).numbers, &last(&same).numbers) < 1e-12);
}

/// Effects of the library beside a kinetic energy of the file's own, and a potential of its own beside a body, by a splitting
/// and for an accuracy: the motion of the library's body and gravity.
#[test]
fn texts_beside_the_library() {
    const BODY: &str = "[body]\nmoments = [3, 3, 4]\n";
    const KINETIC: &str = "[lagrangian]\nl_d = \"((F - I) * J_d * (F - I).transpose()).trace() / (2 * h)\"\n\
                           J_d = { moments = [3, 3, 4] }\n";
    const GRAVITY: &str = "[gravity]\nm = 1\ng = 9.81\nrho = [0, 0, 1]\nup = [0, 0, 1]\n";
    const POTENTIAL: &str = "[[lagrangian]]\nadvected = { w = \"up\" }\nl_d = \"-0.5 * h * m * g * w.dot(&(rho + F * rho))\"\n\
                             m = 1\ng = 9.81\nrho = [0, 0, 1]\nup = [0, 0, 1]\n";
    const START: &str = "[start]\neuler = [0, \"45 deg\", 0]\nvelocity = [0.1, 0, 6]\n";
    let scene = |terms: [&str; 2], run: &str| {
        let text = format!("title = \"top\"\n{}{}{START}[run]\nduration = 1\n{run}", terms[0], terms[1]);
        last(&one(&text).run().unwrap()).numbers.clone()
    };
    let kinetic = KINETIC.replace("[lagrangian]", "[[lagrangian]]");
    for (run, tolerance) in
        [("step = 0.01\n", 1e-13), ("step = 0.01\nmethod = { composition = \"Suzuki 4\" }\n", 1e-12)]
    {
        let library = scene([BODY, GRAVITY], run);
        for terms in [[KINETIC, GRAVITY], [BODY, POTENTIAL], [&kinetic, POTENTIAL]] {
            assert!(apart(&scene(terms, run), &library) < tolerance, "{run}{terms:?}");
        }
    }
    let exact = scene([BODY, GRAVITY], "accuracy = 1e-10\n");
    let splitting = "step = 0.01\nmethod = { splitting = \"Nyström 6-4\" }\n";
    assert!(apart(&scene([BODY, POTENTIAL], splitting), &exact) < 1e-8);
    for terms in [[BODY, POTENTIAL], [&kinetic, POTENTIAL], [KINETIC, GRAVITY]] {
        assert!(apart(&scene(terms, ""), &exact) < 2e-5, "{terms:?}");
    }
}

/// A sweep, an ensemble, a page and a table of events of a scene on another group.
#[test]
fn a_scene_on_a_group_is_one_as_any_other() {
    let folder = folder("groups");
    let text = format!(
        "{}[[event]]\nname = \"low\"\ncolumn = \"g_34\"\nvalue = 0\n[output]\ncolumns = [\"velocity\", \"energy\", \"defect\"]\n\
         [ensemble]\nmembers = 4\ndraw.lagrangian.g = {{ from = 9, to = 10 }}\n\
         draw.start.velocity = [0.1, 0.2, {{ mean = 3, deviation = 0.1 }}, 0, 1, 0]\n\
         [sweep]\nlagrangian.g = [9, 10]\nstart.position = [[0, 0, 1], [0, 0, 9]]\n",
        include_str!("scenes/pose.toml")
    );
    fs::write(folder.join("pose.toml"), text).unwrap();
    let told = printed(&folder, &["ensemble", "pose.toml", "--out", "."]);
    assert!(told.contains("4 finished, 0 broke down") && told.contains("low: in 4 of 4"), "{told}");
    printed(&folder, &["sweep", "pose.toml", "--out", "."]);
    let sweep = fs::read_to_string(folder.join("pose.sweep.csv")).unwrap();
    let rows: Vec<Vec<&str>> = sweep.lines().map(|line| line.split(',').collect()).collect();
    // The height of the start moves the events and the energy, and nothing else.
    assert!(rows.len() == 5 && rows[1][3..9] == rows[2][3..9] && rows[1][3..9] != rows[3][3..9], "{sweep}");
    assert!(rows[0][13] == "low_times" && rows[1][13] == "1.0" && rows[2][13] == "0.0", "{sweep}");
    printed(&folder, &["run", "pose.toml", "--csv", "--html", "--arrow", "--out", "."]);
    let [page, events] =
        ["html", "events.csv"].map(|end| fs::read_to_string(folder.join(format!("pose.{end}"))).unwrap());
    assert!(page.contains("bodies: [\n],") && page.contains("\"Velocity of the body\""));
    assert!(events.starts_with("event,rising,t,velocity_1,") && events.contains("\nlow,0,0.7"), "{events}");
}
