"""The free rigid body's exact motion, by Jacobi's elliptic functions, and how far a computed one is from it.

Where `M² > 2 T I_2`, the rates about the axes of the least, middle and greatest moment are `A_1 cn u`, `A_2 sn u` and
`A_3 dn u` with `u = ω t + u_0`; else the least and the greatest change places. A flip is half a period of `sn`.
"""

import mpmath
import numpy as np
from scipy.special import ellipkinc


class Exact:
    """The motion from moments of inertia, kg m², and body rates, rad/s, at the time zero."""

    def __init__(self, moments, rates):
        self.moments, self.rates = np.array(moments, float), np.array(rates, float)
        self.energy = float(np.sum(self.moments * self.rates**2) / 2)
        self.momentum = self.moments * self.rates
        order = np.argsort(self.moments, kind="stable")
        with mpmath.workdps(40):
            i = [mpmath.mpf(float(m)) for m in self.moments[order]]
            w = [mpmath.mpf(float(r)) for r in self.rates[order]]
            # M² − 2 T I_k, as a sum whose terms don't cancel for the middle moment alone.
            apart = [mpmath.fsum(i[j] * (i[j] - i[k]) * w[j] ** 2 for j in range(3)) for k in range(3)]
            if apart[1] < 0:
                order, i, w, apart = order[::-1], i[::-1], w[::-1], apart[::-1]
            self.order = order
            first = mpmath.sqrt(apart[2] / (i[0] * (i[0] - i[2])))
            second = mpmath.sqrt(apart[2] / (i[1] * (i[1] - i[2])))
            self.rate = mpmath.sqrt((i[2] - i[1]) * apart[0] / (i[0] * i[1] * i[2]))
            self.parameter = mpmath.mpf(1) - (i[2] - i[0]) * apart[1] / ((i[2] - i[1]) * apart[0])
            # Two of the three signs may change together.
            self.sign = 1 if w[2] >= 0 else -1
            self.half = 2 * mpmath.ellipk(self.parameter)
            self.amplitudes = float(first), float(second), float(mpmath.sqrt(apart[0] / (i[2] * (i[2] - i[0]))))
            self.start = mpmath.ellipf(mpmath.atan2(self.sign * w[1] / second, w[0] / first), self.parameter)

    @property
    def period(self):
        """The time in which the rates return, which is two flips, s."""
        return float(2 * self.half / self.rate)

    def rates_at(self, t):
        """The body rates at a time, rad/s."""
        with mpmath.workdps(40):
            u = self.rate * mpmath.mpf(t) + self.start
            cn, sn, dn = (mpmath.ellipfun(name, u, m=self.parameter) for name in ("cn", "sn", "dn"))
        rates = np.empty(3)
        rates[self.order] = np.array(self.amplitudes) * [float(cn), self.sign * float(sn), self.sign * float(dn)]
        return rates

    def phase(self, times, rates):
        """How many flips a computed motion is ahead at each time, and where that is known to more than a quarter flip.

        The motion lingers at the middle axis, where a small error of the energy hides the phase: only what is read near
        a flip tells it.
        """
        first, second, _ = self.amplitudes
        x, y = rates[:, self.order[0]] / first, self.sign * rates[:, self.order[1]] / second
        parameter, half = float(self.parameter), float(self.half)
        with np.errstate(invalid="ignore"):
            angle = np.unwrap(np.arctan2(y, x))
        # The start is unwrapped to where the exact motion has its own.
        start = float(self.start)
        angle += np.pi * 2 * np.round((np.pi * start / half - angle[0]) / (2 * np.pi))
        halves = np.round(angle / np.pi)
        rest = angle - halves * np.pi
        flips = halves + ellipkinc(rest, parameter) / half
        exact = np.array(float(self.rate) * times + start) / half
        sharp = np.sqrt(np.maximum(1 - parameter * np.sin(rest) ** 2, 0)) > 0.35
        return flips - exact, sharp


def check():
    """Compares the elliptic functions with an integrator that knows nothing of them, and prints the differences."""
    from scipy.integrate import solve_ivp

    for moments, rates in [((1, 2, 3), (0.05, 10, 0.1)), ((1, 2, 3), (0.1, 10, 0.05)), ((3, 3, 4), (1, 0, -9)),
                           ((0.02, 1, 1), (9.5, 3, -1)), ((1, 1.25, 2.25), (6, -6, 5)), ((3, 1, 2), (1, -2, 3))]:
        exact, i = Exact(moments, rates), np.array(moments, float)
        times = np.linspace(0, 7, 71)
        run = solve_ivp(lambda t, w: np.cross(i * w, w) / i, (0, 7), rates, "DOP853", rtol=1e-13, atol=1e-14, t_eval=times)
        apart = max(np.abs(exact.rates_at(t) - y).max() for t, y in zip(times, run.y.T))
        ahead, sharp = exact.phase(times, run.y.T)
        ahead = np.abs(ahead[sharp]).max()
        print(f"moments {moments}, rates {rates}: apart {apart:.1e} rad/s, phase {ahead:.1e} flips")
        if not max(apart, ahead) < 1e-9:
            raise SystemExit("the elliptic functions aren't the motion")
    period = Exact((1, 2, 3), (0.01, 2, 0.02)).period
    print(f"period of the row B7 of hard-cases: {period:.12f} s")
    if abs(period - 19.00163551100025) > 1e-11:
        raise SystemExit("it isn't that of the row, 19.00163551100025 s")


if __name__ == "__main__":
    check()
