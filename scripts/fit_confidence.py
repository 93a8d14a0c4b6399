#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Fits the engine's probability: what each number of the evidence is worth, over the modes of a pair and "none of these".

usage: fit_confidence.py [--check] MODES.txt [MODES.txt ...]     (written by benchmarks/engine_modes)

P_i = exp(l_i) / (1 + sum_j exp(l_j)), l = bias + sum_k worth_k(f_k). Each worth is a piecewise linear curve between
quantiles of its feature, which may only rise (or only fall) and is flat beyond them: no evidence counts for more than it did
in any pair seen. Prints the constants of libs/registration/src/confidence.cpp. --check: only a cross-validation that leaves
out one file at a time. Needs python3-numpy.
"""
import os
import sys

import numpy as np

# +1: more is never worth less, -1: never worth more.
SIGNS = {"agreement": 1, "low_presence": 1, "low_conflict": -1, "low_clash": -1, "tall_presence": 1, "tall_conflict": -1,
         "tall_clash": -1, "explained": 1, "normals": 1, "tightness": 1, "residual": -1, "peak": 1, "lead": 1,
         "support": 1, "tall_support": 1, "spread": 1, "constraint": 1, "ground": 1, "ground_gap": -1, "near": -1}
QUANTILES = [0.02, 0.2, 0.4, 0.6, 0.8, 0.98]
RIDGE, ROUGHNESS, STEPS, RATE = 0.0005, 0.001, 2500, 0.02
CALM = 3.0  # how much a pair of different places weighs against one of the same place


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
    every = np.concatenate([np.array(p["x"]) for p in pairs])
    knots = np.quantile(every, QUANTILES, axis=0).T
    return np.maximum.accumulate(knots + 1e-6 * np.arange(len(QUANTILES)), axis=1)


def ramps(x, knots):
    """Each feature as the shares of its segments that it has climbed: (rows, features, segments)."""
    low, high = knots[:, :-1], knots[:, 1:]
    return np.clip((np.asarray(x)[:, :, None] - low) / (high - low), 0.0, 1.0)


def fit(pairs):
    knots = knots_of(pairs)
    features, segments = len(SIGNS), len(QUANTILES) - 1
    signs = np.repeat(np.array(list(SIGNS.values())), segments)
    shape = (len(pairs), max(len(p["x"]) for p in pairs))
    x, there, right = np.zeros(shape + (features * segments,)), np.zeros(shape), np.zeros(shape)
    weight = np.array([CALM if p["negative"] else 1.0 for p in pairs])
    for row, p in enumerate(pairs):
        n = len(p["x"])
        x[row, :n] = ramps(p["x"], knots).reshape(n, -1) * signs
        there[row, :n] = 1
        right[row, :n] = np.array(p["right"]) / max(1, sum(p["right"]))
    w, bias = np.full(features * segments, 0.1), -3.0
    m, v = np.zeros(len(w) + 1), np.zeros(len(w) + 1)
    for step in range(1, STEPS + 1):
        odds = np.where(there > 0, x @ w + bias, -1e9)
        top = np.maximum(odds.max(1), 0.0)[:, None]
        share = np.exp(odds - top) * there
        slope = (share / (share.sum(1, keepdims=True) + np.exp(-top)) - right) * there * weight[:, None]
        g = np.append(np.einsum("ij,ijk->k", slope, x), slope.sum()) / weight.sum()
        curve = w.reshape(features, segments)
        bend = np.diff(curve, axis=1)
        rough = np.zeros_like(curve)
        rough[:, 1:] += bend
        rough[:, :-1] -= bend
        g[:-1] += RIDGE * w + ROUGHNESS * rough.ravel()
        m, v = 0.9 * m + 0.1 * g, 0.999 * v + 0.001 * g * g
        change = RATE * (m / (1 - 0.9 ** step)) / (np.sqrt(v / (1 - 0.999 ** step)) + 1e-8)
        w, bias = np.maximum(w - change[:-1], 0.0), bias - change[-1]
    worth = np.concatenate([np.zeros((features, 1)), np.cumsum((w * signs).reshape(features, segments), axis=1)], axis=1)
    return knots, worth, bias


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
