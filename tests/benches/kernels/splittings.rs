//! The time for ten seconds of a symmetric top by splittings in lanes on one core, beside a Taylor integrator's
//! batches.

use std::io::Write as _;
use std::process::{Command, Stdio};
use std::time::Instant;

use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia, Sum};
use liestep::methods::{ProcessedScheme, ProcessedSplitting, Splitting, SplittingScheme, SymmetricBody};
use liestep::motion::{Batch, Batchable, Integrator, Plan};
use liestep::{StateOf, Stepper};
use liestep_refinement::{Measurement, Refinement};
use nalgebra::{UnitQuaternion, Vector3};
use simba::simd::AutoF64x8;

use crate::kernel::Failure;

type Scene = Sum<PrincipalBody, Gravity>;
/// A stepper and its initial state.
type Top<P> = (Stepper<Scene, P>, StateOf<Scene, P>);

const TOPS: u32 = 64;
const LANES: usize = 8;
const TIME: f64 = 10.0; // s
const ERRORS: [f64; 2] = [1e-6, 1e-8];
/// The number of measurements, of which the fastest counts.
const TURNS: usize = 2;
const REPEATED: usize = 30;
const STEPS: [u32; 16] = [16, 20, 25, 32, 40, 50, 64, 80, 100, 128, 160, 200, 256, 320, 400, 512];
const SCHEMES: [SplittingScheme; 6] = [
    SplittingScheme::FORCE_GRADIENT_2,
    SplittingScheme::FORCE_GRADIENT_4,
    SplittingScheme::FORCE_GRADIENT_5,
    SplittingScheme::NYSTROM_6,
    SplittingScheme::NYSTROM_11,
    SplittingScheme::NYSTROM_14,
];

/// Moments, centre of mass, attitude and velocity of a top; the numbers are spread evenly.
struct Body {
    moments: Vector3<f64>,
    rho: f64,
    attitude: UnitQuaternion<f64>,
    velocity: Vector3<f64>,
}

fn body(number: u32) -> Body {
    // Powers of the golden ratio spread the numbers.
    let part = |k: i32| (f64::from(number + 1) * 0.618_033_988_749_894_9_f64.powi(k)).fract();
    let transverse = 2.5 + part(1);
    Body {
        moments: Vector3::new(transverse, transverse, 3.5 + part(2)),
        rho: 0.8 + 0.4 * part(3),
        attitude: UnitQuaternion::from_scaled_axis(Vector3::new(0.2 + 0.8 * part(4), 0.1, 0.0)),
        velocity: Vector3::new(0.5, 0.2, 5.0 + 5.0 * part(5)),
    }
}

impl Body {
    fn scene(&self) -> Result<Scene, Failure> {
        let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_principal_moments(self.moments)? };
        Ok(body + Gravity { m: 1.0, g: 9.81, rho: Vector3::z() * self.rho, up: Vector3::z() })
    }

    fn started<P: Plan<Scene>>(&self, stepper: Stepper<Scene, P>) -> Result<Top<P>, Failure> {
        let state = stepper.start(self.attitude, self.velocity)?;
        Ok((stepper, state))
    }

    fn flow(&self) -> Result<SymmetricBody, Failure> {
        Ok(SymmetricBody::new(&Inertia::from_principal_moments(self.moments)?)?)
    }
}

/// The vertical and the velocity in the body frame.
type End = [Vector3<f64>; 2];

/// The ends of all tops, run in lanes, and the time for a top, s.
fn ends<P: Plan<Scene>>(
    top: &impl Fn(&Body, f64) -> Result<Top<P>, Failure>,
    steps: u32,
    repeated: usize,
) -> Result<(Vec<End>, f64), Failure>
where
    Stepper<Scene, P>: Batchable<AutoF64x8> + Integrator<State = StateOf<Scene, P>>,
{
    let tops = (0..TOPS).map(|number| top(&body(number), TIME / f64::from(steps))).collect::<Result<Vec<_>, _>>()?;
    let (mut ends, mut time) = (Vec::new(), 0.0);
    for eight in tops.chunks(LANES) {
        let mut fastest = f64::INFINITY;
        for turn in 0..repeated {
            let mut batch = Batch::<AutoF64x8, _>::new(eight)?;
            let start = Instant::now();
            batch.run(u64::from(steps));
            fastest = fastest.min(start.elapsed().as_secs_f64());
            if turn == 0 {
                for (number, (stepper, _)) in eight.iter().enumerate() {
                    let state = batch.state(number);
                    ends.push([state.advected().1, stepper.velocity(&state)]);
                }
            }
        }
        time += fastest;
    }
    Ok((ends, time / f64::from(TOPS)))
}

