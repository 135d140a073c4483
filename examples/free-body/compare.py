"""Free bodies in the engines of engines.py beside the exact motion: errors, a picture and a table.

    compare.py [--quick] [--readme] [--fresh] [--engine NAME]... [--jobs N] [--seconds S] [--out FOLDER] [--node FOLDER]

`run` calls it with the folders. Each engine works in a process of its own and keeps its results in FOLDER, so that a run
that was ended goes on; --fresh begins anew. --readme writes the tables of README.md beside this file, and the picture.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import engines
from engines import ENGINES, LEFT_OUT
from exact import Exact

HERE = pathlib.Path(__file__).resolve().parent
PICTURE = HERE.parent / "figures" / "free-body.svg"

# Moments, kg m², body rates at the start, rad/s, and how often a turn the motion is read, which a quarter of its period
# must not escape. All begin with ten radians a second, within a thousandth.
BODIES = {
    "wing nut": ((1, 2, 3), (0.05, 10, 0.1), 2),
    "needle": ((0.02, 1, 1), (9.8, 2, 0), 4),
    "plate": ((1, 1.25, 2.25), (6, 6, 5.3), 2),
    "top": ((3, 3, 4), (1, 0, 9.95), 2),
}
# s
TURN = 2 * np.pi / 10
STEP = 1 / 240
STEPS = [1 / 60, 1 / 120, 1 / 480, 1 / 960]
# How many processors others may keep busy while a time is taken that is shown.
QUIET = 0.3


def wanted(engine, quick, seconds):
    """What an engine is asked for: name, body, step, turns, seconds at most."""
    if quick:
        return [("wing nut", "wing nut", STEP, 100, seconds / 2)]
    works = [("wing nut", "wing nut", STEP, 10_000, seconds)]
    if engine.usual and abs(engine.usual - STEP) > 1e-6:
        works.append(("wing nut, usual step", "wing nut", engine.usual, 10_000, seconds))
    works += [(body, body, STEP, 10_000, seconds * 3 / 8) for body in BODIES if body != "wing nut"]
    if not engine.adaptive:
        works += [(f"wing nut, 1/{1 / step:.0f}", "wing nut", step, 100, seconds / 4) for step in STEPS]
    return works


def errors(exact, engine, rows, every):
    """The errors at turns that grow by a sixth of a decade: largest so far, the phase as it is then."""
    start = np.concatenate([[1, 0, 0, 0], exact.rates])
    rows = np.vstack([start, rows])
    times = np.arange(len(rows)) * (every * engine.step)
    with np.errstate(all="ignore"):
        q, rates = rows[:, :4] / np.linalg.norm(rows[:, :4], axis=1)[:, None], rows[:, 4:]
        body = exact.moments * rates
        axis, angle = q[:, 1:], q[:, :1]
        space = body + 2 * np.cross(axis, np.cross(axis, body) + angle * body)
        length = np.linalg.norm(exact.momentum)
        found = {
            "energy": np.abs((body * rates).sum(axis=1) / 2 / exact.energy - 1),
            "direction": np.arctan2(np.linalg.norm(np.cross(exact.momentum, space), axis=1), space @ exact.momentum),
            "length": np.abs(np.linalg.norm(space, axis=1) / length - 1),
        }
        ahead, sharp = exact.phase(times, rates)
    turns = times / TURN
    grid = 10.0 ** (np.arange(0, 1 + np.floor(6 * np.log10(turns[-1]) + 1e-3)) / 6)
    if turns[-1] > grid[-1] * 1.05:
        grid = np.append(grid, turns[-1])
    # The nearest reading: within half a turn.
    places = np.clip(np.round(grid * TURN / (every * engine.step)).astype(int), 1, len(rows) - 1)
    result = {"turns": turns[places].tolist()}
    for name, values in found.items():
        values = np.maximum.accumulate(np.where(np.isfinite(values), values, np.inf))
        result[name] = [float(min(value, 1e300)) for value in values[places]]
    # The last reading near a flip, unless the motion hasn't flipped for long: then to a quarter flip.
    last = np.maximum.accumulate(np.where(sharp, np.arange(len(rows)), -1))[places]
    near = times[places] - times[last] < 2 * exact.period
    phases = ahead[np.where((last >= 0) & near, last, places)]
    result["phase"] = [float(phase) if np.isfinite(phase) else None for phase in phases]
    return result


def run(engine, body, step, turns, seconds):
    """The errors of one motion."""
    moments, rates, readings = BODIES[body]
    exact, made = Exact(moments, rates), engine(moments, rates, step)
    try:
        every = max(round(TURN / readings / step), 1)
        count = int(np.ceil(turns * TURN / (every * made.step) - 1e-9))
        begun = time.monotonic()
        rows = made.record(count, every, begun + seconds)
        took = time.monotonic() - begun
        return errors(exact, made, rows, every) | {"seconds": took, "whole": len(rows) == count, "step": made.step}
    finally:
        made.close()


def work(name, options):
    """All motions of an engine, in this process; what is there already isn't made again."""
    engine = ENGINES[name]
    path = options.out / f"{name}.json"
    known = json.loads(path.read_text()) if path.exists() else {}
    version = engine.version()
    if known.get("version") != version:
        known = {"version": version, "runs": {}}
    for key, body, step, turns, seconds in wanted(engine, options.quick, options.seconds):
        asked = [body, step, turns, seconds]
        if key in known["runs"] and known["runs"][key]["asked"] == asked:
            continue
        result = run(engine, body, step, turns, seconds)
        # A million turns where they take less than a minute.
        if key == "wing nut" and turns == 10_000 and result["whole"] and result["seconds"] * 100 < 60:
            result = run(engine, body, step, 1_000_000, 100)
        known["runs"][key] = result | {"asked": asked}
        print(f"  {engine.title}, {key}: {result['turns'][-1]:.0f} turns, energy off {result['energy'][-1]:.1e}, "
              f"{result['seconds']:.1f} s", flush=True)
        path.write_text(json.dumps(known))
    if options.quick and name != "Ours":
        times(name, options)


