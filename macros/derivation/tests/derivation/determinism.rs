//! Two expansions of one declaration have the same tokens.

use crate::common::{HEAVY_TOP, expanded, top};

/// The declaration of the library's rigid body.
const BODY: &str = "group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)";
const BODY_PARAMETERS: &str = "struct RigidBody { J_d: NonstandardInertia }";

/// Other declarations in a program cost nothing: a body's expansion is the same byte for byte, whatever else has been
/// declared.
#[test]
fn other_declarations_change_nothing() {
    let alone = expanded(BODY, BODY_PARAMETERS).to_string();
    assert!(!alone.contains("compile_error"), "{alone}");
    for _ in 0..3 {
        for kind in ["NonstandardInertia", "DiagonalNonstandardInertia"] {
            let other = expanded(HEAVY_TOP, &top(kind)).to_string();
            assert!(other != alone);
            assert_eq!(expanded(BODY, BODY_PARAMETERS).to_string(), alone);
        }
    }
}

/// Expansions on other threads, where hashers have other seeds, have the same tokens.
#[test]
fn on_other_threads_too() {
    let expansion = || expanded(HEAVY_TOP, &top("DiagonalNonstandardInertia")).to_string();
    let threads: Vec<_> = (0..4).map(|_| std::thread::spawn(expansion)).collect();
    let first = expansion();
    assert!(threads.into_iter().all(|thread| thread.join().expect("an expansion") == first));
}
