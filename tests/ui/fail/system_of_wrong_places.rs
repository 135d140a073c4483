use liestep::groups::R3;
use liestep::lagrangian;
use liestep::mechanics::{Along, Between, Each, On, Pairs, Placement};

#[lagrangian(group(d = R3), l_d = m * d.norm_squared() / (2.0 * h))]
#[derive(Clone, Copy)]
struct Mass {
    m: f64,
}

// Potentials at the ends of a step and at its midpoint, and a coupling of velocities.
#[lagrangian(
    group(d_1 = R3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    l_d = -0.5 * h * k * (r.norm_squared() + (r + d_2 - d_1).norm_squared()),
)]
#[derive(Clone, Copy)]
struct Tied {
    k: f64,
}

#[lagrangian(
    group(d_1 = R3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    l_d = -0.5 * h * k * (r + 0.5 * (d_2 - d_1)).norm_squared(),
)]
#[derive(Clone, Copy)]
struct TiedInTheMiddle {
    k: f64,
}

#[lagrangian(group(d_1 = R3, d_2 = R3), l_d = m * d_1.dot(&d_2) / h)]
#[derive(Clone, Copy)]
struct Joined {
    m: f64,
}

const MASS: Mass = Mass { m: 1.0 };
const TIED: Tied = Tied { k: 1.0 };
const MIDDLE: TiedInTheMiddle = TiedInTheMiddle { k: 1.0 };

const NOBODY: Placement<Each<0>, Mass, 1> = Each::<0>::of([MASS]);
const TWO_OF_THREE: Placement<Each<3>, Mass, 2> = Each::<3>::of([MASS; 2]);
const BEHIND_THE_LAST: Placement<On<3, 3>, Mass, 1> = On::<3, 3>::of([MASS]);
const ALONE: Placement<Along<1>, Tied, 1> = Along::<1>::of([TIED]);
const WITH_ITSELF: Placement<Between<1, 1, 3>, Tied, 1> = Between::<1, 1, 3>::of([TIED]);
const BETWEEN_NOBODY: Placement<Between<0, 3, 3>, Tied, 1> = Between::<0, 3, 3>::of([TIED]);
const PAIRS_OF_NOBODY: Placement<Pairs<0>, Tied, 1> = Pairs::<0>::of([TIED]);
const IN_THE_MIDDLE_ALONG: Placement<Along<3>, TiedInTheMiddle, 1> = Along::<3>::of([MIDDLE]);
const IN_THE_MIDDLE_BETWEEN: Placement<Between<0, 2, 3>, TiedInTheMiddle, 1> = Between::<0, 2, 3>::of([MIDDLE]);
const VELOCITIES: Placement<Along<3>, Joined, 1> = Along::<3>::of([Joined { m: 1.0 }]);

fn main() {}
