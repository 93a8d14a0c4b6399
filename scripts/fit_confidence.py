#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Fits the engine's probability: what each number of the evidence is worth, over the modes of a pair and "none of these".

usage: fit_confidence.py [--check] MODES.txt [MODES.txt ...]     (written by benchmarks/engine_modes)

P_i = exp(l_i) / (1 + sum_j exp(l_j)), l = sum_s share_s (bias_s + sum_k worth_sk(f_k)). The scenes s: little or much
structure to ask about, sensors near to each other or far apart, few or many beams in either scan; a pair may be a share of
each (see scenes()). Each worth is a piecewise linear curve between quantiles of its feature (right and wrong modes weigh alike
in them), which may only rise (or only fall) and is flat beyond them: no evidence counts for more than it did in any pair seen.
Prints libs/registration/src/confidence_curves.hpp. --check: only a cross-validation that leaves out one file at a time. Needs
python3-scipy.
"""
import os
import sys

import numpy as np
from scipy import optimize

# +1: more is never worth less, -1: never worth more.
SIGNS = {"agreement": 1, "low_missing": -1, "tall_strong_violation": -1, "object_strong_violation": -1, "far_violation": -1, "contradicted": -1,
         "tall_contradicted": -1, "residual": -1, "objects": 1, "peak": 1, "rise": 1, "ground": 1, "ground_gap": -1, "proximity": -1}
# What tells the scene, and is worth nothing by itself: a fit has not as many pairs of the same place in every scene as the world.
OF_SCENE = ["structure_fewer", "density_ratio", "density_ratio_more"]
COLUMNS = [*SIGNS, *OF_SCENE]
QUANTILES = [0.01, 0.12, 0.25, 0.4, 0.6, 0.75, 0.88, 0.99]
RIDGE, ROUGHNESS, STEPS = 0.0001, 0.0002, 800
LITTLE, MUCH = 5.5, 7.5  # structure of the scan that has fewer, logarithmic
NEAR_M, FAR_M = 10.0, 50.0  # between the sensors
SPARSE, DENSE = 1.0, 1.25  # fine surfels in a coarse one, logarithmic, of the scan that has fewer
BOTH_SPARSE, ONE_DENSE = 1.05, 1.3  # of the other
SCENES = ["little structure", "much structure", "proximity", "far", "one is sparse", "both are dense", "both are sparse",
          "one is dense"]
CALM = 2.0  # how much a pair of different places weighs against one of the same place


def load(files):
    pairs = {}
    for number, name in enumerate(files):
        for line in open(name):
            pair, right, negative, *evidence = line.split()
            entry = pairs.setdefault((number, pair), {"file": name, "negative": negative == "1", "x": [], "right": []})
            values = dict(item.split("=") for item in evidence)
            entry["x"].append([float(values[key]) for key in COLUMNS])
            entry["right"].append(int(right))
    return list(pairs.values())


def knots_of(pairs):
    x = np.concatenate([np.array(p["x"]) for p in pairs])
    right = np.concatenate([np.array(p["right"]) for p in pairs]) > 0
    share = np.where(right, 0.5 / max(1, right.sum()), 0.5 / max(1, (~right).sum()))
    knots = np.empty((len(SIGNS), len(QUANTILES)))
    for k in range(len(SIGNS)):
        order = np.argsort(x[:, k], kind="stable")
        knots[k] = np.interp(QUANTILES, np.cumsum(share[order]), x[order, k])
    return np.maximum.accumulate(knots + 1e-6 * np.arange(len(QUANTILES)), axis=1)


def ramps(x, knots):
    """Each feature as the shares of its segments that it has climbed: (rows, features, segments)."""
    low, high = knots[:, :-1], knots[:, 1:]
    return np.clip((np.asarray(x)[:, :len(SIGNS), None] - low) / (high - low), 0.0, 1.0)


def scenes(x):
    """How much of each scene the rows are: (rows, scenes). Each two of them are shares of one."""
    x = np.asarray(x)
    column = lambda name: x[:, COLUMNS.index(name)]
    much = np.clip((column("structure_fewer") - LITTLE) / (MUCH - LITTLE), 0.0, 1.0)
    apart_m = -10.0 * np.log(np.maximum(column("proximity"), 1e-9))
    far = np.clip((apart_m - NEAR_M) / (FAR_M - NEAR_M), 0.0, 1.0)
    both_dense = np.clip((column("density_ratio") - SPARSE) / (DENSE - SPARSE), 0.0, 1.0)
    one_dense = np.clip((column("density_ratio_more") - BOTH_SPARSE) / (ONE_DENSE - BOTH_SPARSE), 0.0, 1.0)
    return np.stack([1.0 - much, much, 1.0 - far, far, 1.0 - both_dense, both_dense, 1.0 - one_dense, one_dense], axis=1)


def design(x, knots, signs):
    """The rows of a linear model: for each scene what each feature has climbed, then the scenes themselves."""
    share = scenes(x)
    climbed = (ramps(x, knots) * signs).reshape(len(x), -1)
    return np.concatenate([(share[:, :, None] * climbed[:, None, :]).reshape(len(x), -1), share], axis=1)


def fit(pairs):
    knots = knots_of(pairs)
    shape = (len(SCENES), len(SIGNS), len(QUANTILES) - 1)
    signs = np.array(list(SIGNS.values()))[:, None]
    rows = design(np.concatenate([p["x"] for p in pairs]), knots, signs)
    sizes = [len(p["x"]) for p in pairs]
    pair_of = np.repeat(np.arange(len(pairs)), sizes)
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    right = np.concatenate([np.array(p["right"]) / max(1, sum(p["right"])) for p in pairs])
    weight = np.array([CALM if p["negative"] else 1.0 for p in pairs])
    weight /= weight.sum()
    rises = int(np.prod(shape))

    def loss(parameters):
        w = parameters[:rises]
        odds = rows @ parameters
        top = np.maximum(np.maximum.reduceat(odds, first), 0.0)  # of "none of these": 0
        share = np.exp(odds - top[pair_of])
        total = np.add.reduceat(share, first) + np.exp(-top)
        likelihood = np.add.reduceat(odds * right, first) - np.log(total) - top
        slope = (share / total[pair_of] - right) * weight[pair_of]
        bend = np.diff(w.reshape(shape), axis=2)
        rough = np.zeros(shape)
        rough[:, :, 1:] += bend
        rough[:, :, :-1] -= bend
        gradient = rows.T @ slope
        gradient[:rises] += RIDGE * w + ROUGHNESS * rough.ravel()
        value = -(weight * likelihood).sum() + 0.5 * RIDGE * (w @ w) + 0.5 * ROUGHNESS * (bend ** 2).sum()
        return value, gradient

    start = np.concatenate([np.full(rises, 0.05), np.full(len(SCENES), -1.0)])
    bounds = [(0.0, None)] * rises + [(None, None)] * len(SCENES)
    found = optimize.minimize(loss, start, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": STEPS})
    climbs = found.x[:rises].reshape(shape) * signs
    worth = np.concatenate([np.zeros((*shape[:2], 1)), np.cumsum(climbs, axis=2)], axis=2)
    return knots, worth, found.x[rises:]


def log_odds(x, model):
    knots, worth, bias = model
    x = np.asarray(x)
    of_scenes = [bias[s] + sum(np.interp(x[:, k], knots[k], worth[s, k]) for k in range(len(SIGNS)))
                 for s in range(len(SCENES))]
    return (scenes(x) * np.stack(of_scenes, axis=1)).sum(axis=1)


def probabilities(odds):
    top = max(odds.max(), 0.0)
    share = np.exp(odds - top)
    return share / (share.sum() + np.exp(-top))


def report(name, pairs, model):
    best = []
    for pair in pairs:
        p = probabilities(log_odds(pair["x"], model))
        k = int(p.argmax())
        best.append((p[k], pair["right"][k], pair["negative"], max(pair["right"])))
    p, right, negative, found = (np.array(column) for column in zip(*best))
    given = p >= 0.5
    bins = np.minimum((p * 10).astype(int), 9)
    error = sum((bins == b).mean() * abs(p[bins == b].mean() - right[bins == b].mean()) for b in set(bins))
    print(f"{name:>12}: same place {np.sum(~negative)}, a right mode {found[~negative].mean():.3f}, the best one right "
          f"{right[~negative].mean():.3f}, answered {given[~negative].mean():.3f}, wrong among them "
          f"{np.sum(given & ~negative & (right == 0))}; different places {np.sum(negative)}, answered "
          f"{np.sum(given & negative)}; expected calibration error {error:.3f}", file=sys.stderr, flush=True)
    return best


def main():
    files = [a for a in sys.argv[1:] if a != "--check"]
    if not files:
        sys.exit(__doc__)
    pairs = load(files)
    if "--check" in sys.argv:
        for name in files:
            model = fit([p for p in pairs if p["file"] != name])
            report(os.path.basename(name)[:-4], [p for p in pairs if p["file"] == name], model)
        return
    knots, worth, bias = fit(pairs)
    report("all", pairs, (knots, worth, bias))
    print_header(knots, worth, bias)


HEAD = """// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What each number of the evidence is worth in each scene. Written by scripts/fit_confidence.py, in the order of
/// kFeatureNames and of mixture_weights().
#pragma once