/// The tops of a splitting.
fn split(scheme: SplittingScheme) -> impl Fn(&Body, f64) -> Result<Top<Splitting<Scene, SymmetricBody>>, Failure> {
    move |body, h| body.started(Stepper::split(body.scene()?, h, body.flow()?, scheme)?)
}

/// The tops of a splitting with a processor.
fn processed(
    scheme: ProcessedScheme,
) -> impl Fn(&Body, f64) -> Result<Top<ProcessedSplitting<Scene, SymmetricBody>>, Failure> {
    move |body, h| body.started(Stepper::processed(body.scene()?, h, body.flow()?, scheme)?)
}

fn error(ends: &[End], exact: &[End]) -> f64 {
    let squares = ends.iter().zip(exact).map(|([w, velocity], [exact_w, exact_velocity])| {
        (w - exact_w).norm_squared() + (velocity - exact_velocity).norm_squared() / exact_velocity.norm_squared()
    });
    (squares.sum::<f64>() / f64::from(TOPS)).sqrt()
}

/// Replaces the best costs, µs a top, by those of this scheme if they are lower.
fn compare<P: Plan<Scene>>(
    (name, top): (&'static str, impl Fn(&Body, f64) -> Result<Top<P>, Failure>),
    exact: &[End],
    best: &mut [(f64, &'static str); 2],
) -> Result<(), Failure>
where
    Stepper<Scene, P>: Batchable<AutoF64x8> + Integrator<State = StateOf<Scene, P>>,
{
    let run = |steps| -> Result<_, Failure> {
        let (ends, time) = ends(&top, steps, REPEATED)?;
        let (step, error) = (TIME / f64::from(steps), error(&ends, exact));
        Ok(Measurement { step, error, iterations: None, seconds: Some(time * 1e6) })
    };
    let runs = STEPS.into_iter().map(run).collect::<Result<Refinement, _>>()?;
    for (best, wanted) in best.iter_mut().zip(ERRORS) {
        if let Some(cost) = runs.seconds_to(wanted).filter(|cost| *cost < best.0) {
            *best = (cost, name);
        }
    }
    Ok(())
}

/// The times by `with_heyoka.py`, if Python has heyoka.
fn theirs(exact: &[End]) -> Result<Option<[f64; 2]>, Failure> {
    let mut python = Command::new("python3");
    python.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/with_heyoka.py"));
    // Without Python there is no heyoka either.
    let Ok(mut child) = python.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn() else { return Ok(None) };
    let mut lines = String::new();
    for (number, [w, velocity]) in (0..TOPS).zip(exact) {
        let Body { moments, rho, attitude, velocity: start } = body(number);
        let q = attitude.quaternion();
        let momentum = moments.component_mul(&start);
        let numbers =
            [[q.w, q.i, q.j, q.k].as_slice(), momentum.as_slice(), w.as_slice(), velocity.as_slice()].concat();
        let numbers = [moments.x, moments.z, 9.81 * rho].into_iter().chain(numbers);
        lines += &numbers.map(|number| format!("{number:e}")).collect::<Vec<_>>().join(" ");
        lines += "\n";
    }
    // A program that ends early prints its own reason.
    let _ = child.stdin.take().ok_or("no pipe")?.write_all(lines.as_bytes());
    let answer = String::from_utf8(child.wait_with_output()?.stdout)?;
    let costs: Vec<f64> = answer.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    Ok(costs.try_into().ok())
}

pub(crate) fn splittings() -> Result<(), Failure> {
    const FINE: u32 = 2_000;
    let fine = split(SplittingScheme::NYSTROM_14);
    let (exact, _) = ends(&fine, FINE, 1)?;
    let (finer, _) = ends(&fine, 2 * FINE, 1)?;
    println!(
        "{TOPS} symmetric tops, {TIME} s, one core; what they are compared with is off by {:.0e}",
        error(&exact, &finer)
    );
    let (mut own, mut others) = ([(f64::INFINITY, ""); 2], [f64::INFINITY; 2]);
    for _ in 0..TURNS {
        for scheme in SCHEMES {
            compare((scheme.name(), split(scheme)), &exact, &mut own)?;
        }
        for scheme in ProcessedScheme::ALL {
            compare((scheme.name(), processed(scheme)), &exact, &mut own)?;
        }
        if let Some(found) = theirs(&exact)? {
            others.iter_mut().zip(found).for_each(|(other, found)| *other = other.min(found));
        }
    }
    for ((wanted, (time, scheme)), other) in ERRORS.into_iter().zip(own).zip(others) {
        print!("to {wanted:e}: {time:.2} µs a top in lanes ({scheme})");
        if other.is_finite() {
            print!(", {other:.2} µs by heyoka in batches of four, {:.2} of it", time / other);
        }
        println!();
    }
    if others.iter().all(|other| other.is_infinite()) {
        println!("heyoka is left out: python3 has no answer of it");
    }
    Ok(())
}