def spent():
    """The seconds that all processors have worked, those that this process has with its children, and the time."""
    own, ticks = os.times(), os.sysconf("SC_CLK_TCK")
    try:
        user, nice, system, _, _, *rest = map(int, pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:])
    except OSError:
        # Elsewhere nobody tells: the page's times are of a machine with Linux.
        return np.array([np.inf, 0, 0])
    return np.array([(user + nice + system + sum(rest[:3])) / ticks, sum(own[:4]), time.monotonic()])


def times(name, options):
    """The time of a step as a multiple of one of (3.13): both in turns, and the fastest of each counts."""
    engine, path = ENGINES[name], options.out / f"{name}.time.json"
    rounds = 3 if options.quick else 15
    known = json.loads(path.read_text()) if path.exists() else {"version": None}
    # What was measured beside others is measured again.
    if known["version"] == engine.version() and known["rounds"] >= rounds and known.get("others", 1) < QUIET:
        return
    moments, rates, _ = BODIES["wing nut"]
    before = spent()
    ours, theirs, steps = engines.Ours(moments, rates, STEP), engine(moments, rates, STEP), 16
    try:
        while theirs.seconds(steps) < 0.01 and steps < 1_000_000:
            steps *= 2
        best = [np.inf, np.inf]
        for _ in range(rounds):
            best = [min(best[0], ours.seconds(100_000) / 100_000), min(best[1], theirs.seconds(steps) / steps)]
    finally:
        theirs.close()
    busy, own, wall = spent() - before
    result = {"version": engine.version(), "rounds": rounds, "ours": best[0], "theirs": best[1], "ratio": best[1] / best[0],
              "others": min((busy - own) / wall, 1e9)}
    path.write_text(json.dumps(result))
    print(f"  {engine.title}: a step takes {best[1] * 1e6:.2f} µs, {result['ratio']:.3g} of ours", flush=True)


