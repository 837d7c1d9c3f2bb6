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

# What all builds restore from $1, as a model of format $4 (ply), must be what the first one does.
# $2 names it, $3 is a folder for what is restored. Prints a line for each build that differs.
compare_decoders() {
  local file=$1 what=$2 folder=$3 format=${4:-ply} build
  for build in "${builds[@]}"; do
    "$root/$build/bin/bspc" decode "$file" "$folder/$build.$format" --force --quiet
    cmp -s "$folder/${builds[0]}.$format" "$folder/$build.$format" ||
      echo "$what: $build restores other points than ${builds[0]}"
  done
}

compare_good_files() {
  local folder=$1 file format
  for file in "${good[@]}"; do
    # PLY has no place for lines and texts.
    for format in ply obj csv; do
      "$root/${builds[0]}/bin/bspc" decode "$file" "$folder/first.$format" --force --quiet \
        2>/dev/null && break
    done
    compare_decoders "$file" "$file" "$folder" "$format" >>"$folder/failures"
  done
  echo "compilers: ${#good[@]} good files, each decoded by ${#builds[@]} builds"
}

compare_model() {
  local folder=$1 model=$2 setting what build file sum files=0
  for setting in "${settings[@]}"; do
    # Faces cannot follow points that are moved onto each other.
    [[ $model == "$mesh" && $setting == *--stop-* ]] && continue
    what="$(basename "$model") ${setting:-default}"
    read -ra options <<<"$setting"
    local -A seen=()
    for build in "${builds[@]}"; do
      file=$folder/$build.bspc
      "$root/$build/bin/bspc" encode "$model" "$file" --force --quiet "${options[@]}"
      sum=$(sha256sum <"$file")
      # Equal files need one comparison of decoders only.
      [[ -n ${seen[$sum]:-} ]] ||
        compare_decoders "$file" "$what, encoded by $build" "$folder" >>"$folder/failures"
      seen[$sum]=1
    done
    files=$((files + 1))
    ((${#seen[@]} == 1)) || echo "$what: ${#seen[@]} different files" >>"$folder/differences"
  done
  echo "compilers: $(basename "$model"), $files files, each encoded and decoded by" \
    "${#builds[@]} builds"
}

# Runs "$@" with a folder of its own as its first argument, beside as many others as there are
# processors.
side_by_side() {
  local folder
  while (($(jobs -rp | wc -l) >= $(nproc))); do wait -n || true; done
  folder=$(mktemp -d "$work/XXXXXX")
  touch "$folder/failures" "$folder/differences" "$folder/unfinished"
  (
    # Not joined by &&, which would let the function go on after an error.
    "$1" "$folder" "${@:2}"
    rm "$folder/unfinished"
  ) &
}

shopt -s nullglob
good=(Testing/Data/{frozen_1.0,golden,conformance}/*.bspc)
models=(Testing/Data/*.ply)
((${#models[@]} > 0 && ${#good[@]} > 0)) || {
  echo "compilers: there are no models or no files in Testing/Data" >&2
  exit 1
}
# No model there has faces.
mesh=$work/mesh.ply
"$root/${builds[0]}/bin/bspc" decode Testing/Data/golden/surface_mesh.bspc "$mesh" --quiet
models+=("$mesh")

side_by_side compare_good_files
for model in "${models[@]}"; do side_by_side compare_model "$model"; done
wait

cat "$work"/*/failures "$work"/*/differences | sed 's/^/compilers: /'
unfinished=("$work"/*/unfinished)
failures=$(cat "$work"/*/failures | wc -l)
if ((${#unfinished[@]} > 0 || failures > 0)); then
  echo "compilers: FAILED: $failures times a build restored other points," \
    "${#unfinished[@]} comparisons broke off" >&2
  exit 1
fi
echo "compilers: every file restores the same bytes with every build"
differences=$(cat "$work"/*/differences | wc -l)
if ((differences == 0)); then
  echo "compilers: the encoded files are equal too"
else
  echo "compilers: the encoded files differ in $differences models and settings"
fi
