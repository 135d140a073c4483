//! Dormand and Prince's method of order 8, unrolled for the seven numbers of a top, with its own step control.
//!
//! Coefficients, error estimate and controller are those of Hairer, Nørsett, Wanner, *Solving Ordinary Differential
//! Equations I*, 2nd edition, II.5 and II.10. There is no dense output. With a fixed step the error isn't estimated,
//! which saves what that costs.

// The digits are those of the source, whatever a double keeps of them.
#![allow(clippy::excessive_precision, clippy::unreadable_literal)]

use workbench::top_equations::State;

use super::rates::Rates;

/// Coefficients that aren't zero, each with the stage that it belongs to.
type Row<const N: usize> = [(usize, f64); N];

const A2: Row<1> = [(0, 5.26001519587677318785587544488e-2)];
const A3: Row<2> = [(0, 1.97250569845378994544595329183e-2), (1, 5.91751709536136983633785987549e-2)];
const A4: Row<2> = [(0, 2.95875854768068491816892993775e-2), (2, 8.87627564304205475450678981324e-2)];
const A5: Row<3> = [
    (0, 2.41365134159266685502369798665e-1),
    (2, -8.84549479328286085344864962717e-1),
    (3, 9.24834003261792003115737966543e-1),
];
const A6: Row<3> = [
    (0, 3.7037037037037037037037037037e-2),
    (3, 1.70828608729473871279604482173e-1),
    (4, 1.25467687566822425016691814123e-1),
];
const A7: Row<4> = [
    (0, 3.7109375e-2),
    (3, 1.70252211019544039314978060272e-1),
    (4, 6.02165389804559606850219397283e-2),
    (5, -1.7578125e-2),
];
const A8: Row<5> = [
    (0, 3.70920001185047927108779319836e-2),
    (3, 1.70383925712239993810214054705e-1),
    (4, 1.07262030446373284651809199168e-1),
    (5, -1.53194377486244017527936158236e-2),
    (6, 8.27378916381402288758473766002e-3),
];
const A9: Row<6> = [
    (0, 6.24110958716075717114429577812e-1),
    (3, -3.36089262944694129406857109825),
    (4, -8.68219346841726006818189891453e-1),
    (5, 2.75920996994467083049415600797e1),
    (6, 2.01540675504778934086186788979e1),
    (7, -4.34898841810699588477366255144e1),
];
const A10: Row<7> = [
    (0, 4.77662536438264365890433908527e-1),
    (3, -2.48811461997166764192642586468),
    (4, -5.90290826836842996371446475743e-1),
    (5, 2.12300514481811942347288949897e1),
    (6, 1.52792336328824235832596922938e1),
    (7, -3.32882109689848629194453265587e1),
    (8, -2.03312017085086261358222928593e-2),
];
const A11: Row<8> = [
    (0, -9.3714243008598732571704021658e-1),
    (3, 5.18637242884406370830023853209),
    (4, 1.09143734899672957818500254654),
    (5, -8.14978701074692612513997267357),
    (6, -1.85200656599969598641566180701e1),
    (7, 2.27394870993505042818970056734e1),
    (8, 2.49360555267965238987089396762),
    (9, -3.0467644718982195003823669022),
];
const A12: Row<9> = [
    (0, 2.27331014751653820792359768449),
    (3, -1.05344954667372501984066689879e1),
    (4, -2.00087205822486249909675718444),
    (5, -1.79589318631187989172765950534e1),
    (6, 2.79488845294199600508499808837e1),
    (7, -2.85899827713502369474065508674),
    (8, -8.87285693353062954433549289258),
    (9, 1.23605671757943030647266201528e1),
    (10, 6.43392746015763530355970484046e-1),
];
const B: Row<8> = [
    (0, 5.42937341165687622380535766363e-2),
    (5, 4.45031289275240888144113950566),
    (6, 1.89151789931450038304281599044),
    (7, -5.8012039600105847814672114227),
    (8, 3.1116436695781989440891606237e-1),
    (9, -1.52160949662516078556178806805e-1),
    (10, 2.01365400804030348374776537501e-1),
    (11, 4.47106157277725905176885569043e-2),
];
const ERROR_5: Row<8> = [
    (0, 0.1312004499419488073250102996e-1),
    (5, -0.1225156446376204440720569753e1),
    (6, -0.4957589496572501915214079952),
    (7, 0.1664377182454986536961530415e1),
    (8, -0.3503288487499736816886487290),
    (9, 0.3341791187130174790297318841),
    (10, 0.8192320648511571246570742613e-1),
    (11, -0.2235530786388629525884427845e-1),
];
/// What the estimate of order 3 has beside the weights of the step itself.
const ERROR_3: Row<3> = [
    (0, -0.244094488188976377952755905512),
    (8, -0.733846688281611857341361741547),
    (11, -0.220588235294117647058823529412e-1),
];

