//! Cases of papers and of public reports that a file can say, each against equations or numbers of its own.

use liestep_scene::Sample;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::reference::{
    Reference, affine, apart, assert_orders, drifts, in_space, last, metric, one, poses, second, turns, unit, velocity,
    written,
};

/// A charged symmetric body in a magnetic field, whose energy has a term that is linear in the velocity.
#[test]
fn a_charged_body_in_a_field() {
    let text = r#"[lagrangian]
advected = { w = "field" }
velocity = "Omega"
discretise = "trapezoid(Cayley)"
l = "Omega.dot(J * Omega) / 2 + k * w.dot(J * Omega)"
J = { moments = [1, 1, 1.5] }
k = 0.7
field = [0, 0.6, 0.8]
[start]
euler = [0, 0, 0]
velocity = [0.5, 1, 2]
"#;
    // In a frame that turns with −k w the symmetric body is free (Larmor), to first order; here the equations
    // themselves: μ' = μ × Ω + k (JΩ) × w, w' = w × Ω, μ = J (Ω + k w).
    let J = Vector3::new(1.0, 1.0, 1.5);
    let rates = |(mu, w): (Vector3<f64>, Vector3<f64>)| {
        let omega = mu.component_div(&J) - w * 0.7;
        (mu.cross(&omega) + J.component_mul(&omega).cross(&w) * 0.7, w.cross(&omega))
    };
    let w = Vector3::new(0.0, 0.6, 0.8);
    let mut now = (J.component_mul(&(Vector3::new(0.5, 1.0, 2.0) + w * 0.7)), w);
    let h = 1.0 / 1000.0;
    for _ in 0..1000 {
        let plus = |rate: (Vector3<f64>, Vector3<f64>), part: f64| (now.0 + rate.0 * part, now.1 + rate.1 * part);
        let a = rates(now);
        let b = rates(plus(a, h / 2.0));
        let c = rates(plus(b, h / 2.0));
        let d = rates(plus(c, h));
        now = plus((a.0 + (b.0 + c.0) * 2.0 + d.0, a.1 + (b.1 + c.1) * 2.0 + d.1), h / 6.0);
    }
    let exact = now.0.component_div(&J) - now.1 * 0.7;
    assert_orders("charged body", text, &DVector::from_column_slice(exact.as_slice()));
    let run = second(text, "", 100);
    let along = |sample: &Sample| sample.angular_momentum.dot(&w);
    let drift = run.samples().iter().map(|sample| (along(sample) - along(&run.samples()[0])).abs()).fold(0.0, f64::max);
    assert!(drift < 1e-14, "{drift:e}");
}

/// A rod of Kirchhoff with a curvature of its own, with arc length as time: `l = (ξ − ξ₀)·K (ξ − ξ₀)/2` on SE(3).
#[test]
fn a_rod_with_a_curvature() {
    let generators = poses(4);
    let (K, own) = (metric(6), [0.3, -0.2, 0.5, 0.0, 0.0, 1.0]);
    let xi = [0.5, 0.1, 0.8, 0.1, -0.1, 1.2];
    let text = format!(
        "[lagrangian]\ngroup = \"SE3\"\nvelocity = \"xi\"\ndiscretise = \"trapezoid(Cayley)\"\n\
         l = \"(xi - u).dot(K * (xi - u)) / 2\"\nK = {}\nu = {own:?}\n[start]\nvelocity = {xi:?}\n",
        written(&K)
    );
    let bias = -(&K * DVector::from_column_slice(&own));
    let reference = Reference { bias, generators: &generators, kinetic: K, potential: &|_| 0.0 };
    assert_orders("rod", &text, &reference.end(DMatrix::identity(4, 4), &xi, 1.0, 400).1);
    let [momentum, _] = drifts(&second(&text, "", 100), 6);
    assert!(momentum < 1e-14, "{momentum:e}");
}

