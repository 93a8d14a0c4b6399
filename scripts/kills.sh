#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Kills loopmark at random moments of map, merge, extend, relocalize, evaluate, balance and drill, goes on, and compares
# every byte with runs that nobody killed.   scripts/kills.sh [--kills N] [--seed S] [--commands map,merge]
exec python3 "$(dirname "${BASH_SOURCE[0]}")/hard/kills.py" "$@"