#[inline(always)]
fn combination<const N: usize>(k: &[State; 12], row: &Row<N>) -> State {
    core::array::from_fn(|i| {
        let (first, factor) = row[0];
        row[1..].iter().fold(factor * k[first][i], |sum, &(stage, factor)| sum + factor * k[stage][i])
    })
}

#[inline(always)]
fn plus(y: &State, h: f64, change: &State) -> State {
    core::array::from_fn(|i| y[i] + h * change[i])
}

/// The twelve stages from `y`, of which `first` is the first, and the step's mean rate.
#[inline(always)]
fn stages(equations: &impl Rates, h: f64, y: &State, first: State) -> ([State; 12], State) {
    let mut k = [[0.0; 7]; 12];
    k[0] = first;
    macro_rules! stage {
        ($($place:literal $row:ident)+) => {$(
            k[$place] = equations.rate(&plus(y, h, &combination(&k, &$row)));
        )+};
    }
    stage!(1 A2 2 A3 3 A4 4 A5 5 A6 6 A7 7 A8 8 A9 9 A10 10 A11 11 A12);
    let mean = combination(&k, &B);
    (k, mean)
}

/// One step of fixed length.
#[inline]
pub fn step(equations: &impl Rates, h: f64, y: &State) -> State {
    let (_, mean) = stages(equations, h, y, equations.rate(y));
    plus(y, h, &mean)
}

/// From `y` over the time `t` with the method's own step control; `None` where it gives up.
///
/// The tolerance is relative and absolute at once, as all seven numbers are of the order of one or of the momentum.
pub fn integrate(equations: &impl Rates, t: f64, tolerance: f64, mut y: State) -> Option<State> {
    let mut rate = equations.rate(&y);
    let (mut done, mut h) = (0.0, initial_step(equations, &y, &rate, tolerance).min(t));
    let mut rejected = false;
    for _ in 0..MOST_STEPS {
        let last = done + 1.01 * h >= t;
        if last {
            h = t - done;
        }
        let (k, mean) = stages(equations, h, &y, rate);
        let next = plus(&y, h, &mean);
        let error = error(h, &y, &next, &k, &mean, tolerance);
        let wanted = h / (error.powf(1.0 / 8.0) / SAFETY).clamp(1.0 / LARGEST_GROWTH, 1.0 / SMALLEST_GROWTH);
        if error <= 1.0 {
            done += h;
            y = next;
            if last {
                return Some(y);
            }
            rate = equations.rate(&y);
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

/// Far more than any of the scenes takes.
const MOST_STEPS: u32 = 10_000_000;
const SAFETY: f64 = 0.9;
const SMALLEST_GROWTH: f64 = 0.333;
const LARGEST_GROWTH: f64 = 6.0;

/// The combined estimate of orders 5 and 3, in units of the tolerance.
#[inline(always)]
fn error(h: f64, y: &State, next: &State, k: &[State; 12], mean: &State, tolerance: f64) -> f64 {
    let (fifth, third) = (combination(k, &ERROR_5), plus(mean, 1.0, &combination(k, &ERROR_3)));
    let (mut five, mut three) = (0.0, 0.0);
    for i in 0..7 {
        let scale = tolerance * (1.0 + y[i].abs().max(next[i].abs()));
        five += (fifth[i] / scale).powi(2);
        three += (third[i] / scale).powi(2);
    }
    let denominator = five + 0.01 * three;
    if denominator > 0.0 { h * five / (7.0 * denominator).sqrt() } else { 0.0 }
}

/// A step for which an explicit Euler step would change the rate little.
fn initial_step(equations: &impl Rates, y: &State, rate: &State, tolerance: f64) -> f64 {
    let norm = |v: &State| {
        let sum: f64 = (0..7).map(|i| (v[i] / (tolerance * (1.0 + y[i].abs()))).powi(2)).sum();
        (sum / 7.0).sqrt()
    };
    let first = 0.01 * norm(y) / norm(rate);
    let later = equations.rate(&plus(y, first, rate));
    let second = norm(&plus(&later, -1.0, rate)) / first;
    (0.01 / norm(rate).max(second)).powf(1.0 / 8.0).min(100.0 * first)
}