/// An affine body of a graphics engine on GL(3): with `κ‖AᵀA − I‖²` its steps are those of Störmer and Verlet for the
/// entries of A.
#[test]
fn an_affine_body() {
    let list: Vec<_> = (0..9).map(|k| written(&unit(3, &[(k / 3, k % 3, 1.0)]))).collect();
    let velocity = [0.1, -1.0, 0.3, 1.0, 0.2, 0.0, -0.3, 0.1, -0.1];
    let text = format!(
        "[lagrangian]\ngroup = \"GL3\"\ngenerators = [{}]\nadvected = {{ B = \"metric\" }}\nl_d = \"\"\"\n\
         (B * (F - I) * J * (F - I).transpose()).trace() / (2 * h) - h * k * (((B - I) * (B - I)).trace()\n\
         + ((F.transpose() * B * F - I) * (F.transpose() * B * F - I)).trace()) / 2\"\"\"\n\
         J = [[1, 0, 0], [0, 1.5, 0], [0, 0, 2]]\nk = 5\nmetric = {{ covariant = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }}\n\
         [start]\nvelocity = {velocity:?}\n",
        list.join(", ")
    );
    let run = second(&text, "", 100);
    let J = Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 2.0));
    let inverse = J.try_inverse().unwrap();
    let force = |A: &Matrix3<f64>| -4.0 * 5.0 * A * (A.transpose() * A - Matrix3::identity());
    let (h, mut A) = (0.01, Matrix3::identity());
    let mut momentum = Matrix3::from_row_slice(&velocity) * J;
    for _ in 0..100 {
        momentum += force(&A) * (h / 2.0);
        A += momentum * inverse * h;
        momentum += force(&A) * (h / 2.0);
    }
    let off = apart(&last(&run).numbers[..9], A.transpose().as_slice());
    assert!(off < 1e-11, "{off:e}");
    let spin = |sample: &Sample| {
        let momentum = in_space(sample, 9);
        [momentum[1] - momentum[3], momentum[2] - momentum[6], momentum[5] - momentum[7]]
    };
    let lost = run.samples().iter().map(|now| apart(&spin(now), &spin(&run.samples()[0]))).fold(0.0, f64::max);
    assert!(lost < 1e-13, "{lost:e}");
}

/// A double pendulum by its angles, on (R1, R1), with `l(θ, θ')` as it is in books.
#[test]
fn a_double_pendulum_by_angles() {
    let text = r#"[lagrangian]
group = { a = "R1", b = "R1" }
velocity = ["u", "v"]
advected = { x = "a.seen_from(space)", y = "b.seen_from(space)" }
l = "u * u + v * v / 2 + u * v * (x - y).cos() + g * (2 * x.cos() + y.cos())"
discretise = "trapezoid"
g = 9.81
[start]
a = { position = "90 deg", velocity = 0 }
b = { position = 0.5, velocity = 0 }
"#;
    // The accelerations of two equal masses on rods of one metre.
    let rates = |[x, y, u, v]: [f64; 4]| {
        let (sine, cosine) = (x - y).sin_cos();
        let (p, q) = (-v * v * sine - 2.0 * 9.81 * x.sin(), u * u * sine - 9.81 * y.sin());
        let determinant = 2.0 - cosine * cosine;
        [u, v, (p - cosine * q) / determinant, (2.0 * q - cosine * p) / determinant]
    };
    let (mut now, h) = ([std::f64::consts::FRAC_PI_2, 0.5, 0.0, 0.0], 1.0 / 2000.0);
    for _ in 0..2000 {
        let plus = |rate: [f64; 4], part: f64| std::array::from_fn::<_, 4, _>(|k| now[k] + rate[k] * part);
        let a = rates(now);
        let b = rates(plus(a, h / 2.0));
        let c = rates(plus(b, h / 2.0));
        let d = rates(plus(c, h));
        now = std::array::from_fn(|k| now[k] + (a[k] + 2.0 * (b[k] + c[k]) + d[k]) * (h / 6.0));
    }
    let error = |method, steps| apart(velocity(last(&second(text, method, steps)), 2), &now[2..]);
    let order = (error("", 200) / error("", 400)).log2();
    let fine = error("Kahan-Li 8", 100);
    assert!((order - 2.0).abs() < 0.01 && fine < 1e-9, "{order} {fine:e}");
}

/// The pendulum in space of a paper of 2005 (Lee, Leok and others) for 1000 s: the energy oscillates within the paper's bounds, and
/// the momentum along the vertical is conserved.
#[test]
fn a_pendulum_in_space() {
    let text = r#"title = "pendulum"
[lagrangian]
advected = { w = "down" }
l_d = """
((F - I) * J_d * (F - I).transpose()).trace() / (2 * h) + h * m * g * (w.dot(rho) + w.dot(F * rho)) / 2"""
J_d = { moments = [0.13, 0.28, 0.17] }
m = 1
g = 9.81
rho = [0, 0, 0.3]
down = [0, 0, 1]
[start]
euler = [0, 0, 0]
velocity = [4.14, 4.14, 4.14]
[run]
step = 0.05
duration = 1000
"#;
    let run = one(text).run().unwrap();
    let first = &run.samples()[0];
    assert!((first.energy - 2.027).abs() < 5e-4, "{}", first.energy);
    let (least, most) = run.samples().iter().fold((0.0_f64, 0.0_f64), |(least, most), sample| {
        (least.min(sample.energy - first.energy), most.max(sample.energy - first.energy))
    });
    assert!((least + 4.46e-2).abs() < 1e-4 && (most - 7.60e-2).abs() < 1e-4, "{least} {most}");
    let vertical =
        run.samples().iter().map(|now| (now.angular_momentum - first.angular_momentum).z.abs()).fold(0.0, f64::max);
    assert!(vertical < 1e-13, "{vertical:e}");
}

