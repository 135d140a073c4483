//! The rows of the table of hard cases as tests, with the bounds of
//! `cargo run -p liestep-hard-cases --example hard-cases`, which prints them beside other methods.

use cases::report::assert_met;
use cases::row::Effort;
use cases::rows;

macro_rules! rows {
    ($($name:ident $id:literal)+) => {
        $(
            #[test]
            fn $name() {
                assert_met($id, Effort { long: false, verdict_only: true });
            }
        )+

        /// Every row is a test, here or in `tests/long`.
        #[test]
        fn all_rows_are_tests() {
            let short: Vec<_> = rows::ALL.map(|row| row.0).into_iter().filter(|id| !rows::LONG.contains(id)).collect();
            assert_eq!(short, [$($id),+]);
        }
    };
}

rows! {
    s1_steps_up_to_the_fold "S1"
    s2_the_published_step_is_refused "S2"
    s3_a_guess_near_the_wrong_root "S3"
    s4_at_rest "S4"
    s6_kinetic_terms_without_a_step_limit "S6"
    b1_box "B1"
    b2_box_about_its_middle_axis_and_spun_fast "B2"
    b3_rods_and_plates "B3"
    b4_sphere "B4"
    b5_other_axes "B5"
    b6_what_is_no_inertia "B6"
    b7_flip_period "B7"
    b8_closed_forms "B8"
    t2_modified_energy "T2"
    t5_sleeping_top "T5"
    t6_past_the_vertical "T6"
    t8_no_gravity "T8"
    t9_other_units "T9"
    t10_euler_angles "T10"
    t11_nutation_and_precession "T11"
    t12_runge_kutta_loses_rigidity_and_its_path "T12"
    p1_poisson_structure "P1"
    p2_momentum_maps_and_casimirs "P2"
    p3_covectors "P3"
    p4_newtons_tolerance "P4"
    p5_two_flows "P5"
    p6_strong_damping "P6"
    p7_the_same_bytes "P7"
}
