//! Steps in C with a scene's numbers, as firmware has them: constants, a start and a step.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::called::{PROGRAM, TOP, folder, printed, table};

fn is_there(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok();
    if !found {
        println!("skipped: there is no `{program}`");
    }
    found
}

/// Compiles by `cc` and runs; what is printed.
fn run(folder: &Path, sources: &[&str]) -> String {
    let flags = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off", "-o", "firmware"];
    let compiled = Command::new("cc").args(flags).args(sources).arg("-lm").current_dir(folder).output().unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let run = Command::new(folder.join("firmware")).output().unwrap();
    assert!(run.status.success(), "{:?}", run.status);
    String::from_utf8(run.stdout).unwrap()
}

const OF: &str = "principal_body_gravity_drag";

/// A unit that knows the step by its header alone has the rows of the program's table, and the constants are those of `make`.
#[test]
fn a_scene_is_firmware() {
    if !is_there("cc") {
        return;
    }
    for (name, method) in [("firmware", ""), ("firmware-composed", "method = { composition = \"Suzuki 4\" }\n")] {
        let folder = folder(name);
        let mut scene = TOP.replace("duration = 2", "duration = 10") + method + "[output]\ncolumns = [\"momentum\"]\n";
        let of = if method.is_empty() { OF } else { OF.strip_suffix("_drag").unwrap() };
        if !method.is_empty() {
            scene = scene.replace("[drag]\nc = 1e-3\n", "");
        }
        fs::write(folder.join("scene.toml"), &scene).unwrap();
        printed(&folder, &["run", "scene.toml", "--csv", "--out", "."]);
        let rows = table(&fs::read_to_string(folder.join("scene.csv")).unwrap());
        fs::write(folder.join("step.c"), printed(&folder, &["derive", "scene.toml", "--c"])).unwrap();
        fs::write(folder.join("step.h"), printed(&folder, &["derive", "scene.toml", "--header"])).unwrap();
        let main = format!(
            "#include \"step.h\"\n#include \"step.h\"\n#include <stdio.h>\n#include <string.h>
int main(void) {{
    static {of}_state state;
    {of}_stepper made;
    if (!{of}_make(&made, {of}_stages[0].parameters, {of}_stages[0].h)) return 1;
    if (memcmp(&made, {of}_stages, sizeof made)) return 2;
    {of}_begin(&state);
    for (int n = 0; n <= 1000; n++) {{
        printf(\"%.17g,%.17g,%.17g\\n\", state.momentum[0], state.momentum[1], state.momentum[2]);
        if (!{of}_next(&state)) return 3;
    }}
    return 0;
}}
"
        );
        fs::write(folder.join("main.c"), main).unwrap();
        let found = table(&format!("names\n{}", run(&folder, &["step.c", "main.c"])));
        let expected: Vec<Vec<f64>> = rows.into_iter().map(|row| row[1..].to_vec()).collect();
        let bits = |rows: &[Vec<f64>]| rows.iter().flatten().map(|one| one.to_bits()).collect::<Vec<_>>();
        assert_eq!((found.len(), bits(&found)), (1001, bits(&expected)), "{name}");
    }
}

/// Constants of a step with compensated sums are those of `make`, and its errors are carried; forms without such sums say so.
#[test]
fn its_sums_may_be_compensated() {
    if !is_there("cc") {
        return;
    }
    let folder = folder("firmware-compensated");
    fs::write(folder.join("scene.toml"), TOP).unwrap();
    for (name, form) in [("step.c", "--c"), ("step.h", "--header")] {
        fs::write(folder.join(name), printed(&folder, &["derive", "scene.toml", form, "--compensated"])).unwrap();
    }
    let main = format!(
        "#include \"step.h\"\n#include <stdio.h>\n#include <string.h>
int main(void) {{
    static {OF}_state state;
    {OF}_stepper made;
    if (!{OF}_make(&made, {OF}_stages[0].parameters, {OF}_stages[0].h)) return 1;
    if (memcmp(&made, {OF}_stages, sizeof made)) return 2;
    {OF}_begin(&state);
    if (state.errors[0] != 0.0) return 3;
    for (int n = 0; n < 10; n++) if (!{OF}_next(&state)) return 4;
    puts(state.errors[0] != 0.0 ? \"carried\" : \"lost\");
    return 0;
}}
"
    );
    fs::write(folder.join("main.c"), main).unwrap();
    assert_eq!(run(&folder, &["step.c", "main.c"]), "carried\n");
    for form in ["--js", "--rust"] {
        let refused = Command::new(PROGRAM).args(["derive", "gravity", form, "--compensated"]).output().unwrap();
        let message = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(refused.status.code() == Some(2) && message.contains("--compensated"), "{message}");
    }
}

const START: &str = include_str!("hosts/start.c");
const MEMORY: &str = include_str!("hosts/memory.ld");

/// The bits on a Cortex-M4 and M7 in QEMU.
#[test]
fn a_chip_has_the_bits_of_this_machine() {
    if !(is_there("cc") && is_there("arm-none-eabi-gcc") && is_there("qemu-system-arm")) {
        return;
    }
    let folder = folder("firmware-chips");
    fs::write(folder.join("scene.toml"), TOP).unwrap();
    let step = printed(&folder, &["derive", "scene.toml", "--c"]);
    let main = format!(
        "{step}
#include <stdint.h>
#ifdef __arm__
void put(const char *);
#else
#include <stdio.h>
#define put(text) fputs(text, stdout)
#endif
int main(void) {{
    static {OF}_state state;
    uint64_t hash = 14695981039346656037u;
    {OF}_begin(&state);
    for (int n = 0; n < 1000; n++) {{
        const unsigned char *bytes = (const unsigned char *)&state;
        if (!{OF}_next(&state)) return 1;
        for (unsigned k = 0; k < sizeof state.attitude + sizeof state.momentum; k++) hash = (hash ^ bytes[k]) * 1099511628211u;
    }}
    char text[18] = {{0}};
    for (int k = 0; k < 16; k++) text[k] = \"0123456789abcdef\"[hash >> (60 - 4 * k) & 15];
    text[16] = '\\n';
    put(text);
    return 0;
}}
"
    );
    for (name, text) in [("main.c", &*main), ("start.c", START), ("memory.ld", MEMORY)] {
        fs::write(folder.join(name), text).unwrap();
    }
    let expected = run(&folder, &["main.c"]);
    let mut heard = String::new();
    for (chip, unit, board) in [("cortex-m4", "fpv4-sp-d16", "mps2-an386"), ("cortex-m7", "fpv5-d16", "mps2-an500")] {
        let options =
            [&*format!("-mcpu={chip}"), "-mthumb", "-mfloat-abi=hard", &*format!("-mfpu={unit}")].map(str::to_owned);
        let flags = "-std=gnu99 -O2 -ffp-contract=off -ffreestanding -nostartfiles --specs=nosys.specs --specs=nano.specs -T memory.ld start.c main.c -o chip.elf -lm";
        let mut compiler = Command::new("arm-none-eabi-gcc");
        let compiled = compiler.args(options).args(flags.split(' ')).current_dir(&folder).output().unwrap();
        assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
        let flags =
            ["-nographic", "-monitor", "none", "-serial", "null", "-semihosting", "-kernel", "chip.elf", "-M", board];
        let chip = Command::new("qemu-system-arm").args(flags).current_dir(&folder).output().unwrap();
        // Semihosting prints to the standard error.
        let _ = write!(heard, "{}{}", String::from_utf8_lossy(&chip.stdout), String::from_utf8_lossy(&chip.stderr));
    }
    assert_eq!(heard, expected.repeat(2));
}