def child(name, kind, options):
    """An engine in a process of its own, as some end the process that they are in. Returns why there is no result."""
    words = [sys.executable, HERE / "compare.py", f"--{kind}", name, "--out", options.out, "--node", options.node, "--seconds",
             options.seconds] + ["--quick"] * options.quick
    # Some write logs where they stand.
    done = subprocess.run(list(map(str, words)), cwd=options.out, capture_output=True, text=True)
    print("".join(line + "\n" for line in done.stdout.splitlines() if line.startswith("  ")), end="", flush=True)
    if done.returncode == 0:
        return None
    lines = done.stderr.strip().splitlines() or [f"it ended with {done.returncode}"]
    return lines[-1]


def everything(options):
    """All engines; returns their results by name, and the reasons for those that have none."""
    names, reasons = options.engine or list(ENGINES), dict(LEFT_OUT)
    begun = time.monotonic()

    def one(name):
        reason = child(name, "work", options)
        print(f"[{time.monotonic() - begun:.0f} s] {ENGINES[name].title}: {'skipped: ' + reason if reason else 'done'}", flush=True)
        if reason:
            reasons[ENGINES[name].title] = reason

    with ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(one, names))
    # One after another, and nothing beside: these are times. An overview has taken them already, as well as it can.
    for name in [] if options.quick else names:
        if name == "Ours" or ENGINES[name].title in reasons:
            continue
        if reason := child(name, "time", options):
            print(f"no time of {ENGINES[name].title}: {reason}", flush=True)
    results = {}
    for name in names:
        path, timed = options.out / f"{name}.json", options.out / f"{name}.time.json"
        if path.exists() and ENGINES[name].title not in reasons:
            results[name] = json.loads(path.read_text())
            known = json.loads(timed.read_text()) if timed.exists() else None
            # One that was taken beside others isn't shown.
            results[name]["time"] = known if known and known["others"] < QUIET else None
            if name == "Ours":
                results[name]["time"] = {"ratio": 1.0, "others": 0.0}
    for title, reason in reasons.items():
        print(f"left out: {title}: {reason}")
    return results, reasons


def at(result, name, turns):
    """A value after so many turns, and nothing where it wasn't reached."""
    place = int(np.argmin(np.abs(np.log(np.array(result["turns"]) / turns))))
    return result[name][place] if abs(result["turns"][place] / turns - 1) < 0.05 else None


def short(value, signed=False):
    if value is None:
        return "–"
    if abs(value) >= 1e30:
        return "∞"
    text = f"{value:.2g}" if 0.01 <= abs(value) < 100 else f"{value:.0f}" if 100 <= abs(value) < 1e5 else f"{value:.0e}"
    if "e" in text:
        mantissa, power = text.split("e")
        text = f"{mantissa}e{int(power)}"
    return ("+" if signed and value > 0 else "") + text.replace("-", "−")


def flips(result, turns):
    """The phase after so many turns; a body that never flips has none."""
    phase = at(result, "phase", turns)
    if phase is None:
        return "–"
    return "no flips" if stuck(result) else short(phase, True)


def stuck(result):
    """Whether it made no flip in a hundred turns, or as far as it came."""
    phases = [phase for turns, phase in zip(result["turns"], result["phase"]) if turns < 130]
    made = TURN * min(100, result["turns"][-1]) / Exact(*BODIES[result["asked"][0]][:2]).period * 2
    return phases[-1] is not None and phases[-1] < 1.5 - made


def name_of_step(engine, step):
    if engine.adaptive:
        return "its own"
    return f"1/{1 / step:.0f}" if step in (1 / 60, 1 / 240) else f"{step:g}"


def has_times(results):
    return sum(r["time"] is not None for r in results.values()) > 1


def ratio(result):
    return short(result["time"]["ratio"]) if result["time"] else "–"


def table_of_versions(results):
    yield "| engine | version | what is called | numbers | default step, s |"
    yield "|---|---|---|---|---|"
    for name, result in results.items():
        e = ENGINES[name]
        usual = "–" if e.usual is None else name_of_step(e, e.usual)
        yield f"| {e.title} | `{e.package}` {result['version']} | {e.setting} | {e.digits} | {usual} |"


