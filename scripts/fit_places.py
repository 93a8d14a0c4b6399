#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Fits relocalization's probability: a conditional logit model over all answers to a scan and "none of these".

usage: fit_places.py ANSWERS.txt [ANSWERS.txt ...]     (written by benchmarks/relocalization.py fitting)
P_i = exp(l_i) / (1 + sum_j exp(l_j)), l_i = e_i + w s_i + v . (g_i - g_best). e: the engine's log-odds of the answer, taken
as they are, so that "none of these" rests on the many pairs that the engine was fitted to; s: how far its place's signature
lags behind the most alike one; g: evidence that is compared with that of the answer of which the engine is surest: where
several places fit, it says which fits better. Scans of one
file are one fold of the cross-validation (a town that was not fitted judges). Prints the constants of
libs/localization/src/place_confidence.cpp. Needs python3-numpy.
"""
import sys

import numpy as np

# +1: the weight may not be negative, -1: not positive.
SIGNS = {"registration": 1, "descriptor_lag": -1}
COMPARED = {"agreement": 1, "low_missing": -1, "tall_strong_violation": -1, "far_violation": -1, "ground_gap": -1}
MOST_LAG = 0.03  # a lag beyond it says no more: another sensor or a changed place may lag far
WEIGHTS = {**SIGNS, **COMPARED}
RIDGE, STEPS, RATE, WRONG = 0.003, 3000, 0.03, 0.5
RIGHT_M, RIGHT_DEG = 0.6, 5.0


def load(file):
    scans = {}
    for line in open(file):
        scan, _, _, error_m, error_deg, _, _, _, *evidence = line.split()
        entry = scans.setdefault(scan, {"x": [], "right": []})
        if not evidence:
            continue
        values = {name: float(value) for name, value in (item.split("=") for item in evidence)}
        values["descriptor_lag"] = min(values["descriptor_lag"], MOST_LAG)
        entry["x"].append([values[key] for key in WEIGHTS])
        entry["right"].append(float(error_m) < RIGHT_M and float(error_deg) < RIGHT_DEG)
    for entry in scans.values():
        if entry["x"]:
            x = np.array(entry["x"])
            best = x[x[:, 0].argmax()]
            x[:, len(SIGNS):] -= best[len(SIGNS):]
            entry["x"] = x
    return list(scans.values())


def pack(scans):
    n, m = len(scans), max([len(s["x"]) for s in scans] + [1])
    x, there, right = np.zeros((n, m, len(WEIGHTS))), np.zeros((n, m)), np.zeros((n, m))
    for row, s in enumerate(scans):
        count = len(s["x"])
        if count:
            x[row, :count], there[row, :count] = s["x"], 1
            right[row, :count] = np.array(s["right"], float) / max(1, sum(s["right"]))
    return x, there, right


def probabilities(x, there, w):
    odds = np.where(there > 0, x @ w, -1e9)
    top = np.maximum(odds.max(1), 0.0)[:, None]
    share = np.exp(odds - top) * there
    return share / (share.sum(1, keepdims=True) + np.exp(-top))


def fit(scans):
    x, there, right = pack(scans)
    scale = np.sqrt((x ** 2).sum((0, 1)) / there.sum()) + 1e-9
    signs = np.array(list(WEIGHTS.values()))
    x = x / scale
    w = np.zeros(len(WEIGHTS))
    w[0] = scale[0]
    m, v = np.zeros(len(WEIGHTS)), np.zeros(len(WEIGHTS))
    for step in range(1, STEPS + 1):
        slope = (probabilities(x, there, w) - right) * there
        g = np.einsum("ij,ijk->k", slope, x) / len(scans) + RIDGE * w
        g[0] = 0.0
        m, v = 0.9 * m + 0.1 * g, 0.999 * v + 0.001 * g * g
        w = w - RATE * (m / (1 - 0.9 ** step)) / (np.sqrt(v / (1 - 0.999 ** step)) + 1e-8)
        w = np.where(signs > 0, np.maximum(w, 0), np.minimum(w, 0))
    return w / scale


def judge(scans, w):
    x, there, right = pack(scans)
    p = probabilities(x, there, w)
    best = p.argmax(1)
    top, good = p.max(1), right[np.arange(len(scans)), best] > 0
    return top, good, right.sum(1) > 0


def report(name, top, good, findable):
    given = top >= 0.5
    bins = np.minimum((top * 10).astype(int), 9)
    error = sum((bins == k).mean() * abs(top[bins == k].mean() - good[bins == k].mean()) for k in set(bins))
    print(f"{name}: {len(top)} scans, right among the answers {findable.sum()}, given and right {np.sum(given & good)}, "
          f"given and wrong {np.sum(given & ~good)}, expected calibration error {error:.3f}")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    files = [load(name) for name in sys.argv[1:]]
    if len(files) > 1:
        parts = [judge(files[i], fit([s for k, f in enumerate(files) if k != i for s in f])) for i in range(len(files))]
        for name, part in zip(sys.argv[1:], parts):
            report("left out " + name, *part)
        report("all, each left out", *(np.concatenate(column) for column in zip(*parts)))
    scans = [s for f in files for s in f]
    w = fit(scans)
    report("fitted", *judge(scans, w))
    for name, weight in zip(WEIGHTS, w):
        print(f"{name:16} {weight:.4f}")


if __name__ == "__main__":
    main()
