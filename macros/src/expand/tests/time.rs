//! An expansion must not be felt.

use std::time::{Duration, Instant};

use super::higher_order::sixth;
use super::{HEAVY_TOP, expanded, top};

/// The time of some expansions, the quickest first, as the others measure what else the machine was doing.
fn times(count: usize, arguments: &str, item: &str) -> Vec<Duration> {
    let mut times: Vec<Duration> = (0..count)
        .map(|_| {
            let start = Instant::now();
            drop(expanded(arguments, item));
            start.elapsed()
        })
        .collect();
    times.sort();
    println!("median {:?}", times[count / 2]);
    times
}

#[test]
fn the_heavy_top_expands_quickly() {
    let times = times(50, HEAVY_TOP, &top("NonstandardInertia"));
    assert!(times[0] <= Duration::from_millis(50), "{times:?}");
}

#[test]
fn the_sixth_order_top_expands_within_a_second() {
    let (arguments, item) = sixth();
    let times = times(5, arguments, item);
    assert!(times[0] <= Duration::from_secs(1), "{times:?}");
}
