#!/usr/bin/env bash
# Everything that must hold before a change is merged: style, build, tests, tests under sanitizers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'END'
Usage: scripts/test.sh [--quick] [--paraview]

Installs what is missing (scripts/setup.sh), checks style and layout (scripts/lint.sh), then builds
and runs the tests twice: optimised, and with AddressSanitizer and UndefinedBehaviorSanitizer.

  --quick     only the optimised build and its tests
  --paraview  also installs ParaView and tests its plugin; without this the plugin is tested where
              ParaView is installed
END
}

quick=no
paraview=no
for argument in "$@"; do
  case $argument in
    --quick) quick=yes ;;
    --paraview) paraview=yes ;;
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
  # The builds of the plugin and of everything compile the same library, here once.
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
  export CCACHE_DIR=${CCACHE_DIR:-$PWD/build/ccache}
  step "style and layout" scripts/lint.sh
fi
# Its libraries and its development files are packages of their own.
if [[ $paraview == no ]] && command -v pvbatch >/dev/null && [[ -d /usr/include/paraview-5.11 ]]; then
  paraview=yes
fi
if [[ $paraview == yes ]]; then
  step "packages of ParaView" scripts/setup.sh --paraview
  step "build paraview" configure_and_build paraview
  step "tests of paraview" ctest --preset paraview -j 1
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
