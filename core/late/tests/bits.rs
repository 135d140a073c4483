//! A declaration that is read makes the steps of the one that is compiled, to the bit.

use declarations::{
    CayleyTop, ContinuousTop, DoublePendulum, ElasticFlow, FluidDrag, Flyer, FourthOrderTop, FullTop, HeavyTop, LogTop,
    SixthOrderTop, TopOnCart, UnderwaterBody,
};
use liestep::groups::{Advected, Configuration, CovariantTensor, LieGroup, R2, Relative, SE3, SL2, SeenFrom};
use liestep::mechanics::{
    Effect, Inertia, KineticPart, SceneVisitor, WithExpensiveKinetic, WithKinetic, WithoutKinetic,
};
use liestep::numbers::Entries;
use liestep::{NonstandardInertia, SO3, Stepper};
use liestep_late::{Late, Slots};
use nalgebra::{Matrix2, Matrix3, Matrix4, Point3, Vector3, Vector4};

/// The struct of that name with its attributes, as a file has it; of a file that is generic in its scalar, over `f64`.
fn declared(file: &str, name: &str) -> String {
    let end_of_name = |rest: &str| rest.starts_with([' ', '<']);
    let position = |text: &str| {
        let mut found = text.match_indices("pub struct ").map(|(at, marker)| at + marker.len());
        found.find(|&at| text[at..].strip_prefix(name).is_some_and(end_of_name)).expect(name)
    };
    let at = position(file);
    let attribute =
        ["\n#[lagrangian", "\n#[force"].iter().filter_map(|begin| file[..at].rfind(begin)).max().expect(name);
    let end = at + file[at..].find("\n}").expect("an end") + 2;
    file[attribute..end].replace("<T = f64>", "").replace("<T>", "<f64>").replace(": T,", ": f64,")
}

macro_rules! text {
    ($name:literal in $file:literal) => {
        declared(include_str!(concat!("../../../examples/", $file, ".rs")), $name)
    };
}

