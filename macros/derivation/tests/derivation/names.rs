//! Distances of misspelt names, and the expansions that names come from.

use liestep_derivation::declared::errors::distance;
use liestep_derivation::declared::spelling::site;
use liestep_derivation::suggestion;

#[test]
fn distances() {
    assert_eq!(distance("rho", "rho"), 0);
    assert_eq!(distance("roh", "rho"), 1);
    assert_eq!(distance("J_D", "J_d"), 0);
    assert_eq!(distance("kitten", "sitting"), 3);
    assert_eq!(distance("", "abc"), 3);
    assert_eq!(suggestion("rh", ["m", "rho", "g"]), "; did you mean `rho`?");
    assert_eq!(suggestion("roh", ["h", "rho"]), "; did you mean `rho`?");
    assert_eq!(suggestion("f", ["m", "F"]), "; did you mean `F`?");
    assert_eq!(suggestion("w", ["m", "F"]), "");
    assert_eq!(suggestion("velocity", ["m", "rho"]), "");
    assert_eq!(suggestion("PI", ["F", "I", "h"]), "");
    assert_eq!(suggestion("rho1", ["rho2", "rho"]), "");
    assert_eq!(suggestion("R_1", ["F_1", "F_2"]), "");
    assert_eq!(suggestion("F1", ["F_1", "F_2"]), "; did you mean `F_1`?");
    assert_eq!(suggestion("S03", ["SO2", "SO3"]), "; did you mean `SO3`?");
    assert_eq!(suggestion("rho0", ["rho", "rho1"]), "");
    assert_eq!(suggestion("advect", ["group", "advected"]), "; did you mean `advected`?");
    assert_eq!(suggestion("log", ["ln", "cos"]), "");
}
#[test]
fn the_site_of_a_span() {
    assert_eq!(site("#7 bytes(10..12)"), Some(7));
    assert_eq!(site("bytes(10..12)"), None);
    assert_eq!(site("Span"), None);
    assert_eq!(site("#seven bytes(10..12)"), None);
}
