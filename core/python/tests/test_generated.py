"""Random right declarations on all groups and products of groups: few are refused, and their steps are those of the text.

Each momentum before and after a step is compared with differences of the Lagrangian of the step in NumPy, which shares
no code with the derivation. All of 3,000, some minutes: ``LIESTEP_GENERATED=3000 pytest tests/test_generated.py -s``;
``LIESTEP_SEED`` is the first of the seeds.
"""

from __future__ import annotations

import collections
import os

import numpy as np
import pytest

pytest.importorskip("scipy", reason="SciPy isn't there")

from generated import Generated

import liestep as ls

COUNT, FIRST = int(os.environ.get("LIESTEP_GENERATED", "60")), int(os.environ.get("LIESTEP_SEED", "1"))


def apart(made: Generated, step: tuple[list, list, float], found: tuple[np.ndarray, np.ndarray]) -> float:
    """The largest difference of the momenta before and after a step, relative to the momenta.

    Differences of wild functions need a short distance, and those of tame ones a long one: the nearest of five counts, as a
    wrong momentum is near none.
    """
    least = np.inf
    for distance in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        expected = made.momenta(*step, distance)
        scale = 1e-3 + sum(abs(one).sum() for one in expected)
        least = min(least, max(abs(one - own).max() for one, own in zip(expected, found)) / scale)
        if least < 1e-9:
            break
    return least


def error(made: Generated, term: ls.Term, seed: int) -> float | None:
    """The largest difference of a momentum in two steps; none where no step has a solution.

    Differences say nothing about a step in which a wild function throws the body away: a shorter one decides.
    """
    random = np.random.default_rng(seed)
    start = [factor.element(random, 0.5) for factor in made.factors]
    velocity = 0.3 * random.normal(size=sum(factor.dimension for factor in made.factors))
    matrices = [factor.matrix(one) for factor, one in zip(made.factors, start)]
    attitude = matrices[0] if len(matrices) == 1 else np.concatenate([one.ravel() for one in matrices])
    found = None
    for h in (0.05, 0.005, 0.0005):
        try:
            state, found, g = term.stepper(h).start(velocity=velocity, attitude=attitude), 0.0, start
            for _ in range(2):
                before = state.momentum
                state.step()
                attitudes = [state.attitude] if len(g) == 1 else state.attitude
                after = [factor.of_matrix(one) for factor, one in zip(made.factors, attitudes)]
                found, g = max(found, apart(made, (g, after, h), (before, state.momentum))), after
        except (ls.SetupError, ls.StepError):
            found = None
        if found is not None and found < 1e-7:
            break
    return found


def test_right_declarations_are_taken_and_their_steps_are_right():
    refused, wrong, outcome = [], [], collections.Counter()
    for seed in range(FIRST, FIRST + COUNT):
        made = Generated(seed)
        groups = {factor.name: factor.group for factor in made.factors}
        outcome.update(groups.values())
        try:
            term = made.term()
        except ls.Error as mistake:
            refused.append((seed, str(mistake), groups, made.rule, made.sum.text, made.work and made.work.text))
            continue
        found = error(made, term, seed)
        outcome["no solution" if found is None else "compared"] += 1
        if found is not None and not found < 1e-7:
            wrong.append((seed, found, groups, made.rule, made.sum.text, made.work and made.work.text))
    print(f"{COUNT} declarations from the seed {FIRST}: {len(refused)} refused, {len(wrong)} wrong, {dict(outcome)}")
    assert not wrong and 1000 * len(refused) <= COUNT, (wrong, refused)
    assert outcome["compared"] > 0.9 * COUNT
