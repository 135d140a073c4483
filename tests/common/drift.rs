//! A test for the drift of an oscillating quantity.

/// The means of each tenth of a hundred thousand numbers, and the largest absolute value.
pub fn tenths(mut next: impl FnMut() -> f64) -> ([f64; 10], f64) {
    let mut most = 0.0_f64;
    let means = [(); 10].map(|()| {
        let mut sum = 0.0;
        for _ in 0..10_000 {
            let number = next();
            sum += number;
            most = most.max(number.abs());
        }
        sum / 10_000.0
    });
    (means, most)
}
