//! Steps as text in other languages: compiled C makes the library's steps, and Rust is formatted as by rustfmt.

mod door;
mod doors;
mod groups;
mod sums;

use std::fs;
use std::process::Command;

use declarations::{CayleyTop, DoublePendulum, Flyer, FullTop, LogTop, SixthOrderTop};
use liestep::groups::{LieGroup as _, SE23};
use liestep::mechanics::{Effect, Regular};
use liestep::motion::{AnyStepper, Propagator as _};
use liestep::numbers::Entries;
use liestep::with::Method;
use liestep::{NonstandardInertia, SO3, Stepper, lagrangian};
use liestep_derivation::whole::StepRefusal;
use liestep_late::{Declaration, LateError, Sums, Whole, c, latex, rust};
use nalgebra::{Matrix3, SMatrix, Vector3};

use door::{Course, Door, STEP, folder, is_there, row};

pub(crate) fn parsed(text: &str) -> &'static Declaration {
    Declaration::parse(text).expect("a declaration")
}

fn top() -> FullTop {
    let J_d = Matrix3::new(2.0, 0.1, -0.2, 0.1, 2.5, 0.3, -0.2, 0.3, 3.0);
    let J_d = NonstandardInertia::new(J_d).expect("an inertia");
    FullTop { J_d, m: 1.5, g: 9.81, rho: Vector3::new(0.1, -0.2, 0.4), up: Vector3::z() }
}

#[lagrangian(group = SE23, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug)]
struct ExtendedPose {
    J: SMatrix<f64, 5, 5>,
}

