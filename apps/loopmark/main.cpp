// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "command.hpp"

int main(int argc, char** argv) { return loopmark::app::run(argc, argv); }