def table_of_wing_nut(results):
    yield ("| engine | step, s | energy, 100 turns | direction, rad | length | flips ahead | turns in all | energy | direction, rad "
           "| length | flips ahead | time of a step |")
    yield "|---|---|---|---|---|---|---|---|---|---|---|---|"
    for name, result in results.items():
        for key in ("wing nut", "wing nut, usual step"):
            if key not in result["runs"]:
                continue
            one, e = result["runs"][key], ENGINES[name]
            cells = []
            for turns in (100, one["turns"][-1]):
                if turns != 100:
                    cells.append(f"{turns:,.0f}")
                cells += [short(at(one, what, turns)) for what in ("energy", "direction", "length")] + [flips(one, turns)]
            if len(cells) < 9:
                cells += ["100"] + cells[:4]
            yield f"| {e.title} | {name_of_step(e, one['asked'][1])} | {' | '.join(cells)} | {ratio(result)} |"


def table_of_others(results):
    bodies = [body for body in BODIES if body != "wing nut"]
    yield "| engine | " + " | ".join(f"{body}: turns | energy | direction, rad | periods ahead" for body in bodies) + " |"
    yield "|---|" + "---|" * (4 * len(bodies))
    for name, result in results.items():
        cells = []
        for body in bodies:
            if body not in result["runs"]:
                cells += ["–"] * 4
                continue
            one = result["runs"][body]
            # A period of the rates is two flips.
            phase = one["phase"][-1] and one["phase"][-1] / 2
            phase = "none" if stuck(one) else short(phase, True)
            cells += [f"{one['turns'][-1]:,.0f}", short(one["energy"][-1]), short(one["direction"][-1]), phase]
        yield f"| {ENGINES[name].title} | {' | '.join(cells)} |"


def spread(places, gap, low, high):
    """Labels' places between two bounds, moved apart to a gap and hardly further than they must be."""
    order = np.argsort(places, kind="stable")
    moved = np.array(places, float)
    for _ in range(2000):
        moved = np.clip(moved, low, high)
        for below, above in zip(order, order[1:]):
            overlap = gap - (moved[above] - moved[below])
            if overlap > 1e-9:
                moved[below] -= overlap / 2
                moved[above] += overlap / 2
    return moved


def readable(color):
    """A colour of the same hue, whose contrast with white is at least 4.5 (WCAG 2)."""
    parts = [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts]
    factor = min(1.0, (1.05 / 4.5 - 0.05) / (0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]))
    shown = [12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055 for x in (factor * x for x in linear)]
    return "#" + "".join(f"{int(255 * x):02x}" for x in shown)


def picture(results, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    timed = has_times(results)
    plt.rcParams |= {"svg.fonttype": "none", "font.family": "sans-serif", "font.size": 9, "svg.hashsalt": "free-body"}
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 6.2), gridspec_kw={"width_ratios": [1.25, 1]})
    lines = []
    for name, result in results.items():
        one, e = result["runs"]["wing nut"], ENGINES[name]
        y = np.clip(one["energy"], 1e-16, 1e4)
        still = stuck(one)
        left.loglog(one["turns"], y, color=e.color, lw=2.2 if name.startswith("Ours") else 1.2, ls=":" if still else "-")
        left.plot(one["turns"][-1], y[-1], "o", ms=3, color=e.color)
        lines.append((e.title + (" (never flips)" if still else ""), e.color, one["turns"][-1], y[-1]))
    left.set(xlabel="turns", ylabel="largest relative error of the energy so far", xlim=(1, 1e6), ylim=(1e-16, 3e4),
             title="Steps of 1/240 s, ten radians a second")
    heights = spread([np.log10(y) for *_, y in lines], 0.72, -15.8, 4.2)
    for (title, color, x, y), height in zip(lines, heights):
        left.annotate(title, (x, y), xytext=(2.2e6, 10**height), textcoords="data", color=readable(color), fontsize=8,
                      va="center", annotation_clip=False, arrowprops={"arrowstyle": "-", "lw": 0.4, "color": color, "alpha": 0.5})
    for name, result in results.items():
        e, points = ENGINES[name], []
        if timed and not result["time"]:
            continue
        for key, one in result["runs"].items():
            phase = at(one, "phase", 100) if key.startswith("wing nut") and "usual" not in key else None
            if phase is None or stuck(one):
                continue
            cost = 1 if e.adaptive else STEP / one["asked"][1]
            cost = cost * result["time"]["ratio"] if timed else TURN / one["asked"][1]
            points.append((cost, max(abs(phase), 1e-13)))
        if points and (timed or not e.adaptive):
            points.sort()
            right.loglog(*zip(*points), "o-", color=e.color, ms=3, lw=2.2 if name.startswith("Ours") else 1.2)
    right.set(ylabel="error of the phase after 100 turns, flips (33.1 are right)", title="Steps from 1/60 to 1/960 s",
              xlabel="time, as a multiple of (3.13) with steps of 1/240 s" if timed else "steps a turn")
    if not timed:
        right.set_xticks([TURN / step for step in [*STEPS, STEP]], [f"{TURN / step:.0f}" for step in [*STEPS, STEP]])
        right.minorticks_off()
    for axes in (left, right):
        axes.grid(alpha=0.25, lw=0.5)
        axes.spines[["top", "right"]].set_visible(False)
    figure.subplots_adjust(left=0.06, right=0.99, top=0.94, bottom=0.09, wspace=0.62)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None})
    figure.savefig(path.with_suffix(".png"), dpi=110) if path.parent != PICTURE.parent else None


