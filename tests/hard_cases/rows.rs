//! The rows of the table: what is measured and every bound are those of `cargo run --example hard-cases`, which prints
//! them beside what other methods do.

use cases::row::Effort;
use cases::{report, rows};

fn assert_met(id: &str, effort: Effort) {
    let (_, measure) = rows::ALL.into_iter().find(|row| row.0 == id).unwrap();
    let row = measure(effort).unwrap_or_else(|failure| panic!("{id}: {failure}"));
    let (is_met, text) = (row.is_met, report::text(&[row]));
    println!("{text}");
    assert!(is_met, "{text}");
}

macro_rules! rows {
    ($($name:ident $id:literal)+) => {
        $(
            #[test]
            fn $name() {
                assert_met($id, Effort { long: false, verdict_only: true });
            }
        )+

        /// None is left out.
        #[test]
        fn all_rows_are_tests() {
            assert_eq!(rows::ALL.map(|row| row.0).as_slice(), &[$($id),+]);
        }
    };
}

rows! {
    s1_steps_up_to_the_fold "S1"
    s2_the_published_step_is_refused "S2"
    s3_a_guess_near_the_wrong_root "S3"
    s4_at_rest "S4"
    s5_there_and_back "S5"
    s6_kinetic_terms_without_a_step_limit "S6"
    b1_box "B1"
    b2_box_about_its_middle_axis_and_spun_fast "B2"
    b3_rods_and_plates "B3"
    b4_sphere "B4"
    b5_other_axes "B5"
    b6_what_is_no_inertia "B6"
    b7_flip_period "B7"
    b8_closed_forms "B8"
    t1_orders_of_the_tops_of_the_thesis "T1"
    t2_modified_energy "T2"
    t3_ten_million_steps "T3"
    t4_a_million_steps_of_ten_nanoseconds "T4"
    t5_sleeping_top "T5"
    t6_past_the_vertical "T6"
    t7_chaos "T7"
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
    p8_single_precision "P8"
    r1_compositions "R1"
    r2_splittings "R2"
    r3_steady_turns "R3"
    r4_steady_turns_of_a_sphere "R4"
}

#[test]
#[ignore = "a hundred million steps"]
fn t3_a_hundred_million_steps() {
    assert_met("T3", Effort { long: true, verdict_only: true });
}

#[test]
#[ignore = "thirty million steps"]
fn t7_thirty_million_steps() {
    assert_met("T7", Effort { long: true, verdict_only: true });
}