#include "confidence.hpp"

namespace loopmark {

// clang-format off"""


def print_header(knots, worth, bias):
    row = lambda numbers: "{" + ", ".join(f"{value:.4g}" for value in numbers) + "}"
    print(HEAD)
    print(f"constexpr double kLittle = {LITTLE};  // structure of the scan that has fewer, logarithmic")
    print(f"constexpr double kMuch = {MUCH};")
    print(f"constexpr double kNear = {NEAR_M};  // metres between the sensors")
    print(f"constexpr double kFar = {FAR_M};")
    print(f"constexpr double kSparse = {SPARSE};  // fine surfels in a coarse one, logarithmic, of the scan that has fewer")
    print(f"constexpr double kDense = {DENSE};")
    print(f"constexpr double kBothSparse = {BOTH_SPARSE};  // of the other")
    print(f"constexpr double kOneDense = {ONE_DENSE};")
    print(f"constexpr std::array<double, kScenes> kBias = {row(bias)};")
    print("constexpr std::array<WeightCurve, kWeighed> kWeightCurves = {{")
    for k, name in enumerate(SIGNS):
        curves = ",\n      ".join(row(worth[s, k]) for s in range(len(SCENES)))
        print(f"    {{{row(knots[k])},  // {name}\n     {{{{{curves}}}}}}},")
    print("}};\n// clang-format on\n\n}  // namespace loopmark")


if __name__ == "__main__":
    main()