/// A top whose centre of mass is turned in it, by a constant rotation vector and by one along the vertical.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * (w.dot(&(exp(v) * rho)) + w.dot(&(exp(c * w) * rho)))
)]
#[derive(Clone, Copy, Debug)]
struct TurnedTop {
    J_d: NonstandardInertia,
    v: Vector3<f64>,
    c: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

fn entries<V: Entries<f64>>(value: &V) -> Vec<f64> {
    let mut all = Vec::new();
    value.each(&mut |entry| all.push(entry));
    all
}

/// Whether all steps by this text, by stages of these lengths, are made, and have the bits of this stepper's.
fn has_the_bits_of<E>(
    effect: &E,
    stepper: &AnyStepper,
    (attitude, velocity): (&[f64], &[f64]),
    course: Course<'_>,
    (door, text): (Door, &str),
) -> bool
where
    E: Effect<Scalar = f64>,
{
    let declaration = parsed(E::DECLARATION);
    let numbers = declaration.described(&liestep_late::numbers(effect)).expect("numbers");
    let mut state = stepper.start(attitude, velocity).expect("a start");
    let (momentum, velocity) = (state.momentum().to_vec(), stepper.velocity(&state));
    let folder = folder(&format!("{}-{door:?}", declaration.name));
    let found = door.rows((declaration, text), &folder, course, [&numbers, attitude, &momentum, &velocity]);
    fs::remove_dir_all(&folder).expect("the folder is there");
    let mut expected = String::new();
    for _ in 0..course.0 / 100 {
        stepper.run(&mut state, 100).expect("steps");
        expected += &row(state.momentum().iter().chain(state.attitude()).copied());
    }
    found == Some(expected)
}

/// Whether all steps by this text are made, and have the bits of the compiled stepper's.
fn has_the_bits_of_a_step<E>(
    effect: &E,
    attitude: E::Group,
    velocity: &[f64],
    steps: u32,
    written: (Door, &str),
) -> bool
where
    E: Regular<Scalar = f64> + Clone + 'static,
{
    let stepper = Stepper::new(effect.clone(), STEP).expect("a stepper").into_any();
    has_the_bits_of(effect, &stepper, (&entries(&attitude.matrix()), velocity), (steps, &[1.0]), written)
}

/// A drop that keeps its volume, a group of the text's own, and a body in space.
#[test]
fn c_has_a_step_of_a_product_with_an_own_group() {
    if !is_there("cc") {
        return;
    }
    let kinetic = |F: &str, J: &str| {
        format!(
            "((({F} - I) * {J} * ({F} - I).transpose()).trace()
                + ((I - inverse({F})) * {J} * (I - inverse({F})).transpose()).trace()) / (4 * h)"
        )
    };
    let declaration = parsed(&format!(
        "#[lagrangian(group(Q = Drops, F = SE3), advected(w = up.seen_from(F)), generators(Drops = [
            [[0, 1, 0], [0, 0, 0], [0, 0, 0]], [[0, 0, 1], [0, 0, 0], [0, 0, 0]], [[0, 0, 0], [1, 0, 0], [0, 0, 0]],
            [[0, 0, 0], [0, 0, 1], [0, 0, 0]], [[0, 0, 0], [0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 0, 0], [0, 1, 0]],
            [[1, 0, 0], [0, -1, 0], [0, 0, 0]], [[0, 0, 0], [0, 1, 0], [0, 0, -1]]]),
            l_d = {} + {} - h / 2 * (w.dot(rho) + (F.transpose() * w).dot(rho)))]
        struct DropAndBody {{ J: Matrix3<f64>, K: Matrix4<f64>, rho: Vector4<f64>, up: Vector4<f64> }}",
        kinetic("Q", "J"),
        kinetic("F", "K")
    ));
    let numbers = declaration
        .numbers(&[
            ("J", &[1.0, 0.05, 0.02, 0.05, 1.1, 0.03, 0.02, 0.03, 1.2]),
            ("K", &[2.0, 0.1, 0.0, 0.0, 0.1, 1.5, 0.0, 0.0, 0.0, 0.0, 1.1, 0.0, 0.0, 0.0, 0.0, 1.3]),
            ("rho", &[0.3, -0.2, 0.4, 2.0]),
            ("up", &[0.0, 0.0, 1.0, 0.0]),
        ])
        .expect("numbers");
    let whole: Whole = Whole::of(declaration, &numbers, STEP, Method::default()).expect("a stepper");
    let attitude: Vec<f64> =
        [3_usize, 4].iter().flat_map(|n| (0..n * n).map(move |at| f64::from(u8::from(at % (n + 1) == 0)))).collect();
    let velocity = [0.0, 0.3, -0.08, -0.28, 0.15, 0.24, -0.21, -0.17, 0.3, -0.7, 1.1, 0.2, 0.5, -0.4];
    let mut state = whole.start(&attitude, &velocity).expect("a start");
    let momentum = state[25..39].to_vec();
    let mut expected = String::new();
    let text = c(declaration, Sums::Rounded).expect("a step in C");
    let folder = folder("own");
    let found = Door::C.rows((declaration, &text), &folder, (200, &[1.0]), [&numbers, &attitude, &momentum, &velocity]);
    for _ in 0..2 {
        whole.run(&mut state, 100).expect("steps");
        expected += &row(state[25..39].iter().chain(&state[..25]).copied());
    }
    fs::remove_dir_all(&folder).expect("the folder is there");
    assert_eq!(found, Some(expected));
}

