"""Reads an ensemble's files as they are: python read.py polars|pandas FOLDER, with the folder of the example."""

import glob
import math
import sys

library, folder = sys.argv[1], sys.argv[2]
MEMBERS, ORBITS = 256, 32

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

assert members == list(range(MEMBERS)) and steps == {4000}, (len(members), steps)
assert max(abs(length - 1.0) for length in lengths) < 1e-12
assert orbits == ORBITS and len(times) == ORBITS
assert all(part == sorted(part) and 0.0 < part[0] and part[-1] <= 80.0 for part in times)
print(f"{library}: {len(lengths)} rows of {len(members)} satellites, {sum(map(len, times))} crossings of {orbits} tops")
