//! An expansion must not be felt.

use std::time::{Duration, Instant};

use super::{HEAVY_TOP, expanded, top};

#[test]
fn the_heavy_top_expands_quickly() {
    let item = top("NonstandardInertia");
    let mut times: Vec<Duration> = (0..50)
        .map(|_| {
            let start = Instant::now();
            drop(expanded(HEAVY_TOP, &item));
            start.elapsed()
        })
        .collect();
    times.sort();
    println!("median {:?}, slowest {:?}", times[25], times[49]);
    // The quickest: the others measure what else the machine was doing.
    assert!(times[0] <= Duration::from_millis(50), "{:?}", times[0]);
}

#[test]
fn phases_tmp() {
    for n in [2, 4, 6, 8, 12] {
        let l = format!(
            "group = SO3, l_d = (J_d.trace() - (F * J_d).trace()) / h + h * ({}).trace()",
            vec!["F * A"; n].join(" * ")
        );
        let item = "struct Top { J_d: NonstandardInertia, A: Matrix3<f64> }";
        let t = Instant::now();
        let d = super::derived(&l, item);
        println!(
            "{n} derive {:?} cleared {:?}",
            t.elapsed(),
            d.cleared.as_ref().map(|c| (c.residual.len(), c.jacobian.len()))
        );
        let t = Instant::now();
        let k = crate::scalar::kernel(&d);
        println!("{n} kernel {:?} {:?}", t.elapsed(), k.candidates);
        let t = Instant::now();
        drop(expanded(&l, item));
        println!("{n} all {:?}", t.elapsed());
    }
}
