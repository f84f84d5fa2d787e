#!/usr/bin/env bash
# Divides an evaluation among the nodes of a Slurm cluster: an array of jobs, and a last one that gathers the runs.
# Usage: scripts/evaluate_slurm.sh --output DIR [OPTION...] -- EVALUATE ARGUMENT...
#   --output DIR        folder of the evaluation, on a file system that all nodes share
#   --parts N           number of jobs in the array (default: 16)
#   --command PATH      the command `constrictor` on the nodes (default: constrictor)
#   --sbatch OPTIONS    for sbatch, for example "--partition long --time 2:00:00"
#   --wait              wait until the last job has ended; exit with its status
#   EVALUATE ARGUMENT   what `constrictor evaluate` gets: scenario, --seeds, --vary, ...; not --output or --shard
# Example: scripts/evaluate_slurm.sh --output /shared/wide --parts 50 -- wide --seeds 1..1000
# The same command continues an evaluation that was interrupted: runs that are over are not done again.
set -euo pipefail

fail() { echo "evaluate_slurm: $1" >&2; exit 64; }
if [ "${1:-}" = --help ]; then sed -n '2,11s/^# //p' "$0"; exit 0; fi
output="" parts=16 command=constrictor options="" wait=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  if [ "$1" = --wait ]; then wait=(--wait); shift; continue; fi
  case "$1" in
    --output) output=${2-} ;;
    --parts) parts=${2-} ;;
    --command) command=${2-} ;;
    --sbatch) options=${2-} ;;
    *) fail "there is no option \"$1\"; accepted: --output, --parts, --command, --sbatch, --wait, --" ;;
  esac
  if [ $# -lt 2 ]; then fail "$1 needs a value (see --help)"; fi
  shift 2
done
if [ "${1:-}" != -- ] || [ $# -lt 2 ]; then fail "the arguments of \`constrictor evaluate\` are missing after --"; fi
shift
if [ -z "$output" ]; then fail "--output is needed (see --help)"; fi
[[ "$parts" =~ ^[1-9][0-9]*$ ]] || fail "--parts: found $parts, accepted a number from 1"
for word in "$@"; do
  case "$word" in --output*|--shard*|--merge*) fail "$word belongs to this script" ;; esac
done
if ! command -v sbatch >/dev/null; then
  echo "evaluate_slurm: sbatch is missing: this script belongs on a host of a Slurm cluster" >&2
  exit 69
fi

mkdir -p "$output/parts" "$output/logs"
output=$(realpath "$output")
evaluate=$(printf '%q ' "$command" evaluate "$@")
folders=""
for part in $(seq 1 "$parts"); do folders+=$(printf '%q ' "$output/parts/part_$part"); done
# Two jobs on one node use the same processors as one after the other, so a job does one run at a time.
part_folder=$(printf %q "$output")/parts/part_\$SLURM_ARRAY_TASK_ID
# shellcheck disable=SC2086  # --sbatch is a list of options
array=$(sbatch --parsable --job-name constrictor-evaluate --array "1-$parts" --ntasks 1 --cpus-per-task 1 \
  --output "$output/logs/part_%a.log" $options \
  --wrap "$evaluate --jobs 1 --shard \$SLURM_ARRAY_TASK_ID/$parts --output $part_folder")
echo "evaluate_slurm: job $array has $parts parts; follow it by: squeue --job $array"
# `afterany`: runs of parts that failed are missing in the whole, and the page says how many there are.
# shellcheck disable=SC2086
sbatch "${wait[@]}" --parsable --job-name constrictor-merge --dependency "afterany:${array%%;*}" --ntasks 1 \
  --output "$output/logs/merge.log" $options \
  --wrap "$evaluate --merge $folders --output $(printf %q "$output/whole")" >/dev/null
echo "evaluate_slurm: the whole is in $output/whole (log: $output/logs/merge.log)"
