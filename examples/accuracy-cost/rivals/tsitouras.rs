//! Tsitouras' method of order 5 with an estimate of order 4.
//!
//! Coefficients are those of Ch. Tsitouras, *Runge–Kutta pairs of order 5(4) satisfying only the first column simplifying
//! assumption*, Comput. Math. Appl. 62 (2011); `accuracy-cost.csv` has the order of each run.

// Coefficients have the digits of the source, although a double has fewer.
#![allow(clippy::excessive_precision, clippy::unreadable_literal)]

use workbench::top_equations::State;

use super::embedded::{EmbeddedMethod, Row, combination, mean_square, plus, stages};
use super::rates::Rates;

pub struct Tsitouras5;

impl EmbeddedMethod for Tsitouras5 {
    const NAME: &'static str = "Tsitouras 5";
    const POWER: i32 = 5;
    type Stages = [State; 7];

    #[inline(always)]
    fn stages(equations: &impl Rates, h: f64, y: &State, first: State) -> [State; 7] {
        let mut k = [[0.0; 7]; 7];
        k[0] = first;
        stages!(k, equations, h, y: 1 A2 2 A3 3 A4 4 A5 5 A6);
        k
    }

    #[inline(always)]
    fn mean(k: &[State; 7]) -> State {
        combination(k, &B)
    }

    /// The last stage is the first of the next step.
    #[inline(always)]
    fn complete(equations: &impl Rates, _: f64, _: &State, next: &State, k: &mut [State; 7]) -> Option<State> {
        k[6] = equations.rate(next);
        Some(k[6])
    }

    #[inline(always)]
    fn error(k: &[State; 7], _: &State, scales: &State) -> f64 {
        mean_square(&combination(k, &ERROR), scales).sqrt()
    }
}

const A2: Row<1> = [(0, 0.161)];
const A3: Row<2> = [(0, -0.008480655492356989), (1, 0.335480655492357)];
const A4: Row<3> = [(0, 2.8971530571054935), (1, -6.359448489975075), (2, 4.3622954328695815)];
const A5: Row<4> =
    [(0, 5.325864828439257), (1, -11.748883564062828), (2, 7.4955393428898365), (3, -0.09249506636175525)];
const A6: Row<5> = [
    (0, 5.86145544294642),
    (1, -12.92096931784711),
    (2, 8.159367898576159),
    (3, -0.071584973281401),
    (4, -0.028269050394068383),
];
const B: Row<6> = [
    (0, 0.09646076681806523),
    (1, 0.01),
    (2, 0.4798896504144996),
    (3, 1.379008574103742),
    (4, -3.290069515436081),
    (5, 2.324710524099774),
];
/// The weights of order 4 minus those of the step.
const ERROR: Row<7> = [
    (0, -0.00178001105222577714),
    (1, -0.0008164344596567469),
    (2, 0.007880878010261995),
    (3, -0.1447110071732629),
    (4, 0.5823571654525552),
    (5, -0.45808210592918697),
    (6, 1.0 / 66.0),
];
