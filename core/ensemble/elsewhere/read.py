"""Reads an ensemble's files as they are: python read.py polars|pandas FOLDER PRINTED.

They are those of the example `ensemble` in its folder; how many of what there are it has printed into a file.
"""

import glob
import math
import re
import sys

library, folder = sys.argv[1], sys.argv[2]
with open(sys.argv[3], encoding="utf-8") as printed:
    text = printed.read()
MEMBERS, ORBITS = map(int, re.search(r"^(\d+) satellites, \d+ and (\d+) tops; 0 failed", text, re.M).groups())
POINTS = int(re.search(r"^The section has (\d+) points", text, re.M).group(1))

if library == "polars":
    import polars

    satellites = polars.read_ipc(f"{folder}/satellite/*/*.arrow")
    assert satellites.columns == ["member", "step", "status", "x", "y", "z"], satellites.columns
    last = satellites.filter(polars.col("status") == 1)
    lengths = [math.hypot(*row) for row in satellites.select("x", "y", "z").iter_rows()]
    members, steps = last["member"].to_list(), set(last["step"].to_list())
    section = polars.read_ipc(f"{folder}/section/*/*.arrow")
    crossings = section.explode("t", "nutation", "p2")
    orbits, times = section.height, crossings.group_by("member", maintain_order=True).agg("t")["t"].to_list()
else:
    import pandas

    def read(name):
        files = sorted(glob.glob(f"{folder}/{name}/*/*.arrow"))
        return pandas.concat([read_ipc(file) for file in files], ignore_index=True)

    def read_ipc(file):
        # pandas' own `read_feather` is pyarrow's reader of such files.
        return pandas.read_feather(file)

    satellites = read("satellite")
    assert list(satellites.columns) == ["member", "step", "status", "x", "y", "z"], satellites.columns
    last = satellites[satellites["status"] == 1]
    lengths = [math.hypot(*row) for row in satellites[["x", "y", "z"]].itertuples(index=False)]
    members, steps = last["member"].tolist(), set(last["step"].tolist())
    section = read("section")
    crossings = section.explode(["t", "nutation", "p2"])
    orbits, times = len(section), [list(part) for _, part in crossings.groupby("member")["t"]]

assert members == list(range(MEMBERS)) and len(steps) == 1, (len(members), steps)
assert max(abs(length - 1.0) for length in lengths) < 1e-12
assert orbits == ORBITS and len(times) == ORBITS and sum(map(len, times)) == POINTS, (orbits, len(times), POINTS)
assert all(part == sorted(part) and part[0] > 0.0 for part in times)
print(f"{library}: {len(lengths)} rows of {len(members)} satellites, {sum(map(len, times))} crossings of {orbits} tops")
