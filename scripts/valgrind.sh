#!/usr/bin/env bash
# Whether Valgrind's memcheck finds anything in a sample of what the library does.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# > 0)); then
  cat <<'END_OF_USAGE'
Usage: scripts/valgrind.sh

Builds the preset dev's tests and command, and runs under memcheck (which finds decisions on memory
that was never written, as no sanitizer of g++ does) a sample of them: files of every method, with
arrays and meshes, cut, damaged and hostile ones, and the command on models of Testing/Data. Any
error or leak fails.
scripts/setup.sh --valgrind installs what it needs.
END_OF_USAGE
  [[ $1 == -h || $1 == --help ]] && exit 0
  exit 2
fi

for tool in cmake valgrind; do
  command -v "$tool" >/dev/null || {
    echo "valgrind: $tool is missing; scripts/setup.sh --valgrind installs it" >&2
    exit 1
  }
done

cmake --preset dev
cmake --build --preset dev -j "$(nproc)" --target bspc_tests bspc_fault_tests bspc_command

check() {
  echo "valgrind: $*"
  valgrind --quiet --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=definite,possible \
    --suppressions=scripts/valgrind.supp "$@"
}

check build/dev/bin/bspc_tests --gtest_brief=1 \
  --gtest_filter='FormatSpecification*:Container*:Metadata*:OrderDamage*:LevelOfDetail*:SmallSets*'
check build/dev/bin/bspc_fault_tests --gtest_brief=1 --gtest_filter='ReadError*:OpenFile*:Bomb*'

work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
bspc=build/dev/bin/bspc
for model in duplicates line cad_symmetric; do
  for options in "--effort 2" "--effort 4" "--effort 9 --bits 10" "--method bsp --bits 12" \
    "--method octree --bits 12" "--layout streaming --keep-order"; do
    read -ra words <<<"$options"
    check "$bspc" encode "Testing/Data/$model.ply" "$work/out.bspc" --force --quiet "${words[@]}"
    check "$bspc" decode "$work/out.bspc" "$work/out.ply" --force --quiet
    check "$bspc" info "$work/out.bspc" >/dev/null
  done
done
echo "valgrind: nothing found"
