// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Other libraries as competitors of an experiment, in this process.
#pragma once

#include "loopmark/evaluation/algorithm.hpp"
#include "peers.hpp"

namespace loopmark::benchmarks {

/// Every finder of the library, and "FINDER+REFINER" for each of its refiners. They share what the library makes of a
/// scan.
void add_peers(evaluation::AlgorithmList& list, const PeerLibrary& library);

}  // namespace loopmark::benchmarks
