//! Four bodies in a row, neighbours coupled by `κ (3 − tr Q)`: each step solves every body for itself.

use declarations::motions::{matrix, number, read, vector};
use liestep::groups::{CayleyRetraction, LieGroup, Relative};
use liestep::mechanics::{Effect, Limit, Parts, SceneVisitor, Term, WithKinetic};
use liestep::numbers::Blocks;
use liestep::{SO3, SetupError, Stepper};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::{End, all, apart, attitudes_of, momentum, part, put, stacked, twice_vee};

type Group = (SO3, SO3, SO3, SO3);
type Matrices = <Group as LieGroup>::Matrix;
type Components = SVector<f64, 12>;
type Square = SMatrix<f64, 12, 12>;
type Between<const A: usize, const B: usize> = Relative<A, B, Matrix3<f64>>;
/// A motion of the reference, with where it is later.
type Started = (Stepper<Row>, liestep::State<Group, Seen>, Vec<End>);
type Seen = (Between<0, 1>, Between<1, 2>, Between<2, 3>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    /// Moments of inertia.
    J: [Vector3<f64>; 4],
    kappa: f64,
}

impl Row {
    fn read() -> Self {
        let data = &read("several bodies")["coupled_attitudes4"]["parameters"];
        let plain = |value: &serde_json::Value| Vector3::from_fn(|k, _| value[k].as_f64().unwrap());
        Self { J: [0, 1, 2, 3].map(|a| plain(&data["J"][a])), kappa: data["kappa"].as_f64().unwrap() }
    }

    fn kick(&self, w: &Seen, half_step: f64) -> Components {
        let mut kick = [Vector3::zeros(); 4];
        for (a, q) in [w.0.0, w.1.0, w.2.0].iter().enumerate() {
            let torque = twice_vee(q) * (half_step * self.kappa);
            kick[a] += torque;
            kick[a + 1] -= torque;
        }
        stacked(&kick)
    }
}

impl Term for Row {
    type Scalar = f64;
    type Group = Group;
    type Advected = Seen;

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn advected(&self) -> Seen {
        Seen::default()
    }
}

impl Effect for Row {
    type Retraction = CayleyRetraction;
    type Kinetic = WithKinetic;
    type Constants = (Self, f64);
    type StepTerms = Components;

    const PARTS: Parts = Parts::ALL;
    const INERTIA_IS_CONSTANT: bool = true;
    const IS_QUADRATIC: bool = true;
    const APART: Blocks = <Group as LieGroup>::FACTORS;
    const DERIVATION: &'static str = "four coupled attitudes, by hand";

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term(Self::DERIVATION);
        visitor.parameter("kappa", self.kappa);
    }

    fn momentum_jacobian(&self, f: &Matrices, _: &Seen, h: f64) -> Square {
        let mut jacobian = Square::zeros();
        for (a, f) in [f.0, f.1, f.2, f.3].iter().enumerate() {
            let moments = self.J[a];
            let p = f * (Matrix3::from_diagonal_element(0.5 * moments.sum()) - Matrix3::from_diagonal(&moments)) / h;
            put(&mut jacobian, (a, a), &(Matrix3::from_diagonal_element(p.trace()) - p));
        }
        jacobian
    }

    fn limit(&self, velocity: Option<&Components>, w: &Seen) -> Limit<Self> {
        let potential: f64 = [w.0.0, w.1.0, w.2.0].iter().map(|q| self.kappa * (3.0 - q.trace())).sum();
        Limit::quadratic(velocity, Square::from_diagonal(&stacked(&self.J)), Components::zeros(), potential)
    }

    fn constants(&self, h: f64) -> (Self, f64) {
        (*self, 0.5 * h)
    }

    fn kick_before((row, half_step): &(Self, f64), w: &Seen) -> Components {
        row.kick(w, *half_step)
    }

    fn step_terms((_, half_step): &(Self, f64), a: &Components, _: &Seen) -> Components {
        a * *half_step
    }

    /// (3.13) of each body, in Cayley coordinates, with its denominator.
    fn newton_system((row, _): &(Self, f64), target: &Components, half: &Components) -> (Components, Square) {
        let (mut residual, mut jacobian) = (Components::zeros(), Square::zeros());
        for a in 0..4 {
            let (y, J) = (part(half, a), Matrix3::from_diagonal(&row.J[a]));
            let (jy, scale) = (J * y, 1.0 / (1.0 + y.norm_squared()));
            let value = (jy + y.cross(&jy)) * scale;
            residual.fixed_rows_mut::<3>(3 * a).copy_from(&(value - part(target, a)));
            let slope = (J + y.cross_matrix() * J - jy.cross_matrix()) * scale;
            put(&mut jacobian, (a, a), &(slope - value * y.transpose() * (2.0 * scale)));
        }
        (residual, jacobian)
    }

    fn kick_after((row, half_step): &(Self, f64), _: &Matrices, next: &Seen) -> Components {
        row.kick(next, *half_step)
    }
}

fn started(h: f64) -> Started {
    let states = &read("several bodies")["coupled_attitudes4"]["states"];
    let (start, end) = (&states[0]["bodies"], &states[1]["bodies"]);
    let attitudes = all(start, |body| SO3::try_from(matrix(&body["R"])).unwrap());
    let velocity = stacked(&all(start, |body| vector(&body["Omega_body"])));
    let stepper = Stepper::new(Row::read(), h).unwrap();
    let state = stepper.start((attitudes[0], attitudes[1], attitudes[2], attitudes[3]), velocity).unwrap();
    (stepper, state, all(end, |body| (matrix(&body["R"]), vector(&body["Omega_body"]))))
}

fn whole_momentum(state: &liestep::State<Group, Seen>) -> Vector3<f64> {
    let spatial = state.spatial_momentum();
    (0..4).map(|body| part(&spatial, body)).sum()
}

#[test]
fn golden_step() {
    let golden = &read("several bodies")["golden steps"]["coupled_attitudes4"];
    let stepper = Stepper::new(Row::read(), number(&golden["h"])).unwrap();
    let start = attitudes_of(&golden["R0"]);
    let attitude = (start[0], start[1], start[2], start[3]);
    let mut state = stepper.start_with_momentum(attitude, momentum(&golden["mu0"])).unwrap();
    stepper.step(&mut state).unwrap();
    let (end, expected): (_, Components) = (state.attitude(), momentum(&golden["mu1"]));
    let errors = [
        apart(&[end.0, end.1, end.2, end.3], &attitudes_of(&golden["R1"])),
        (state.momentum() - expected).norm() / expected.norm(),
    ];
    println!("{errors:?}");
    assert!(errors.iter().all(|&error| error < 1e-14), "{errors:?}");
}

/// The whole momentum in space is exact, whatever the step; so is the order.
#[test]
fn trajectory() {
    let errors = [(0.02, 100), (0.01, 200), (0.005, 400)].map(|(h, steps)| {
        let (stepper, mut state, end) = started(h);
        let (before, energy) = (whole_momentum(&state), stepper.energy(&state));
        stepper.run(&mut state, steps).unwrap();
        assert!((whole_momentum(&state) - before).norm() < 1e-12);
        assert!((stepper.energy(&state) - energy).abs() < 1e-3);
        (state.attitude().3.as_matrix() - end[3].0).norm() + (part(&stepper.velocity(&state), 1) - end[1].1).norm()
    });
    println!("{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.02, "{order}");
    }
}