def readme(results, reasons):
    """The tables between the marks of README.md."""
    path = HERE / "README.md"
    text = path.read_text()
    left_out = [f"Left out: {title}, as {reason}." for title, reason in reasons.items()]
    blocks = {"versions": [*table_of_versions(results), "", *left_out], "wing nut": table_of_wing_nut(results),
              "others": table_of_others(results)}
    for mark, lines in blocks.items():
        head, rest = text.split(f"<!-- {mark} -->\n", 1)
        _, tail = rest.split(f"<!-- end of {mark} -->", 1)
        text = head + f"<!-- {mark} -->\n" + "\n".join(lines) + f"\n<!-- end of {mark} -->" + tail
    path.write_text(text)
    picture(results, PICTURE)
    if beside := [ENGINES[name].title for name, result in results.items() if not result["time"]]:
        print(f"others kept more than {QUIET} processors busy beside {', '.join(beside)}: no time is shown there, and the next "
              "run measures it again")


def main():
    about = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    about.add_argument("--quick", action="store_true", help="a hundred turns of one body: an overview")
    about.add_argument("--readme", action="store_true", help="write the tables and the picture of the page")
    about.add_argument("--fresh", action="store_true", help="forget the results that are there")
    about.add_argument("--engine", action="append", choices=ENGINES, help="only this one; may be given again")
    about.add_argument("--jobs", type=int, default=os.cpu_count(), help="engines at a time; times are taken one by one")
    about.add_argument("--seconds", type=float, default=8.0, help="of an engine for its longest run, but for a million turns")
    about.add_argument("--out", type=pathlib.Path, default=pathlib.Path("target/free-body/results"))
    about.add_argument("--node", type=pathlib.Path, default=pathlib.Path("target/free-body/node/node_modules"))
    about.add_argument("--work", help=argparse.SUPPRESS)
    about.add_argument("--time", help=argparse.SUPPRESS)
    options = about.parse_args()
    options.out, options.node = options.out.resolve(), options.node.resolve()
    engines.Node.modules = options.node
    if options.work:
        return work(options.work, options)
    if options.time:
        return times(options.time, options)
    if options.quick:
        options.out = options.out.with_name(options.out.name + "-quick")
    options.out.mkdir(parents=True, exist_ok=True)
    if options.fresh:
        for path in options.out.glob("*.json"):
            path.unlink()
    if options.quick and options.readme:
        about.error("--readme takes the whole work, not --quick")
    results, reasons = everything(options)
    print()
    for line in [*table_of_versions(results), "", *table_of_wing_nut(results)]:
        print(line)
    if options.readme:
        readme(results, reasons)
    elif "wing nut" in str(results):
        picture(results, options.out / "free-body.svg")
        print(f"\n{options.out / 'free-body.svg'}")


if __name__ == "__main__":
    main()
