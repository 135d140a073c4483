//! Embedded explicit Runge–Kutta methods, unrolled for the seven numbers of a top.
//!
//! There is no dense output. With a fixed step the error isn't estimated, which saves that cost. The controller and the
//! first step are those of Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, 2nd edition, II.4: the
//! length of a step depends only on the error of the one before. All methods have the default constants of these
//! authors' program DOP853.

use workbench::top_equations::State;

use super::rates::Rates;

/// The coefficients that aren't zero, each with its stage.
pub type Row<const N: usize> = [(usize, f64); N];

/// An embedded method, by its coefficients.
pub trait EmbeddedMethod: 'static {
    const NAME: &'static str;
    /// The power of the step by which the estimated error falls.
    const POWER: i32;
    /// The rates at the stages of a step and of its estimate.
    type Stages: Copy;

    /// The stages of the step from `y`, with the first stage `first`; the estimate's further stages are zero.
    fn stages(equations: &impl Rates, h: f64, y: &State, first: State) -> Self::Stages;

    /// The mean rate over the step.
    fn mean(k: &Self::Stages) -> State;

    /// The further stages of the estimate, after a step to `next`. Returns the rate at `next` if it is one of them.
    fn complete(equations: &impl Rates, h: f64, y: &State, next: &State, k: &mut Self::Stages) -> Option<State>;

    /// The error of the step relative to the step, in units of these scales.
    fn error(k: &Self::Stages, mean: &State, scales: &State) -> f64;
}

#[inline(always)]
pub fn combination<const N: usize, const STAGES: usize>(k: &[State; STAGES], row: &Row<N>) -> State {
    core::array::from_fn(|i| {
        let (first, factor) = row[0];
        row[1..].iter().fold(factor * k[first][i], |sum, &(stage, factor)| sum + factor * k[stage][i])
    })
}

#[inline(always)]
pub fn plus(y: &State, h: f64, change: &State) -> State {
    core::array::from_fn(|i| y[i] + h * change[i])
}

/// The mean square in units of scales.
#[inline(always)]
pub fn mean_square(values: &State, scales: &State) -> f64 {
    (0..7).map(|i| (values[i] / scales[i]).powi(2)).sum::<f64>() / 7.0
}

/// Computes stages by their rows, each with its number.
macro_rules! stages {
    ($k:ident, $equations:ident, $h:ident, $y:ident: $($place:literal $row:ident)+) => {$(
        $k[$place] = $equations.rate(&plus($y, $h, &combination(&$k, &$row)));
    )+};
}
pub(super) use stages;

/// One step of fixed length.
#[inline]
pub fn step<M: EmbeddedMethod>(equations: &impl Rates, h: f64, y: &State) -> State {
    plus(y, h, &M::mean(&M::stages(equations, h, y, equations.rate(y))))
}

/// Integrates from `y` over the time `t` with the method's own step control; `None` if it fails.
///
/// The tolerance is relative and absolute at once, as all seven numbers are of the order of one or of the momentum.
pub fn integrate<M: EmbeddedMethod>(equations: &impl Rates, t: f64, tolerance: f64, mut y: State) -> Option<State> {
    let power = f64::from(M::POWER).recip();
    let mut rate = equations.rate(&y);
    let (mut done, mut h) = (0.0, initial_step(equations, &y, &rate, tolerance, power).min(t));
    let mut rejected = false;
    for _ in 0..MOST_STEPS {
        let last = done + 1.01 * h >= t;
        if last {
            h = t - done;
        }
        let mut k = M::stages(equations, h, &y, rate);
        let mean = M::mean(&k);
        let next = plus(&y, h, &mean);
        let end = M::complete(equations, h, &y, &next, &mut k);
        let scales = core::array::from_fn(|i| tolerance * (1.0 + y[i].abs().max(next[i].abs())));
        let error = h * M::error(&k, &mean, &scales);
        let wanted = h / (error.powf(power) / SAFETY).clamp(1.0 / LARGEST_GROWTH, 1.0 / SMALLEST_GROWTH);
        if error <= 1.0 {
            done += h;
            y = next;
            if last {
                return Some(y);
            }
            rate = end.unwrap_or_else(|| equations.rate(&y));
            // After a rejection the step isn't lengthened at once.
            h = if rejected { wanted.min(h) } else { wanted };
            rejected = false;
        } else if error.is_finite() {
            h = wanted.min(h);
            rejected = true;
        } else {
            return None;
        }
    }
    None
}

/// Far more steps than any of the scenes takes.
const MOST_STEPS: u32 = 10_000_000;
const SAFETY: f64 = 0.9;
const SMALLEST_GROWTH: f64 = 0.333;
const LARGEST_GROWTH: f64 = 6.0;

/// A step for which an explicit Euler step would change the rate little.
fn initial_step(equations: &impl Rates, y: &State, rate: &State, tolerance: f64, power: f64) -> f64 {
    let scales = y.map(|y| tolerance * (1.0 + y.abs()));
    let norm = |v: &State| mean_square(v, &scales).sqrt();
    let first = 0.01 * norm(y) / norm(rate);
    let later = equations.rate(&plus(y, first, rate));
    let second = norm(&plus(&later, -1.0, rate)) / first;
    (0.01 / norm(rate).max(second)).powf(power).min(100.0 * first)
}
