#!/usr/bin/env bash
# Builds the fuzzers and runs each for a while.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'END'
Usage: scripts/fuzz.sh SECONDS [TARGET...]

Installs what is missing, builds the fuzzers (tests/fuzz) with clang and the sanitizers, and runs
each of them for SECONDS seconds, or those named: decode, query, round_trip, model, vtk_reader.

They begin with the seeds of the project and with what reached new code in earlier runs, which stays
in build/fuzz/corpus. Inputs that crash, take longer than 10 seconds or too much memory are left in
build/fuzz/findings, logs in build/fuzz/logs; a target goes on behind a finding until its time is
over. Fails if there are any. What to do with a finding is said in CONTRIBUTING.md.
END
}

case ${1:-} in
  -h | --help)
    usage
    exit 0
    ;;
  '' | *[!0-9]*)
    usage >&2
    exit 2
    ;;
esac
seconds=$1
shift
targets=("$@")
((${#targets[@]} > 0)) || targets=(decode query round_trip model vtk_reader)

scripts/setup.sh --fuzz --vtk
cmake --preset fuzz
cmake --build --preset fuzz -j "$(nproc)" \
  --target bspc_fuzz_replay bspc_fuzz_replay_vtk "${targets[@]/#/fuzz_}"

build=build/fuzz
mkdir -p $build/findings $build/logs

statistic() {
  sed -n "s/^stat::$1: *//p" "$2" | tail -n 1
}

findings=0
for target in "${targets[@]}"; do
  replay=bspc_fuzz_replay
  [[ $target != vtk_reader ]] || replay=bspc_fuzz_replay_vtk
  seeds=$build/seeds/$target
  corpus=$build/corpus/$target
  rm -rf "$seeds"
  mkdir -p "$corpus"
  "$build/bin/$replay" "$target" --seeds "$seeds"

  executions=0
  found=0
  coverage=
  end=$((SECONDS + seconds))
  while ((SECONDS < end)); do
    log=$build/logs/$target.$(date +%Y%m%d-%H%M%S-%N).log
    # A decoding may take 64 MiB here, see tests/fuzz/fuzz_limits.h.
    "$build/bin/fuzz_$target" -max_total_time=$((end - SECONDS)) -timeout=10 -report_slow_units=10 \
      -rss_limit_mb=2048 -malloc_limit_mb=512 -max_len=4096 -print_final_stats=1 \
      -artifact_prefix="$build/findings/$target-" "$corpus" "$seeds" >"$log" 2>&1 || {
      found=$((found + 1))
      grep -E '^(SUMMARY|fuzz:)|Test unit written' "$log" >&2 || tail -n 20 "$log" >&2
    }
    ran=$(statistic number_of_executed_units "$log")
    executions=$((executions + ${ran:-0}))
    coverage=$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1) || true
  done
  echo "fuzz: $target: $executions executions, ${coverage:-cov: none}, $found findings"
  findings=$((findings + found))
done
if ((findings > 0)); then
  echo "fuzz: failing inputs are in $build/findings" >&2
  exit 1
fi
