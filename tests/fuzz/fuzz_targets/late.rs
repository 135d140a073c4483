//! Any text as a declaration that is read at run time: the result is a derivation or a refusal with its reason.
#![no_main]

use liestep_late::Declaration;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let inside = format!(
        "#[lagrangian(group = SO3, advected(w = up), l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - h * ({text}))]
        struct Body {{ J: NonstandardInertia, k: f64, a: Vector3<f64>, up: Vector3<f64> }}"
    );
    for text in [text, &inside] {
        if let Err(refused) = Declaration::parse(text) {
            assert!(!refused.to_string().is_empty());
        }
    }
});
