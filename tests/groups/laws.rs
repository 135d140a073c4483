//! The laws of groups, retractions and advected parameters, for all groups of the crate.

macro_rules! laws {
    ($($module:ident: $group:ty;)+) => {$(
        mod $module {
            liestep::lie_group_laws!($group);
            liestep::advected_laws!($group);

            mod cayley {
                liestep::retraction_laws!($group, liestep::CayleyRetraction);
            }

            mod exponential {
                liestep::retraction_laws!($group, liestep::ExponentialRetraction);
            }
        }
    )+};
}

laws! {
    so2: liestep::SO2;
    so3: liestep::SO3;
    se2: liestep::SE2;
    se3: liestep::SE3;
    su2: liestep::SU2;
    sl2: liestep::SL2;
    heisenberg: liestep::Heisenberg;
    r1: liestep::R1;
    r2: liestep::R2;
    r3: liestep::R3;
}
