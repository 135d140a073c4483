//! Fifty expansions of a declaration have the same tokens.

use crate::common::{HEAVY_TOP, expanded, top};

#[test]
fn fifty_expansions_are_one() {
    let item = top("NonstandardInertia");
    let first = expanded(HEAVY_TOP, &item).to_string();
    for _ in 0..50 {
        assert_eq!(expanded(HEAVY_TOP, &item).to_string(), first);
    }
}
