//! The laws of groups, retractions and advected parameters, for all groups of the crate.

macro_rules! laws {
    ($($module:ident: $group:ty;)+) => {$(
        mod $module {
            liestep::lie_group_laws!($group);
            liestep::advected_laws!($group);

            mod cayley {
                liestep::retraction_laws!($group, liestep::groups::CayleyRetraction);
            }

            mod exponential {
                liestep::retraction_laws!($group, liestep::groups::ExponentialRetraction);
            }
        }
    )+};
}

laws! {
    so2: liestep::groups::SO2;
    so3: liestep::SO3;
    se2: liestep::groups::SE2;
    se3: liestep::groups::SE3;
    se23: liestep::groups::SE23;
    su2: liestep::groups::SU2;
    sl2: liestep::groups::SL2;
    heisenberg: liestep::groups::Heisenberg;
    r1: liestep::groups::R1;
    r2: liestep::groups::R2;
    r3: liestep::groups::R3;
}
