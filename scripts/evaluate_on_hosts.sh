#!/usr/bin/env bash
# Divides an evaluation among several hosts by GNU parallel over ssh, and gathers its runs on this one.
# Usage: scripts/evaluate_on_hosts.sh --hosts HOST[,HOST...] --output DIR [OPTION...] -- EVALUATE ARGUMENT...
#   --hosts HOST,...    as for ssh; N/HOST does N parts at a time there; ":" is this host. Each needs the same release
#                       of `constrictor`, and the same scenario, robot and configuration files, at equal paths
#   --output DIR        folder of the whole evaluation; the same command continues one that was interrupted
#   --parts N           number of parts (default: four for each host)
#   --command PATH      the command `constrictor` on the hosts (default: constrictor)
#   --ssh COMMAND       instead of `ssh`, for example "ssh -p 2222"
#   EVALUATE ARGUMENT   what `constrictor evaluate` gets: scenario, --seeds, --vary, ...; not --output or --shard
# Example: scripts/evaluate_on_hosts.sh --hosts :,robot@10.0.0.2 --output /tmp/wide -- wide --seeds 1..100
# A part that fails, for example because its host is gone, is done once more, if possible elsewhere. Exit status: that
# of `constrictor evaluate`; 1 if parts are missing.
set -euo pipefail

fail() { echo "evaluate_on_hosts: $1" >&2; exit 64; }
if [ "${1:-}" = --help ]; then sed -n '2,13s/^# //p' "$0"; exit 0; fi
hosts="" output="" parts="" command=constrictor ssh=ssh
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  case "$1" in
    --hosts) hosts=${2-} ;;
    --output) output=${2-} ;;
    --parts) parts=${2-} ;;
    --command) command=${2-} ;;
    --ssh) ssh=${2-} ;;
    *) fail "there is no option \"$1\"; accepted: --hosts, --output, --parts, --command, --ssh, --" ;;
  esac
  if [ $# -lt 2 ]; then fail "$1 needs a value (see --help)"; fi
  shift 2
done
if [ "${1:-}" != -- ] || [ $# -lt 2 ]; then fail "the arguments of \`constrictor evaluate\` are missing after --"; fi
shift
if [ -z "$hosts" ] || [ -z "$output" ]; then fail "--hosts and --output are needed (see --help)"; fi
for word in "$@"; do
  case "$word" in --output*|--shard*|--merge*) fail "$word belongs to this script" ;; esac
done
parts=${parts:-$((4 * $(tr , '\n' <<<"$hosts" | wc -l)))}
[[ "$parts" =~ ^[1-9][0-9]*$ ]] || fail "--parts: found $parts, accepted a number from 1"
if ! command -v parallel >/dev/null; then
  echo "evaluate_on_hosts: GNU parallel is missing: apt-get install parallel" >&2
  exit 69
fi

mkdir -p "$output/parts"
output=$(realpath "$output")
evaluate=$(printf '%q ' "$command" evaluate "$@")
# Each part runs in a temporary folder of its host and comes back as an archive through its standard output. `evaluate`
# ends with 0 also if missions fail, and with 78 and a summary if draws were refused; a part whose command ends
# otherwise is tried again. Parts that are here are not.
archive_of() { echo "$output/parts/results/1/$1/stdout"; }
todo=()
for part in $(seq 1 "$parts"); do
  if ! tar tzf "$(archive_of "$part")" >/dev/null 2>&1; then todo+=("$part"); fi
done
status=0
if [ ${#todo[@]} -gt 0 ]; then
  echo "evaluate_on_hosts: ${#todo[@]} of $parts parts on $hosts (log: $output/parts/jobs.log)" >&2
  export PARALLEL_SSH=$ssh
  progress=()
  if [ -t 2 ]; then progress=(--eta); fi
  parallel --will-cite --sshlogin "$hosts" --retries 2 "${progress[@]}" --joblog "$output/parts/jobs.log" \
    --results "$output/parts/results" \
    "folder=\$(mktemp -d) && cd \$folder && $evaluate --shard {}/$parts --output part_{} >&2;
     ended=\$?; if [ \$ended -eq 78 ] && [ -e part_{}/summary.json ]; then ended=0; fi
     if [ \$ended -eq 0 ]; then tar czf - part_{}; ended=\$?; fi
     rm -rf \$folder; exit \$ended" ::: "${todo[@]}" >/dev/null || status=1
fi

folders=()
for part in $(seq 1 "$parts"); do
  rm -rf "$output/parts/part_$part"
  if tar xzf "$(archive_of "$part")" -C "$output/parts" 2>/dev/null; then folders+=("$output/parts/part_$part"); fi
done
if [ ${#folders[@]} -eq 0 ]; then
  echo "evaluate_on_hosts: no part came back; see $output/parts/jobs.log and $(dirname "$(archive_of 1)")/stderr" >&2
  exit 1
fi
merged=0
"$command" evaluate "$@" --merge "${folders[@]}" --output "$output/whole" || merged=$?
if [ "$status" -ne 0 ]; then
  echo "evaluate_on_hosts: parts are missing; call again to do them ($output/parts/jobs.log)" >&2
  exit 1
fi
exit "$merged"