/// A rotation of four dimensions beside one of space is restored as seldom as one alone.
#[test]
fn so_has_one_of_rotations_of_four_dimensions() {
    let kinetic = |F: &str, J: &str| format!("(({F} - I) * {J} * ({F} - I).transpose()).trace() / (2 * h)");
    let generators: Vec<String> = (0..4)
        .flat_map(|i| (i + 1..4).map(move |j| (i, j)))
        .map(|(i, j)| {
            let rows = [0, 1, 2, 3]
                .map(|row| [0, 1, 2, 3].map(|k| i32::from((row, k) == (j, i)) - i32::from((row, k) == (i, j))));
            format!("{rows:?}")
        })
        .collect();
    let declaration = parsed(&format!(
        "#[lagrangian(group(Q = Four, F = SO3), generators(Four = [{}]), l_d = {} + {})]
        struct Both {{ K: SMatrix<f64, 4, 4>, J: Matrix3<f64> }}",
        generators.join(", "),
        kinetic("Q", "K"),
        kinetic("F", "J")
    ));
    let K = [1.0, 0.05, 0.02, 0.0, 0.05, 1.1, 0.03, 0.0, 0.02, 0.03, 1.2, 0.01, 0.0, 0.0, 0.01, 1.3];
    let numbers = declaration.numbers(&[("K", &K), ("J", &[2.0, 0.1, 0.0, 0.1, 1.5, 0.0, 0.0, 0.0, 1.1])]);
    let numbers = numbers.expect("numbers");
    let whole: Whole = Whole::of(declaration, &numbers, STEP, Method::default()).expect("a stepper");
    let attitude: Vec<f64> =
        [4_usize, 3].iter().flat_map(|n| (0..n * n).map(move |at| f64::from(u8::from(at % (n + 1) == 0)))).collect();
    let mut velocity = [0.3, -0.7, 1.1, 0.2, 0.5, -0.4, 0.9, 0.4, -2.0];
    let start = whole.start(&attitude, &velocity).expect("a start");
    // The velocity that the momentum determines, in its roundings.
    whole.velocity(&start, &mut velocity);
    let mut state = start.clone();
    let mut expected = String::new();
    for _ in 0..20 {
        whole.run(&mut state, 100).expect("steps");
        expected += &row(state[25..34].iter().chain(&state[..25]).copied());
    }
    let texts = [(Door::C, c(declaration, Sums::Rounded)), (Door::Node, liestep_late::javascript(declaration))];
    for (door, text) in texts.into_iter().filter(|(door, _)| is_there(door.program())) {
        let (text, folder) = (text.expect("a step"), folder(&format!("four-{door:?}")));
        let given = [&numbers[..], &attitude, &start[25..34], &velocity];
        let found = door.rows((declaration, &text), &folder, (2_000, &[1.0]), given);
        fs::remove_dir_all(&folder).expect("the folder is there");
        assert_eq!(found.as_deref(), Some(&*expected), "{door:?}");
    }
}

#[test]
fn what_has_no_step_in_c_is_told() {
    let refused = |text: &str| c(parsed(text), Sums::Rounded).err();
    for text in [liestep::effects::Gravity::<f64>::DECLARATION, liestep::effects::Drag::<f64>::DECLARATION] {
        assert!(matches!(refused(text), Some(LateError::Step(StepRefusal::NoKinetic))), "{text}");
    }
}

/// A text has no constant that none of its programs reads.
#[test]
fn each_constant_of_a_text_is_read() {
    let [top, log, flyer] = [FullTop::DECLARATION, LogTop::DECLARATION, Flyer::DECLARATION];
    for declaration in
        [top, log, flyer, CayleyTop::DECLARATION, DoublePendulum::<f64>::DECLARATION, TurnedTop::DECLARATION]
    {
        let text = c(parsed(declaration), Sums::Rounded).expect("a step in C");
        let (_, after) = text.split_once("_CONSTANTS = ").expect("a size");
        let count = after.split(|letter: char| !letter.is_ascii_digit()).next().expect("a number");
        let unread = |at: &usize| !text.contains(&format!("in->constants[{at}]"));
        let unread: Vec<usize> = (0..count.parse().expect("a number")).filter(unread).collect();
        assert!(unread.is_empty(), "{declaration}: {unread:?} of {count}");
    }
}

