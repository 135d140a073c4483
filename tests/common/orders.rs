//! Sums of three terms, in all orders and bracketings.

/// The results of a generic function of each sum of three terms, and of these arguments behind it: the terms are in all six
/// orders, first with the first two of them in brackets and then with the last two.
#[macro_export]
macro_rules! in_all_orders {
    ($of:ident($a:expr, $b:expr, $c:expr $(; $argument:expr)*)) => {{
        let (a, b, c) = ($a, $b, $c);
        [
            $of((a + b) + c $(, $argument)*),
            $of(a + (b + c) $(, $argument)*),
            $of((a + c) + b $(, $argument)*),
            $of(a + (c + b) $(, $argument)*),
            $of((b + a) + c $(, $argument)*),
            $of(b + (a + c) $(, $argument)*),
            $of((b + c) + a $(, $argument)*),
            $of(b + (c + a) $(, $argument)*),
            $of((c + a) + b $(, $argument)*),
            $of(c + (a + b) $(, $argument)*),
            $of((c + b) + a $(, $argument)*),
            $of(c + (b + a) $(, $argument)*),
        ]
    }};
}
