#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Fits the engine's probability: what each number of the evidence is worth, over the modes of a pair and "none of these".

usage: fit_confidence.py [--check] MODES.txt [MODES.txt ...]     (written by benchmarks/engine_modes)

P_i = exp(l_i) / (1 + sum_j exp(l_j)), l = bias + sum_k worth_k(f_k). Each worth is a piecewise linear curve between
quantiles of its feature (right and wrong modes weigh alike in them), which may only rise (or only fall) and is flat beyond
them: no evidence counts for more than it did in any pair seen. Prints the constants of libs/registration/src/confidence.cpp. --check: only a cross-validation that leaves
out one file at a time. Needs python3-scipy.
"""
import os
import sys

import numpy as np
from scipy import optimize

# +1: more is never worth less, -1: never worth more.
SIGNS = {"agreement": 1, "low_absence": -1, "tall_clash": -1, "object_clash": -1, "far_conflict": -1, "contradicted": -1,
         "tall_contradicted": -1, "residual": -1, "objects": 1, "tall_support": 1, "far_support": 1, "landmarks": 1,
         "peak": 1, "rise": 1, "ground": 1, "ground_gap": -1, "near": -1}
QUANTILES = [0.01, 0.12, 0.25, 0.4, 0.6, 0.75, 0.88, 0.99]
RIDGE, ROUGHNESS, STEPS = 0.0003, 0.0006, 500
CALM = 4.0  # how much a pair of different places weighs against one of the same place


def load(files):
    pairs = {}
    for number, name in enumerate(files):
        for line in open(name):
            pair, right, negative, *evidence = line.split()
            entry = pairs.setdefault((number, pair), {"file": name, "negative": negative == "1", "x": [], "right": []})
            values = dict(item.split("=") for item in evidence)
            entry["x"].append([float(values[key]) for key in SIGNS])
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
    return np.clip((np.asarray(x)[:, :, None] - low) / (high - low), 0.0, 1.0)


def fit(pairs):
    knots = knots_of(pairs)
    shape = (len(SIGNS), len(QUANTILES) - 1)
    signs = np.array(list(SIGNS.values()))[:, None]
    climbed = np.concatenate([(ramps(p["x"], knots) * signs).reshape(len(p["x"]), -1) for p in pairs])
    sizes = [len(p["x"]) for p in pairs]
    pair_of = np.repeat(np.arange(len(pairs)), sizes)
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    right = np.concatenate([np.array(p["right"]) / max(1, sum(p["right"])) for p in pairs])
    weight = np.array([CALM if p["negative"] else 1.0 for p in pairs])
    weight /= weight.sum()

    def loss(parameters):
        w, bias = parameters[:-1], parameters[-1]
        odds = climbed @ w + bias
        top = np.maximum(np.maximum.reduceat(odds, first), 0.0)  # of "none of these": 0
        share = np.exp(odds - top[pair_of])
        total = np.add.reduceat(share, first) + np.exp(-top)
        likelihood = np.add.reduceat(odds * right, first) - np.log(total) - top
        slope = (share / total[pair_of] - right) * weight[pair_of]
        bend = np.diff(w.reshape(shape), axis=1)
        rough = np.zeros(shape)
        rough[:, 1:] += bend
        rough[:, :-1] -= bend
        value = -(weight * likelihood).sum() + 0.5 * RIDGE * (w @ w) + 0.5 * ROUGHNESS * (bend ** 2).sum()
        return value, np.append(climbed.T @ slope + RIDGE * w + ROUGHNESS * rough.ravel(), slope.sum())

    start = np.append(np.full(shape[0] * shape[1], 0.1), -3.0)
    bounds = [(0.0, None)] * (len(start) - 1) + [(None, None)]
    found = optimize.minimize(loss, start, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": STEPS})
    rises = found.x[:-1].reshape(shape) * signs
    worth = np.concatenate([np.zeros((shape[0], 1)), np.cumsum(rises, axis=1)], axis=1)
    return knots, worth, found.x[-1]


def log_odds(x, model):
    knots, worth, bias = model
    x = np.asarray(x)
    return bias + sum(np.interp(x[:, k], knots[k], worth[k]) for k in range(len(SIGNS)))


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
          f"{np.sum(given & negative)}; expected calibration error {error:.3f}", flush=True)
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
    print(f"constexpr double kBias = {bias:.3f};")
    print("constexpr std::array<Worth, kFeatures> kWorth = {{")
    for k, name in enumerate(SIGNS):
        numbers = [", ".join(f"{value:.4g}" for value in row) for row in (knots[k], worth[k])]
        print(f"    {{{{{numbers[0]}}}, {{{numbers[1]}}}}},  // {name}")
    print("}};")


if __name__ == "__main__":
    main()
