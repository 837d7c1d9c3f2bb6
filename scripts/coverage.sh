#!/usr/bin/env bash
# How many lines of the library the tests run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'END_OF_USAGE'
Usage: scripts/coverage.sh [--least PERCENT] [TEST_NAMES]

Builds the preset coverage, runs its tests (those whose names match the regular expression
TEST_NAMES, or all), and reports how many of the lines in bspc/ they ran: by file on standard
output, line by line in build/coverage/report/index.html. Fails if they are less than PERCENT of
all (90 unless told otherwise). scripts/setup.sh --coverage installs what it needs.
END_OF_USAGE
}

least=90
names=.
while (($# > 0)); do
  case $1 in
    --least)
      (($# > 1)) || { usage >&2; exit 2; }
      least=$2
      shift
      ;;
    -h | --help)
      usage
      exit 0
      ;;
    -*)
      usage >&2
      exit 2
      ;;
    *) names=$1 ;;
  esac
  shift
done

for tool in cmake ctest gcov gcovr; do
  command -v "$tool" >/dev/null || {
    echo "coverage: $tool is missing; scripts/setup.sh --coverage installs it" >&2
    exit 1
  }
done

cmake --preset coverage
cmake --build --preset coverage -j "$(nproc)"
# Counts of an earlier run would be added to.
find build/coverage -name '*.gcda' -delete
ctest --preset coverage -j "$(nproc)" -R "$names"

mkdir -p build/coverage/report
# Branches that end in exceptions are not lines of their own.
gcovr --root . --object-directory build/coverage --filter 'bspc/' --exclude-throw-branches \
  -j "$(nproc)" --print-summary --fail-under-line "$least" \
  --html-details build/coverage/report/index.html --txt
