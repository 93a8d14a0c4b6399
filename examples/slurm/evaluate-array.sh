#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs `loopmark evaluate` as a Slurm job array, one shard of the pairs a task, and merges the result when all are done.
# A task that is lost (killed, node gone) is sent again with the same command: it resumes where it was.
#
#   examples/slurm/evaluate-array.sh SHARDS RESULT SET [options of loopmark evaluate ...]
#   examples/slurm/evaluate-array.sh 8 /shared/result pairs.txt --data /shared/logs --algorithms engine
#
# SET, RESULT and the data must lie where every node sees them. LOOPMARK names the program (loopmark).
set -euo pipefail

if [[ $# -lt 3 ]]; then
  sed -n '5,12p' "$0" >&2
  exit 2
fi
shards=$1 result=$2 set_file=$3
shift 3
program=${LOOPMARK:-loopmark}

mkdir -p "$result/logs"
command=$(printf '%q ' "$program" evaluate "$set_file" -o "$result" "$@")

# --requeue: Slurm itself sends a task again when its node fails.
job=$(sbatch --parsable --array="1-$shards" --requeue --job-name=loopmark-evaluate \
  --output="$result/logs/shard-%a.log" --open-mode=append \
  --wrap="exec $command --quiet --shard \$SLURM_ARRAY_TASK_ID/$shards")
echo "job array $job of $shards shards; logs in $result/logs"

merge=$(sbatch --parsable --dependency="afterany:$job" --job-name=loopmark-merge \
  --output="$result/logs/merge.log" --wrap="exec $(printf '%q ' "$program" evaluate merge "$result")")
echo "merge job $merge; it names the shards that are missing, if any: send those again with"
echo "  $command --shard K/$shards   (then: $program evaluate merge $result)"
