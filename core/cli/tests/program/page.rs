//! The page that plays a motion, tested in a browser where one is installed.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::called::{TOP, folder, printed};

/// Runs the top and returns the text of its page.
fn page(folder: &Path, title: &str) -> String {
    fs::write(folder.join("top.toml"), TOP.replace("A heavy top with drag", title)).unwrap();
    printed(folder, &["run", "top.toml", "--csv", "--html", "--out", "."]);
    fs::read_to_string(folder.join("top.html")).unwrap()
}

/// A page loads nothing, and a title closes no tag.
#[test]
fn it_is_complete() {
    let page = page(&folder("page"), r"</title><script>alert(1)</script> & \u0000");
    assert!(page.contains("<title>&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt; &amp; \\u{0}</title>"));
    assert!(page.contains(
        "content=\"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\""
    ));
    for word in ["http:", "https:", "//www", "@import", "url(", "src=", "fetch(", "XMLHttpRequest", "import("] {
        assert!(!page.contains(word), "{word}");
    }
    assert_eq!((page.matches("<script>").count(), page.matches("</script>").count()), (1, 1));
    assert_eq!((page.matches(" href=").count(), page.matches("href=\"data:,\"").count()), (1, 1));
    assert!(page.len() < 70_000, "{}", page.len());
}

/// The page of a recorded run agrees with that of the run itself, except for title and body, which a table lacks.
#[test]
fn a_table_is_replayed() {
    let folder = folder("replay");
    // Steps with functions of the browser are recorded, too.
    let scene = TOP.replace("4]\n", "4]\nkinetic = \"geodesic\"\n").replace("A heavy top with drag", "top");
    fs::write(folder.join("top.toml"), scene).unwrap();
    printed(&folder, &["run", "top.toml", "--csv", "--html", "--out", "."]);
    let page = fs::read_to_string(folder.join("top.html")).unwrap();
    printed(&folder, &["replay", "top.csv", "--out", "again"]);
    let again = fs::read_to_string(folder.join("again/top.html")).unwrap();
    let lists = |page: &str| -> Vec<String> {
        page.lines().filter(|line| line.len() > 500 && line.contains('"')).map(str::to_owned).collect()
    };
    let (first, second) = (lists(&page), lists(&again));
    assert_eq!(first.len(), 9);
    assert_eq!(first, second);

    // A recorder's table may also have names in quotes, and gaps.
    let table = "t,q_w,q_x,q_y,q_z,\"drag, N\",energy\n0,1,0,0,0,inf,NaN\n1,1,0,0,0,1e-3,2.5\n2,1,0,0,0,-inf,NaN\n";
    fs::write(folder.join("gaps.csv"), table).unwrap();
    printed(&folder, &["replay", "gaps.csv", "--out", "."]);
    // The energies NaN, 0 and NaN, in single precision.
    let energy = "{name: \"energy\", values: \"AADAfwAAAAAAAMB/\"}";
    assert!(fs::read_to_string(folder.join("gaps.html")).unwrap().contains(energy));
}

/// Chromium by one of its names.
fn browser() -> Option<&'static str> {
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    names
        .into_iter()
        .find(|name| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success()))
}

/// The script runs to its end without an error, and the picture isn't empty.
#[test]
fn a_browser_shows_it() {
    let Some(browser) = browser() else {
        println!("skipped: there is no Chromium here (Debian: apt-get install chromium)");
        return;
    };
    let folder = folder("browser");
    let page = page(&folder, "A heavy top with drag");
    let shown = |name: &str, arguments: &[&str]| {
        let address = format!("file://{}#t=1.5", folder.canonicalize().unwrap().join(name).display());
        let profile = format!("--user-data-dir={}", folder.join("profile").display());
        let plain =
            ["--headless", "--no-sandbox", "--disable-gpu", "--window-size=1200,700", "--virtual-time-budget=3000"];
        let mut command = Command::new(browser);
        let output =
            command.current_dir(&folder).args(plain).args(arguments).arg(profile).arg(address).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let document = shown("top.html", &["--dump-dom"]);
    let root = document.lines().find(|line| line.contains("<html")).unwrap();
    assert!(root.contains("data-frames=\"201\"") && root.contains("data-charts=\"4\""), "{root}");
    assert!(!root.contains("data-error"), "{root}");
    assert_eq!(document.matches("<canvas").count(), 5);
    assert!(document.contains("<output>1.50 s</output>"), "{document}");
    shown("top.html", &["--screenshot=top.png"]);
    // The picture of an empty page has a tenth of that size.
    assert!(fs::metadata(folder.join("top.png")).unwrap().len() > 40_000);

    // The page plays, can be turned and zoomed, and goes to the time of a click in a chart.
    let script = r#"<script>{
        const root = document.documentElement, clock = document.querySelector("output"), button = document.querySelector("footer button");
        const [view, chart] = document.querySelectorAll("canvas"), pixels = canvas => canvas.toDataURL();
        const changes = (canvas, type, event) => { const before = pixels(canvas); canvas.dispatchEvent(new type(...event)); return before !== pixels(canvas); };
        document.querySelector("footer input").value = 0.25;
        document.querySelector("footer input").dispatchEvent(new Event("input"));
        root.dataset.slid = clock.textContent;
        const about = { clientX: 900, clientY: 150, deltaY: -300, cancelable: true };
        root.dataset.zoomed = [changes(view, WheelEvent, ["wheel", about]), changes(chart, WheelEvent, ["wheel", about]), changes(chart, MouseEvent, ["dblclick", about])];
        root.dataset.turned = changes(view, PointerEvent, ["pointermove", { buttons: 1, movementX: 40, movementY: 9 }]);
        root.dataset.clicked = changes(chart, MouseEvent, ["click", about]);
        // A slider moves, and the curves follow in the next frame.
        const before = pixels(chart), slider = document.querySelector("details input");
        slider.value = 1.5; slider.dispatchEvent(new Event("input"));
        requestAnimationFrame(() => { root.dataset.followed = before !== pixels(chart) && root.dataset.computed === "2"; });
        for (const key of ["l", "Home"]) document.dispatchEvent(new KeyboardEvent("keydown", { key }));
        root.dataset.letters = getComputedStyle(document.body).fontSize;
        button.click();
        setTimeout(() => { root.dataset.played = clock.textContent; }, 1000);
    }</script></body>"#;
    fs::write(folder.join("played.html"), page.replace("</body>", script)).unwrap();
    let document = shown("played.html", &["--dump-dom"]);
    let root = document.lines().find(|line| line.contains("<html")).unwrap();
    for word in [
        "data-slid=\"0.50 s\"",
        "data-zoomed=\"true,true,true\"",
        "data-turned=\"true\"",
        "data-clicked=\"true\"",
        "data-letters=\"23.8px\"",
        "data-followed=\"true\"",
    ] {
        assert!(root.contains(word), "{root}");
    }
    let played = root.split_once("data-played=\"").unwrap().1.split_once(' ').unwrap().0;
    // The frame rate of a browser without a screen is unknown.
    assert!((0.01..1.5).contains(&played.parse::<f64>().unwrap()) && !root.contains("data-error"), "{root}");
}
