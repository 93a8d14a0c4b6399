#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Fits the engine's probability: a conditional logit model over the modes of a pair and "none of these".

usage: fit_confidence.py MODES.txt [MODES.txt ...]     (written by benchmarks/engine_modes)
P_i = exp(w . f_i + b) / (1 + sum_j exp(w . f_j + b)). Prints a four-fold cross-validation and the constants of
libs/registration/src/confidence.cpp. Needs python3-numpy.
"""
import random
import sys

import numpy as np

# +1: the weight may not be negative, -1: not positive, 0: free.
SIGNS = {"agreement": 1, "low_presence": 1, "low_conflict": -1, "tall_presence": 1, "tall_conflict": -1, "normals": 1,
         "tightness": 1, "residual": -1, "peak": 1, "support": 1, "spread": 1, "constraint": 1, "surplus": 0}
RIDGE, STEPS, RATE = 0.003, 1500, 0.03


def load(files):
    pairs = {}
    for number, name in enumerate(files):
        for line in open(name):
            pair, right, negative, *evidence = line.split()
            entry = pairs.setdefault((number, pair), {"negative": negative == "1", "x": [], "right": []})
            values = dict(item.split("=") for item in evidence)
            entry["x"].append([float(values[key]) for key in SIGNS])
            entry["right"].append(int(right))
    return list(pairs.values())


def probabilities(pair, weights, bias):
    odds = np.array(pair["x"]) @ weights + bias
    top = max(odds.max(), 0.0)
    share = np.exp(odds - top)
    return share / (share.sum() + np.exp(-top))


def fit(pairs):
    every = np.concatenate([np.array(p["x"]) for p in pairs])
    mean, spread = every.mean(0), every.std(0) + 1e-9
    signs = np.array(list(SIGNS.values()))
    shape = (len(pairs), max(len(p["x"]) for p in pairs))
    x, there, right = np.zeros(shape + (len(signs),)), np.zeros(shape), np.zeros(shape)
    for row, p in enumerate(pairs):
        n = len(p["x"])
        x[row, :n] = (np.array(p["x"]) - mean) / spread
        there[row, :n] = 1
        right[row, :n] = np.array(p["right"]) / max(1, sum(p["right"]))
    w, m, v = (np.zeros(len(signs) + 1) for _ in range(3))
    for step in range(1, STEPS + 1):
        odds = np.where(there > 0, x @ w[:-1] + w[-1], -1e9)
        top = np.maximum(odds.max(1), 0.0)[:, None]
        share = np.exp(odds - top) * there
        slope = (share / (share.sum(1, keepdims=True) + np.exp(-top)) - right) * there
        g = np.append(np.einsum("ij,ijk->k", slope, x), slope.sum()) / len(pairs)
        g[:-1] += RIDGE * w[:-1]
        m, v = 0.9 * m + 0.1 * g, 0.999 * v + 0.001 * g * g
        w -= RATE * (m / (1 - 0.9 ** step)) / (np.sqrt(v / (1 - 0.999 ** step)) + 1e-8)
        w[:-1] = np.where(signs > 0, np.maximum(w[:-1], 0), np.where(signs < 0, np.minimum(w[:-1], 0), w[:-1]))
    weights = w[:-1] / spread
    return weights, w[-1] - weights @ mean


def cross_validate(pairs):
    order = list(range(len(pairs)))
    random.Random(2).shuffle(order)
    p, right, negative = [], [], []
    for fold in range(4):
        weights, bias = fit([pairs[i] for k, i in enumerate(order) if k % 4 != fold])
        for i in order[fold::4]:
            answer = probabilities(pairs[i], weights, bias)
            best = int(answer.argmax())
            p.append(answer[best])
            right.append(pairs[i]["right"][best])
            negative.append(pairs[i]["negative"])
    p, right, negative = np.array(p), np.array(right), np.array(negative)
    given = p >= 0.5
    bins = np.minimum((p * 10).astype(int), 9)
    error = sum((bins == b).mean() * abs(p[bins == b].mean() - right[bins == b].mean()) for b in set(bins))
    print(f"positives {np.sum(~negative)}: best mode right {right[~negative].mean():.3f}, "
          f"answered {given[~negative].mean():.3f}, wrong among them {np.sum(given & ~negative & (right == 0))}")
    print(f"negatives {np.sum(negative)}: answered {np.sum(given & negative)}; expected calibration error {error:.3f}")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    pairs = load(sys.argv[1:])
    cross_validate(pairs)
    weights, bias = fit(pairs)
    print(f"constexpr double kBias = {bias:.4f};")
    print("constexpr Features kWeights = {" + ", ".join(f"{w:.4f}" for w in weights) + "};")


if __name__ == "__main__":
    main()
