#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Open3D (Debian: python3-open3d) as a competitor of `loopmark evaluate`, through its line protocol.

    loopmark evaluate pairs.txt --data LOGS -o RESULT \\
        --command "open3d=/usr/bin/python3 examples/competitors/open3d_competitor.py ransac" --refine icp

Protocol: the first line is a greeting, answered by "ready NAME". Then "pair SOURCE TARGET" with two files of
float32 x y z intensity, answered by one line: "motion" with the 16 numbers of T_target_source row by row, a score
(a larger one is surer; nan: none) and the seconds that registration took, or "failed REASON". "quit" ends it.
"""
import sys
import time

import numpy as np
import open3d as o3d

VOXEL_M = 0.3
NORMAL_RADIUS_M = 1.2
FEATURE_RADIUS_M = 2.4
MATCH_DISTANCE_M = 0.6
registration = o3d.pipelines.registration


def prepare(path):
    """Points of a file, downsampled, and their FPFH descriptors."""
    points = np.fromfile(path, dtype=np.float32).reshape(-1, 4)[:, :3]
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points.astype(np.float64)))
    cloud = cloud.voxel_down_sample(VOXEL_M)
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(radius=NORMAL_RADIUS_M, max_nn=30))
    search = o3d.geometry.KDTreeSearchParamHybrid(radius=FEATURE_RADIUS_M, max_nn=100)
    return cloud, registration.compute_fpfh_feature(cloud, search)


def ransac(source, target):
    """RANSAC on mutual matches with edge-length and distance checks."""
    return registration.registration_ransac_based_on_feature_matching(
        source[0], target[0], source[1], target[1], True, MATCH_DISTANCE_M,
        registration.TransformationEstimationPointToPoint(False), 3,
        [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
         registration.CorrespondenceCheckerBasedOnDistance(MATCH_DISTANCE_M)],
        registration.RANSACConvergenceCriteria(100000, 0.999))


def fgr(source, target):
    """Fast global registration."""
    return registration.registration_fgr_based_on_feature_matching(
        source[0], target[0], source[1], target[1],
        registration.FastGlobalRegistrationOption(maximum_correspondence_distance=MATCH_DISTANCE_M))


def answer(method, source_path, target_path):
    source, target = prepare(source_path), prepare(target_path)
    start = time.perf_counter()
    result = method(source, target)
    seconds = time.perf_counter() - start
    numbers = [repr(float(x)) for x in np.asarray(result.transformation).ravel()]
    return "motion " + " ".join(numbers) + f" {float(result.fitness)!r} {seconds:.6f}"


def main():
    methods = {"ransac": ransac, "fgr": fgr}
    name = sys.argv[1] if len(sys.argv) > 1 else "ransac"
    o3d.utility.set_verbosity_level(o3d.utility.VerbosityLevel.Error)
    o3d.utility.random.seed(0)
    for line in sys.stdin:
        words = line.split()
        if words[0] == "quit":
            break
        if words[0] == "pair":
            try:
                reply = answer(methods[name], words[1], words[2])
            except Exception as error:  # one bad pair must not end the competition
                reply = f"failed {error}".replace("\n", " ")
        else:
            reply = f"ready open3d-{name}"
        print(reply, flush=True)


if __name__ == "__main__":
    main()