/// A fast heavy top at 150 rad/s: the errors of `R(1 s)` by the geodesic and the Cayley kinetic term, by the step.
#[test]
fn a_fast_heavy_top() {
    let top = |run: &str, kinetic: &str| {
        let text = format!(
            "title = \"top\"\n[body]\nJ = [[15.234375, 0, 0], [0, 0.46875, 0], [0, 0, 15.234375]]\n{kinetic}[gravity]\nm = 15\ng = 9.81\n\
             rho = [0, 1, 0]\nup = [0, 0, 1]\n[start]\nquaternion = [1, 0, 0, 0]\nvelocity = [0, \"150 rad/s\", -4.61538]\n\
             [run]\nduration = 1\n{run}"
        );
        last(&one(&text).run().unwrap()).bodies[0].attitude
    };
    let exact = top("accuracy = 1e-9\n", "");
    let error = |kinetic: &str| (top("step = 0.0009765625\n", kinetic).as_matrix() - exact.as_matrix()).norm();
    for (kinetic, known) in [("geodesic", 2.0e-2), ("cayley", 1.5)] {
        let found = error(&format!("kinetic = \"{kinetic}\"\n"));
        assert!((found / known - 1.0).abs() < 0.05, "{kinetic}: {found:e}");
    }
}

/// A body on eight springs, each a potential of the file's own beside a body of the library.
#[test]
fn a_body_on_eight_springs() {
    let ends = |k: u8| [k & 1, k >> 1 & 1, k >> 2 & 1].map(|bit| f64::from(bit) - 0.5);
    let spring = |k: u8| {
        let [x, y, z] = ends(k);
        format!(
            "[[lagrangian]]\nadvected = {{ a = \"anchor\" }}\nl_d = \"-h * k * ((r - a).norm_squared() + (F * r - a).norm_squared()) / 4\"\n\
             k = {}\nr = [{x}, {y}, {z}]\nanchor = [{}, {}, {}]\n",
            2.0 + f64::from(k),
            1.5 * x + 0.2,
            1.5 * y,
            1.5 * z
        )
    };
    let springs: String = (0..8).map(spring).collect();
    let text = format!("[body]\nmoments = [1, 1.5, 2]\n{springs}[start]\neuler = [0, 0, 0]\nvelocity = [0.5, -1, 2]\n");
    let generators = turns();
    let potential = |g: &DMatrix<f64>| {
        let energy = |k: u8| {
            let [x, y, z] = ends(k);
            let end = g * DVector::from_column_slice(&[x, y, z]);
            let anchor = DVector::from_column_slice(&[1.5 * x + 0.2, 1.5 * y, 1.5 * z]);
            (2.0 + f64::from(k)) * (end - anchor).norm_squared() / 2.0
        };
        (0..8).map(energy).sum()
    };
    let kinetic = DMatrix::from_diagonal(&DVector::from_column_slice(&[1.0, 1.5, 2.0]));
    let reference = Reference { bias: DVector::zeros(3), generators: &generators, kinetic, potential: &potential };
    assert_orders("springs", &text, &reference.end(DMatrix::identity(3, 3), &[0.5, -1.0, 2.0], 1.0, 400).1);
}

/// An affine body that falls: 12 generators, and the weight of its homogeneous coordinates.
#[test]
fn an_affine_body_that_falls() {
    let list: Vec<_> = affine(3).iter().map(written).collect();
    let text = format!(
        "[lagrangian]\ngroup = \"Affine\"\ngenerators = [{}]\nadvected = {{ w = \"up\", B = \"metric\" }}\nl_d = \"\"\"\n\
         (B * (F - I) * J * (F - I).transpose()).trace() / (2 * h) - h * g * (w.dot(e) + w.dot(F * e)) / 2\"\"\"\n\
         J = [[1, 0, 0, 0], [0, 1.5, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]\ng = 9.81\ne = [0, 0, 0, 1]\nup = [0, 0, 1, 0]\n\
         metric = {{ covariant = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]] }}\n[start]\n\
         velocity = [0, 0.1, 0, 0, -0.1, 0, 0, 0, 0, 0, 0, 0]\n",
        list.join(", ")
    );
    let run = second(&text, "", 100);
    let height = last(&run).numbers[11];
    assert!((height + 4.9050).abs() < 1e-10, "{height}");
}
