#!/usr/bin/env bash
# Everything that must hold before a change is merged: style, build, tests, tests under sanitizers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'END'
Usage: scripts/test.sh [--quick]

Installs what is missing (scripts/setup.sh), checks style and layout (scripts/lint.sh), then builds
and runs the tests twice: optimised, and with AddressSanitizer and UndefinedBehaviorSanitizer.

  --quick  only the optimised build and its tests
END
}

quick=no
for argument in "$@"; do
  case $argument in
    --quick) quick=yes ;;
    -h | --help)
      usage
      exit 0
      ;;
    *)
      usage >&2
      exit 2
      ;;
  esac
done

current=
finished=no
report_failure() {
  [[ $finished == yes || -z $current ]] || echo "test: FAILED at: $current" >&2
}
trap report_failure EXIT

step() {
  current=$1
  shift
  echo "test: $current"
  local begin=$SECONDS
  "$@"
  echo "test: $current: done in $((SECONDS - begin)) s"
}

configure_and_build() {
  cmake --preset "$1"
  cmake --build --preset "$1" -j "$(nproc)"
}

if [[ $quick == yes ]]; then
  step "packages" scripts/setup.sh --vtk --openmesh
else
  step "packages" scripts/setup.sh --lint --vtk --openmesh
  step "style and layout" scripts/lint.sh
fi
step "build dev" configure_and_build dev
last=dev
if [[ $quick == no ]]; then
  step "tests of dev" ctest --preset dev -j "$(nproc)"
  step "build asan" configure_and_build asan
  last=asan
fi

# Last and outside step(): what this script ends with is ctest's summary.
current="tests of $last"
echo "test: $current"
ctest --preset "$last" -j "$(nproc)"
finished=yes