/// The parameters of an effect, by their names.
struct Named(Vec<(&'static str, Vec<f64>)>);

impl SceneVisitor<f64> for Named {
    fn term(&mut self, _: &'static str) {}

    fn parameter(&mut self, field: &'static str, value: f64) {
        match self.0.last_mut() {
            Some((last, values)) if *last == field => values.push(value),
            _ => self.0.push((field, vec![value])),
        }
    }
}

/// The declaration of a text with the numbers of a compiled effect.
fn read<E, K>(effect: &E, text: &str) -> Late<E::Group, E::Advected, K>
where
    E: Effect<Scalar = f64>,
    E::Advected: Slots,
    K: KineticPart,
{
    let mut named = Named(Vec::new());
    effect.describe(&mut named);
    let late = Late::parse(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    named.0.iter().fold(late, |late, (name, values)| {
        let diagonal = || [values[0], values[4], values[8]];
        late.clone().with(name, values).or_else(|_| late.with(name, &diagonal())).expect(name)
    })
}

fn entries<E: Entries<f64>>(value: &E) -> Vec<u64> {
    let mut list = Vec::new();
    value.each(&mut |entry| list.push(entry.to_bits()));
    list
}

/// Both make the same 500 steps, forwards and backwards.
fn same<A, B>(compiled: &A, late: &B, start: (A::Group, &[f64]))
where
    A: Effect<Scalar = f64> + Clone + liestep::mechanics::Regular,
    B: Effect<Scalar = f64, Group = A::Group, Advected = A::Advected> + Clone + liestep::mechanics::Regular,
    A::Group: Clone,
    A::Advected: Advected<A::Group>,
{
    for h in [0.01, -0.02] {
        let one = Stepper::new(compiled.clone(), h).expect("a stepper");
        let other = Stepper::new(late.clone(), h).expect("a stepper");
        let velocity = || {
            let mut components = start.1.iter().copied();
            <A::Group as LieGroup>::Vector::from_entries(&mut || components.next().expect("one more"))
        };
        let mut first = one.start(start.0, velocity()).expect("a start");
        let mut second = other.start(start.0, velocity()).expect("a start");
        for step in 0..500 {
            let reports = [one.step(&mut first), other.step(&mut second)].map(|made| made.expect("a step"));
            assert_eq!(reports[0].iterations, reports[1].iterations, "step {step}");
            assert_eq!(entries(&first.momentum()), entries(&second.momentum()), "momentum after step {step}");
            let attitudes = (entries(&first.attitude().matrix()), entries(&second.attitude().matrix()));
            assert_eq!(attitudes.0, attitudes.1, "attitude after step {step}");
            assert_eq!(entries(&first.advected()), entries(&second.advected()), "advected after step {step}");
        }
        let [one, other] = [one.energy(&first), other.energy(&second)];
        assert!((one - other).abs() <= 1e-12 * one.abs().max(1.0), "{one} and {other}");
    }
}

fn turned() -> SO3 {
    SO3::exp(Vector3::new(0.3, -0.5, 0.2))
}

const SPIN: [f64; 3] = [0.7, -1.1, 4.0];

fn inertia() -> Matrix3<f64> {
    Matrix3::new(2.0, 0.1, -0.2, 0.1, 2.5, 0.3, -0.2, 0.3, 3.0)
}

#[test]
fn the_heavy_top() {
    let top = HeavyTop::asymmetric();
    let late: Late<SO3, Vector3<f64>, WithKinetic> = read(&top, &text!("HeavyTop" in "common/heavy_top/declaration"));
    same(&top, &late, (turned(), &SPIN));
    let J_d = NonstandardInertia::new(inertia()).expect("an inertia");
    let top = FullTop { J_d, m: 1.5, g: 9.81, rho: Vector3::new(0.1, -0.2, 0.4), up: Vector3::z() };
    let late: Late<SO3, Vector3<f64>, WithKinetic> = read(&top, &text!("FullTop" in "declarations/full_top"));
    same(&top, &late, (turned(), &SPIN));
}

/// Of these the denominators are cleared by another power, or not at all, and solves do without the Jacobian.
#[test]
fn tops_of_other_kinetic_terms() {
    let J = Inertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0)).expect("an inertia");
    let (weight, rho, up) = (9.81, Vector3::new(0.1, 0.0, 0.3), Vector3::z());
    let cayley = CayleyTop { J, weight, rho, up };
    same(
        &cayley,
        &read::<_, WithKinetic>(&cayley, &text!("CayleyTop" in "declarations/cayley_top")),
        (turned(), &SPIN),
    );
    let log = LogTop { J, weight, rho, up };
    same(&log, &read::<_, WithKinetic>(&log, &text!("LogTop" in "declarations/log_top")), (turned(), &SPIN));
    let fourth = FourthOrderTop { J, weight, rho, up };
    let text = text!("FourthOrderTop" in "declarations/fourth_order_top");
    same(&fourth, &read::<_, WithExpensiveKinetic>(&fourth, &text), (turned(), &SPIN));
    let sixth = SixthOrderTop { J, weight, rho, up };
    let text = text!("SixthOrderTop" in "declarations/sixth_order_top");
    same(&sixth, &read::<_, WithExpensiveKinetic>(&sixth, &text), (turned(), &SPIN));
    let top = HeavyTop::asymmetric();
    let continuous = ContinuousTop { J_d: top.J_d, m: top.m, g: top.g, rho: top.rho, up: top.up };
    let text = text!("ContinuousTop" in "declarations/continuous_top");
    same(&continuous, &read::<_, WithKinetic>(&continuous, &text), (turned(), &SPIN));
}

#[test]
fn other_groups() {
    let flow = ElasticFlow {
        M: Matrix2::new(2.0, 0.3, 0.3, 1.5),
        k: 3.0,
        metric: CovariantTensor(Matrix2::new(1.0, 0.0, 0.0, 1.0)),
    };
    let text = text!("ElasticFlow" in "declarations/elastic_flow");
    same::<_, Late<SL2, CovariantTensor<f64, 2>>>(&flow, &read(&flow, &text), (SL2::identity(), &[0.1, 0.2, -0.1]));
    let mut J = Matrix4::zeros();
    J.fixed_view_mut::<3, 3>(0, 0).copy_from(&(inertia() * 0.1));
    let M = Matrix4::from_diagonal(&Vector4::new(3.0, 4.0, 5.0, 0.0));
    let body = UnderwaterBody {
        J,
        M,
        origin: Point3::origin(),
        weight: Vector4::new(0.0, 0.1, -0.2, 0.3),
        height: Vector4::new(0.0, 0.0, 1.0, 0.0),
    };
    let text = text!("UnderwaterBody" in "declarations/underwater_body");
    let start = [0.3, -0.2, 0.5, 0.1, 0.2, -0.1];
    same::<_, Late<SE3, Vector4<f64>>>(&body, &read(&body, &text), (SE3::identity(), &start));
}

/// Terms of a sum, one of them read, one compiled.
#[test]
fn sums_with_compiled_effects() {
    let mut J = Matrix4::identity();
    J.fixed_view_mut::<3, 3>(0, 0).copy_from(&inertia());
    let (flyer, drag) = (Flyer { J }, FluidDrag { C: J * 0.05 });
    let late: Late<SE3> = read(&flyer, &text!("Flyer" in "declarations/flyer"));
    let late_drag: Late<SE3, (), WithoutKinetic> = read(&drag, &text!("FluidDrag" in "declarations/flyer"));
    let start = [0.3, -0.2, 0.5, 0.1, 0.2, -0.1];
    same(&(flyer + drag), &(late.clone() + drag), (SE3::identity(), &start));
    same(&(flyer + drag), &(late + late_drag), (SE3::identity(), &start));
}

/// What the bodies of the double pendulum see.
type Seen = (SeenFrom<0, Vector3<f64>>, SeenFrom<1, Vector3<f64>>, Relative<0, 1, Matrix3<f64>>);

#[test]
fn several_bodies() {
    let J_1 = NonstandardInertia::new(inertia()).expect("an inertia");
    let J_2 = NonstandardInertia::new(inertia() * 0.4).expect("an inertia");
    let (s_1, s_2) = (Vector3::new(0.1, 0.2, -0.9), Vector3::new(0.0, 0.1, -0.3));
    let pendulum = DoublePendulum { J_1, J_2, rho: Vector3::new(0.0, 0.1, -1.0), s_1, s_2, g: 9.81, up: Vector3::z() };
    let text = text!("DoublePendulum" in "declarations/double_pendulum");
    let late: Late<(SO3, SO3), Seen> = read(&pendulum, &text);
    same(&pendulum, &late, ((turned(), SO3::identity()), &[0.1, 0.3, -0.2, 0.4, 0.1, 0.2]));
    let top = TopOnCart { J_d: J_1, s: Vector3::new(0.1, 0.0, 0.4), M: 5.0, g: 9.81 };
    let late: Late<(SO3, R2), Configuration<0, Matrix3<f64>>> =
        read(&top, &text!("TopOnCart" in "declarations/top_on_cart"));
    same(&top, &late, ((turned(), R2::identity()), &[0.1, 0.3, 2.0, 0.1, -0.2]));
}
