#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Tests the job array on one machine: starts a Slurm of its own (Debian: slurm-wlm, munge), runs a set in shards, kills
# one task half-way, sends it again, and compares the merged result with that of one process, byte for byte.
# Exit code 77: skipped, because Slurm is not installed, or cannot be started here (it needs root).
#
#   examples/slurm/test-on-one-machine.sh LOOPMARK [SET MOTIONS]     (without a set: a made-up one of 600 pairs)
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

# A set without rotations, and motions of which every fifth is 2 m off.
made_up_set() {
  awk 'BEGIN { print "header"; for (i = 0; i < 600; ++i) { x = i % 41; y = i % 7;
    print 0, i, i + 1, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, 0, 0, 0, 0, 1, x, y, 0, 0, 0, 0, 0.5, 0.4 } }' >"$work/set.txt"
  awk 'BEGIN { print "header"; for (i = 0; i < 600; ++i) { x = i % 41 + (i % 5 == 0 ? 2 : 0.1); y = i % 7;
    print 0, i, i + 1, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, 0, 0, 0, 0, 1 } }' >"$work/motions.txt"
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

if [[ $# -ge 3 ]]; then
  set_file=$(realpath "$2") motions=$(realpath "$3")
else
  made_up_set
  set_file=$work/set.txt motions=$work/motions.txt
fi
start_munge
start_slurm
"$loopmark" evaluate "$set_file" --motions "m=$motions" --quiet -o "$work/one" >/dev/null

LOOPMARK=$loopmark "$here/evaluate-array.sh" 3 "$work/many" "$set_file" --motions "m=$motions"
wait_for_jobs

# A lost job: the second shard's records end in the middle of one.
records=$work/many/shards/2-of-3.records
truncate -s $(($(stat -c %s "$records") / 2)) "$records"
rm -rf "$work/many/results.csv" "$work/many/motions" "$work/many/tables"
if "$loopmark" evaluate merge "$work/many" 2>"$work/merge.err"; then
  echo "an incomplete result was merged" && exit 1
fi
grep -q "outcomes are missing" "$work/merge.err"
LOOPMARK=$loopmark "$here/evaluate-array.sh" 3 "$work/many" "$set_file" --motions "m=$motions"
wait_for_jobs
"$loopmark" evaluate merge "$work/many" >/dev/null
same_bytes
echo "slurm: 3 shards, one lost and repeated: the same bytes as one process"
