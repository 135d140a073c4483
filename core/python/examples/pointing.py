"""How far a satellite's axis is off the Earth, from its two lines and a table of torques: python pointing.py TORQUES.csv"""

import sys

import numpy as np

import liestep as ls

TLE = [
    "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927",
    "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537",
]
J = [0.09, 0.1, 0.03]


def histogram(table, hours=6.0):
    """The times of each ten degrees, as shares; the table has columns of times, s, and of torques, N m, with a head."""
    time, *torque = np.loadtxt(table, delimiter=",", skiprows=1, ndmin=2).T
    orbit = ls.orbit(tle=TLE)
    satellite = ls.body(J, kinetic="cayley") + ls.gravity_gradient(J=J, orbit=orbit)
    satellite += ls.magnetic_damping(k=2e3, field=orbit.field([0, 0, -3e-5]), J=J)
    satellite += ls.torque(ls.signal(time, np.transpose(torque), between="steps"))
    # At the start the satellite keeps to the local vertical.
    start = {"attitude": orbit.local_vertical(), "velocity": [0, -orbit.rate, 0]}
    run = satellite.stepper(2.0).run(**start, until=3600 * hours)
    off = np.degrees(np.arccos((run.axis * orbit.nadir.at(run.time)).sum(axis=1).clip(-1, 1)))
    return np.histogram(off, bins=np.arange(0, 181, 10))[0] / len(run)


if __name__ == "__main__":
    for place, share in enumerate(histogram(sys.argv[1])):
        print(f"{10 * place:3} to {10 * place + 10:3} deg {share:6.1%} {'#' * round(60 * share)}")