/// The logarithm and the exponential are functions of their own in C, by their series and beyond.
#[test]
fn so_have_logarithms_and_exponentials() {
    if !is_there("cc") {
        return;
    }
    let J = Matrix3::new(3.0, 0.1, -0.2, 0.1, 2.5, 0.3, -0.2, 0.3, 2.0);
    let J = liestep::mechanics::Inertia::new(J).expect("an inertia");
    let attitude = SO3::exp(Vector3::new(0.3, -0.5, 0.2));
    let log = LogTop { J, weight: 15.0, rho: Vector3::new(0.1, -0.2, 0.4), up: Vector3::z() };
    let text = c(parsed(LogTop::DECLARATION), Sums::Rounded).expect("a step in C");
    // Steps of .1, .8 and 1.5 rad: short, longer and closed forms.
    for faster in [1.0, 8.0, 15.0] {
        let velocity = [2.0 * faster, 4.0 * faster, 9.0 * faster];
        assert!(has_the_bits_of_a_step(&log, attitude, &velocity, 1_000, (Door::C, &text)), "{faster}");
    }
    // Thirty thousand operations.
    let sixth = SixthOrderTop { J, weight: 15.0, rho: Vector3::new(0.1, -0.2, 0.4), up: Vector3::z() };
    let text = c(parsed(SixthOrderTop::DECLARATION), Sums::Rounded).expect("a step in C");
    assert!(has_the_bits_of_a_step(&sixth, attitude, &[0.7, -1.1, 4.0], 200, (Door::C, &text)));
    let text = c(parsed(TurnedTop::DECLARATION), Sums::Rounded).expect("a step in C");
    let turned = |length: f64| {
        let (v, J_d) = (Vector3::new(0.6, -0.48, 0.64) * length, *top().J_d.as_matrix());
        let J_d = NonstandardInertia::new(J_d).expect("an inertia");
        TurnedTop { J_d, v, c: length, rho: Vector3::new(0.1, -0.2, 0.4), up: Vector3::z() }
    };
    // Squares of 0.25, 4 and 16.
    for length in [0.5, 2.0, 4.0] {
        assert!(
            has_the_bits_of_a_step(&turned(length), attitude, &[0.7, -1.1, 4.0], 1_000, (Door::C, &text)),
            "{length}"
        );
    }
    let wrong = text.replace("(reciprocal - lower[i % 2]) / q", "(reciprocal + lower[i % 2]) / q");
    assert!(!has_the_bits_of_a_step(&turned(4.0), attitude, &[0.7, -1.1, 4.0], 1_000, (Door::C, &wrong)));
}

/// Rust text is formatted, and complete.
#[test]
fn rust_is_formatted() {
    if !is_there("rustfmt") {
        return;
    }
    let folder = folder("rust");
    for (name, text) in
        [("full", FullTop::DECLARATION), ("log", LogTop::DECLARATION), ("cayley", CayleyTop::DECLARATION)]
    {
        let file = folder.join(format!("{name}.rs"));
        fs::write(&file, rust(parsed(text))).expect("a file");
        let checked =
            Command::new("rustfmt").args(["--edition", "2024", "--check"]).arg(&file).output().expect("it runs");
        assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stdout));
    }
    fs::remove_dir_all(folder).expect("the folder is there");
}

/// LaTeX lines have balanced braces, and only signs that LaTeX has.
#[test]
fn equations_are_latex() {
    let made = latex(parsed(FullTop::DECLARATION));
    assert!(made.contains(r"\mu &= \frac{1}{h} \left(F J_{d} - J_{d} F^{\top}\right)^\vee"), "{made}");
    for text in [FullTop::DECLARATION, SixthOrderTop::DECLARATION, declarations::ElasticFlow::DECLARATION] {
        let made = latex(parsed(text));
        assert!(made.lines().count() > 8, "{made}");
        for line in made.lines() {
            let count = |part: &str| line.matches(part).count();
            assert_eq!(count("{"), count("}"), "{line}");
            assert_eq!(count("\\left("), count("\\right)"), "{line}");
            let unknown = line.chars().find(|character| !character.is_ascii() && !"–’‖≤≥∈".contains(*character));
            assert_eq!(unknown, None, "{line}");
        }
    }
}
