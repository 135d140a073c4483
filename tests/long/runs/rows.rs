//! The rows of the table of hard cases that take more than a second, with the bounds of
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

        /// Every row is a test, here or in `tests/hard_cases`.
        #[test]
        fn all_rows_are_tests() {
            assert_eq!(rows::LONG, [$($id),+]);
        }
    };
}

rows! {
    s5_there_and_back "S5"
    t1_orders_of_the_tops_of_the_thesis "T1"
    t3_ten_million_steps "T3"
    t4_a_million_steps_of_ten_nanoseconds "T4"
    t7_chaos "T7"
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
