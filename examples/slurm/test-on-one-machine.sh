#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Tests the job array on one machine: starts a Slurm of its own (Debian: slurm-wlm, munge), runs a made-up set of 60 pairs
# with a competitor that takes its time in shards, kills one task while it works, sends the array again, and compares the
# merged result with that of one process, byte for byte.
# Exit code 77: skipped, because Slurm is not installed, or cannot be started here (it needs root).
#
#   examples/slurm/test-on-one-machine.sh LOOPMARK
set -euo pipefail

for tool in sbatch slurmctld slurmd munged squeue; do
  if ! PATH=$PATH:/usr/sbin command -v "$tool" >/dev/null; then
    echo "skipped: $tool is not installed (scripts/install-dependencies.sh --peers)"
    exit 77
  fi
done
if [[ $EUID -ne 0 ]]; then
  echo "skipped: starting slurmd for a test needs root"
  exit 77
fi
export PATH=$PATH:/usr/sbin
loopmark=$(realpath "$1")
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
work=$(mktemp -d)
pids=()

cleanup() {
  for pid in "${pids[@]}"; do
    kill "$pid" 2>/dev/null || true
  done
  wait 2>/dev/null || true
  if [[ -n "${munge_pid:-}" ]]; then
    kill "$munge_pid" 2>/dev/null || true
  fi
  rm -rf "$work"
}
trap cleanup EXIT

# A log of scans of 64 equal points, a set without rotations on them, and a competitor that answers after a quarter of a second,
# every fifth time 2 m off.
made_up_set() {
  mkdir -p "$work/data/log/velodyne"
  for i in $(seq -f %06g 0 60); do
    for _ in $(seq 64); do
      printf '\0\0\200\77\0\0\200\77\0\0\0\0\0\0\0\0'
    done >"$work/data/log/velodyne/$i.bin"
  done
  printf 'index name\n0 log\n' >"$work/sessions.txt"
  awk 'BEGIN { print "header"; for (i = 0; i < 60; ++i) { x = i % 41; y = i % 7;
    print 0, i, i + 1, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, 0, 0, 0, 0, 1, x, y, 0, 0, 0, 0, 0.5, 0.4 } }' >"$work/set.txt"
  cat >"$work/slow.sh" <<'SLOW'
read -r greeting && echo ready slow
while read -r word source target; do
  [ "$word" = quit ] && exit 0
  sleep 0.25
  index=${source##*/} && index=${index%%-*}
  x=$((index % 41)) && [ $((index % 5)) = 0 ] && x=$((x + 2))
  echo "motion 1 0 0 $x 0 1 0 $((index % 7)) 0 0 1 0 0 0 0 1 0.5 0.25"
done
SLOW
}

start_munge() {
  mkdir -p "$work/munge"
  dd if=/dev/urandom of="$work/munge/key" bs=128 count=1 status=none
  chmod 600 "$work/munge/key"
  chmod 755 "$work"
  chown -R munge:munge "$work/munge"
  runuser -u munge -- munged --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
    --log-file="$work/munge/log" --seed-file="$work/munge/seed"
  munge_pid=$(cat "$work/munge/pid")
}

start_slurm() {
  local name
  name=$(hostname -s)
  mkdir -p "$work/spool" "$work/state"
  cat >"$work/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$name(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldPort=$((20000 + RANDOM % 5000))
SlurmdPort=$((26000 + RANDOM % 5000))
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ReturnToService=2
MailProg=/bin/true
NodeName=$name NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=test Nodes=$name Default=YES MaxTime=INFINITE State=UP OverSubscribe=YES
CONF
  export SLURM_CONF=$work/slurm.conf
  slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.out" 2>&1 &
  pids+=($!)
  slurmd -D -f "$SLURM_CONF" >"$work/slurmd.out" 2>&1 &
  pids+=($!)
  for _ in $(seq 60); do
    if sinfo -h -o %t 2>/dev/null | grep -q idle; then
      return 0
    fi
    sleep 0.5
  done
  echo "skipped: Slurm does not come up here:"
  tail -n 3 "$work"/slurm*.log "$work"/slurm*.out 2>/dev/null || true
  exit 77
}

wait_for_jobs() {
  for _ in $(seq 240); do
    if [[ -z $(squeue -h 2>/dev/null) ]]; then
      return 0
    fi
    sleep 0.5
  done
  echo "the jobs did not end:" && squeue && exit 1
}

same_bytes() {
  (cd "$work/one" && find results.csv motions tables -type f ! -name 'times.*' ! -name 'stages.*' | sort | xargs sha256sum) \
    >"$work/one.sums"
  (cd "$work/many" && sha256sum --quiet -c "$work/one.sums")
}

records_of() { { wc -l <"$work/many/shards/$1-of-3.records" || echo 0; } 2>/dev/null; }

# Kills the task of the second shard once it has answered some of its 20 pairs.
lose_second_task() {
  for _ in $(seq 200); do
    if [[ $(records_of 2) -ge 4 ]]; then
      break
    fi
    sleep 0.1
  done
  scancel --full --signal=KILL "$1_2"
}

send_array() {
  LOOPMARK=$loopmark "$here/evaluate-array.sh" 3 "$work/many" "$work/set.txt" "${options[@]}"
}

made_up_set
options=(--data "$work/data" --no-check --pairs-at-once 1 --command "slow=sh $work/slow.sh")
start_munge
start_slurm
"$loopmark" evaluate "$work/set.txt" "${options[@]}" --quiet -o "$work/one" >/dev/null

lose_second_task "$(send_array | tee /dev/stderr | sed -n 's/^job array \([0-9]*\) .*/\1/p')"
wait_for_jobs
answered=$(($(records_of 2) - 1))  # the first record says what the shard is of
if [[ $answered -lt 1 || $answered -ge 20 ]]; then
  echo "the second task was to be lost half-way; it has $answered of 20 answers" && exit 1
fi
grep -q "outcomes are missing" "$work/many/logs/merge.log"

send_array
wait_for_jobs
if grep -q "error" "$work/many/logs/merge.log"; then
  cat "$work"/many/logs/*.log && exit 1
fi
same_bytes
echo "slurm: 3 shards, one killed after $answered of 20 pairs and repeated: the same bytes as one process"
