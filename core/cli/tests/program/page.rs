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

/// Opens a page of a folder in a browser, and returns the text that it prints.
fn shown(browser: &str, folder: &Path, name: &str, arguments: &[&str]) -> String {
    let address = format!("file://{}/{name}", folder.canonicalize().unwrap().display());
    let profile = format!("--user-data-dir={}", folder.join("profile").display());
    let plain = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=3000"];
    let mut command = Command::new(browser);
    command.current_dir(folder).args(plain).args(["--window-size=1200,700"]).args(arguments).arg(profile).arg(address);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
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
    let shown = |name: &str, arguments: &[&str]| shown(browser, &folder, &format!("{name}#t=1.5"), arguments);
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

/// A page fits a phone in both positions: nothing is wider than the screen, the time stands in one line, fingers have buttons of
/// 44 pixels, and each chart has room for its labels. It starts by itself, and on a large screen it says its keys.
#[test]
fn it_fits_a_phone() {
    let Some(browser) = browser() else {
        println!("skipped: there is no Chromium here (Debian: apt-get install chromium)");
        return;
    };
    let folder = folder("phone");
    let script = r#"<script>setTimeout(() => {
        const root = document.documentElement, all = list => [...document.querySelectorAll(list)].map(part => part.getBoundingClientRect());
        const [clock] = all("output"), line = parseFloat(getComputedStyle(document.body).lineHeight);
        parent.postMessage({
            size: `${window.innerWidth},${window.innerHeight}`,
            wide: root.scrollWidth <= window.innerWidth && all("footer *").every(box => box.right <= window.innerWidth),
            clock: clock.height < 1.5 * line,
            fingers: all("button, select, footer input").filter(box => box.width).every(box => box.height >= 44),
            room: all(".chart").every(box => box.height >= 100),
            keys: document.querySelector("footer p").offsetWidth > 0,
            plays: document.querySelector("footer button").textContent,
            error: root.dataset.error || "none",
        }, "*");
    }, 500);</script></body>"#;
    let page = page(&folder, "A heavy top with drag").replace("</body>", script);
    fs::write(folder.join("page.html"), page).unwrap();
    let pointer = |kind| format!("--blink-settings=primaryPointerType={kind},availablePointerTypes={kind}");
    for (width, height, is_phone) in [(360, 740, true), (740, 360, true), (1200, 700, false)] {
        // The least window of a browser is wider than a phone, but not a frame in it.
        let frame = format!(
            "<script>onmessage = event => Object.assign(document.documentElement.dataset, event.data)</script>\
             <iframe src=\"page.html\" style=\"border: 0; width: {width}px; height: {height}px\"></iframe>"
        );
        fs::write(folder.join("phone.html"), frame).unwrap();
        let pointer = pointer(if is_phone { 2 } else { 4 });
        let document = shown(browser, &folder, "phone.html", &["--dump-dom", &pointer, "--window-size=1400,1000"]);
        let root = document.lines().find(|line| line.contains("<html")).unwrap();
        let words = [("wide", true), ("clock", true), ("fingers", is_phone), ("room", true), ("keys", !is_phone)];
        let words = words.map(|(word, value)| format!("data-{word}=\"{value}\""));
        for word in words.into_iter().chain([
            format!("data-size=\"{width},{height}\""),
            "data-plays=\"Pause\"".to_owned(),
            "data-error=\"none\"".to_owned(),
        ]) {
            assert!(root.contains(&word), "{word}: {root}");
        }
    }
}
