#!/usr/bin/env bash
# Whether files mean the same whichever compiler built the command, at whichever optimisation.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# > 0)); then
  cat <<'END'
Usage: scripts/compilers.sh

Builds the command with g++ and clang++ at -O0 and -O3 into build/compilers, encodes the models of
Testing/Data, and a mesh, with each in several settings, and checks that all four restore the same
bytes from each file and from each good file of the conformance set. Says too whether the files
themselves are equal, which the format does not ask for.
scripts/setup.sh --compilers installs what it needs.
END
  [[ $1 == -h || $1 == --help ]] && exit 0
  exit 2
fi

for tool in g++ clang++ cmake ninja; do
  command -v "$tool" >/dev/null || {
    echo "compilers: $tool is missing; scripts/setup.sh --compilers installs it" >&2
    exit 1
  }
done

root=build/compilers
builds=(g++-O0 g++-O3 clang++-O0 clang++-O3)
mkdir -p "$root"

for build in "${builds[@]}"; do
  echo "compilers: building with ${build/-/ -}"
  {
    # No build type of CMake's: its own flags would follow and override ours.
    cmake -S . -B "$root/$build" -G Ninja -DCMAKE_BUILD_TYPE=None \
      -DCMAKE_CXX_COMPILER="${build%-O*}" -DCMAKE_CXX_FLAGS="-${build##*-}" -DBUILD_TESTING=OFF &&
      cmake --build "$root/$build" -j "$(nproc)" --target bspc_command
  } >"$root/$build.log" 2>&1 || {
    cat "$root/$build.log" >&2
    echo "compilers: the build with $build failed" >&2
    exit 1
  }
done

settings=(
  ""
  "--bits 12"
  "--bits 20 --layers 6"
  "--precision 0.05"
  "--layout streaming --layers 3"
  "--method bsp --bits 12"
  "--method bsp --bits 20 --layers 5"
  "--method bsp --bits 16 --stop-points 3"
  "--method kd --bits 12 --stop-level 20"
  "--method octree --bits 16 --layers 3"
  "--method gencode --bits 16 --layers 3"
  "--effort 5 --bits 12"
  "--effort 7 --bits 16 --layers 3"
  "--effort 9 --bits 20"
  "--method predictive --layers 3"
  "--method surface"
  "--method surface --bits 14"
)

work=$root/work
rm -rf "$work"
mkdir -p "$work"
files=0
differing_files=0
failures=0

# What all builds restore from $1, as a model of format $3 (ply), must be what the first one does.
compare_decoders() {
  local file=$1 what=$2 format=${3:-ply} build
  for build in "${builds[@]}"; do
    "$root/$build/bin/bspc" decode "$file" "$work/$build.$format" --force --quiet
    if ! cmp -s "$work/${builds[0]}.$format" "$work/$build.$format"; then
      echo "compilers: $what: $build restores other points than ${builds[0]}" >&2
      failures=$((failures + 1))
    fi
  done
}

shopt -s nullglob
good=(Testing/Data/{frozen_1.0,golden,conformance}/*.bspc)
models=(Testing/Data/*.ply)
((${#models[@]} > 0 && ${#good[@]} > 0)) || {
  echo "compilers: there are no models or no files in Testing/Data" >&2
  exit 1
}
for file in "${good[@]}"; do
  # PLY has no place for lines and texts.
  for format in ply obj csv; do
    "$root/${builds[0]}/bin/bspc" decode "$file" "$work/first.$format" --force --quiet 2>/dev/null &&
      break
  done
  compare_decoders "$file" "$file" "$format"
done
# No model there has faces.
"$root/${builds[0]}/bin/bspc" decode Testing/Data/golden/surface_mesh.bspc "$work/mesh.ply" --quiet
models+=("$work/mesh.ply")
for model in "${models[@]}"; do
  for setting in "${settings[@]}"; do
    what="$(basename "$model") ${setting:-default}"
    read -ra options <<<"$setting"
    declare -A seen=()
    for build in "${builds[@]}"; do
      file=$work/$build.bspc
      "$root/$build/bin/bspc" encode "$model" "$file" --force --quiet "${options[@]}"
      sum=$(sha256sum <"$file")
      # Equal files need one comparison of decoders only.
      [[ -n ${seen[$sum]:-} ]] || compare_decoders "$file" "$what, encoded by $build"
      seen[$sum]=1
    done
    files=$((files + 1))
    if ((${#seen[@]} > 1)); then
      differing_files=$((differing_files + 1))
      echo "compilers: $what: ${#seen[@]} different files"
    fi
    unset seen
  done
done

echo "compilers: ${#good[@]} good files, each decoded by ${#builds[@]} builds"
echo "compilers: $files models and settings, each encoded and decoded by ${#builds[@]} builds"
if ((failures > 0)); then
  echo "compilers: FAILED: $failures times a build restored other points" >&2
  exit 1
fi
echo "compilers: every file restores the same bytes with every build"
if ((differing_files == 0)); then
  echo "compilers: the encoded files are equal too"
else
  echo "compilers: the encoded files differ in $differing_files of them"
fi
