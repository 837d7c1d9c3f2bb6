#!/usr/bin/env bash
# Builds the command, compresses real models with it, checks every file, and prints a table.
set -euo pipefail
here=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'END'
Usage: scripts/demo.sh [--method NAME] [FILE...]

Installs what is missing (scripts/setup.sh), builds the command, fetches the models of Debian's
package libcgal-demo into build/demo (24 MB, once; the package is not installed), compresses a
selection of them, the models of Testing/Data and the FILEs named (PLY, OBJ, OFF, XYZ, CSV), checks
each result against its original, and prints a table. Fails if any check fails.

  --method NAME  how to code positions (bspc encode --help lists the names)
END
}

encode_options=(--positions-only --force --quiet)
files=()
while (($# > 0)); do
  case $1 in
    --method)
      (($# > 1)) || {
        usage >&2
        exit 2
      }
      encode_options+=(--method "$2")
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
    /*) files+=("$1") ;;
    # A relative name means the folder that the script was called from.
    *) files+=("$here/$1") ;;
  esac
  shift
done

demo=build/demo
# Meshes from 620 to 37,706 vertices of known names, then scans and sampled surfaces.
models=(
  meshes/cactus.off meshes/triceratops.off meshes/elephant.off meshes/cow.off
  meshes/fandisk.off meshes/blobby.off meshes/bull.off meshes/camel.off
  meshes/armadillo.off meshes/bunny00.off
  points_3/kitten.xyz points_3/radar.xyz points_3/hippo1.ply points_3/sphere_20k.xyz
  points_3/b9_training.ply points_3/building.ply
)

scripts/setup.sh

echo "demo: building the command"
mkdir -p "$demo"
build() {
  cmake --preset release && cmake --build --preset release -j "$(nproc)" --target bspc_command
}
build >"$demo/build.log" 2>&1 || {
  cat "$demo/build.log" >&2
  echo "demo: the build failed" >&2
  exit 1
}
bspc=$PWD/build/release/bin/bspc

scripts/models.sh

originals=()
for model in "${models[@]}"; do originals+=("$demo/data/$model"); done
for model in Testing/Data/*.ply; do originals+=("$model"); done
originals+=("${files[@]}")

width=5
for original in "${originals[@]}"; do
  name=$(basename "$original")
  ((${#name} <= width)) || width=${#name}
done
format="%-${width}s %10s %12s %12s %10s %8s  %s\n"

# From the JSON of `bspc info` on standard input and the size of the original.
numbers() {
  python3 -c '
import json, sys
info, size = json.load(sys.stdin), int(sys.argv[1])
points, file_bytes = info["points"], info["fileBytes"]
print(f"{points:,} {size:,} {file_bytes:,}", "%.3f" % info["bitsPerPoint"], "%.2f" % (size / file_bytes))
' "$1"
}

failures=0
count=0

# Compresses one model, checks the result, and prints its line of the table.
try_model() {
  local original=$1
  shift
  local name result points input output bits ratio
  name=$(basename "$original")
  count=$((count + 1))
  local file=$out/$count-$name.bspc back=$out/$count-$name.ply
  if "$bspc" encode "$original" "$file" "${encode_options[@]}" "$@" &&
    result=$("$bspc" verify "$file" --against "$original") &&
    "$bspc" decode "$file" "$back" --force --quiet; then
    read -r points input output bits ratio < <("$bspc" info --json "$file" |
      numbers "$(stat -Lc %s "$original")")
    # verify ends with ", exact" or ", greatest error E".
    result=${result##*, }
    # shellcheck disable=SC2059
    printf "$format" "$name" "$points" "$input" "$output" "$bits" "$ratio" \
      "${result#greatest error }"
  else
    printf '%s: FAILED\n' "$name"
    failures=$((failures + 1))
  fi
}

table() {
  local title=$1
  shift
  printf '\n%s\n\n' "$title"
  # shellcheck disable=SC2059
  printf "$format" model points "input bytes" ".bspc bytes" "bits/point" ratio "greatest error"
  for original in "${originals[@]}"; do try_model "$original" "$@"; done
}

out=$demo/out
rm -rf "$out"
mkdir -p "$out"
table "As exact as the data are (bspc encode MODEL FILE --positions-only)"
table "12 bits, the custom of the literature (bspc encode MODEL FILE --positions-only --bits 12)" \
  --bits 12

cat <<END

ratio: input bytes / .bspc bytes. Inputs that are text, or that have faces and other properties,
which the .bspc file leaves out, make it large; bits/point compares: float32 positions take 96.
Every file was compared with its original. Files and restored models: $out
END
if ((failures > 0)); then
  echo "demo: $failures of $count FAILED" >&2
  exit 1
fi
