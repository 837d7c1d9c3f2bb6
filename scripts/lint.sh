#!/usr/bin/env bash
# Style and layout: clang-format, clang-tidy, who may include what, syntax of the scripts.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

analyzer=no
for argument in "$@"; do
  case $argument in
    --analyzer) analyzer=yes ;;
    *)
      echo "Usage: scripts/lint.sh [--analyzer]"
      echo "Checks style and layout of the sources; scripts/setup.sh --lint installs what it needs."
      echo "  --analyzer  clang's static analyzer walks the paths of the library too, which takes"
      echo "              as long again; for use before a release"
      [[ $argument == -h || $argument == --help ]] && exit 0
      exit 2
      ;;
  esac
done

for tool in clang-format clang-tidy cmake python3; do
  command -v "$tool" >/dev/null || {
    echo "lint: $tool is missing; scripts/setup.sh --lint installs it" >&2
    exit 1
  }
done

# What belongs to the project: what git tracks or would track. An unpacked archive has no git; there
# it is everything but the builds.
own_files() {
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    # A file that is deleted but still tracked cannot be checked.
    git ls-files --cached --others --exclude-standard | while IFS= read -r file; do
      [[ ! -f $file ]] || printf '%s\n' "$file"
    done
  else
    find . -path ./build -prune -o -path ./.git -prune -o -type f -print | sed 's|^\./||'
  fi
}

failures=0
check() {
  local name=$1
  shift
  if "$@"; then
    echo "lint: $name: ok"
  else
    echo "lint: $name: FAILED" >&2
    failures=$((failures + 1))
  fi
}

files=$(own_files)

formatting() {
  grep -E '\.(h|cpp|cxx)$' <<<"$files" | xargs -d '\n' clang-format --dry-run -Werror
}

# Succeeds if none of the files named on standard input matches.
none_contains() {
  local pattern=$1 found
  found=$(xargs -r -d '\n' grep -nHE "$pattern") || true
  [[ -z $found ]] && return 0
  printf '%s\n' "$found" >&2
  return 1
}

layout_of_library() {
  grep -E '^bspc/' <<<"$files" |
    none_contains '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"](vtk|OpenMesh/)'
}

# The library hands bytes and points to its caller; files, consoles and the end of the program are
# not its own. (Formatting numbers into a buffer is: snprintf stays allowed.)
silence_of_library() {
  local include='^[[:space:]]*#[[:space:]]*include[[:space:]]*<(iostream|fstream|filesystem|unistd\.h)>'
  local call='\b(f?printf|f?puts|f?putc|putchar|perror|f(re)?open|exit|abort)[[:space:]]*\('
  grep -E '^bspc/.*\.(h|cpp)$' <<<"$files" | none_contains "$include|$call"
}

shell_syntax() {
  local script bad=0
  while IFS= read -r script; do
    bash -n "$script" || bad=1
  done < <(grep -E '\.sh$|^\.ci/' <<<"$files")
  return $bad
}

sources_of_build() {
  python3 - build/dev/compile_commands.json <<'END'
import json
import os
import sys

root = os.getcwd() + os.sep
for entry in sorted(json.load(open(sys.argv[1])), key=lambda entry: entry["file"]):
    path = os.path.normpath(os.path.join(entry["directory"], entry["file"]))
    if path.startswith(root) and not path.startswith(root + "build" + os.sep):
        print(path[len(root):])
END
}

tidiness() {
  cmake --preset dev >build/lint-configure.log 2>&1 || {
    cat build/lint-configure.log >&2
    return 1
  }
  local checks=()
  [[ $analyzer == yes ]] || checks=(--checks=-clang-analyzer-*)
  # Its count of warnings in system headers is noise on standard error; it need not know g++'s warnings.
  sources_of_build | sort -u |
    xargs -d '\n' -n 1 -P "$(nproc)" clang-tidy --quiet -p build/dev \
      "${checks[@]}" --extra-arg=-Wno-unknown-warning-option 2>build/lint-tidy.log ||
    {
      grep -vE '^[0-9]+ warnings? (generated|treated)' build/lint-tidy.log >&2
      return 1
    }
}

mkdir -p build
check "clang-format" formatting
check "the library knows no VTK and no OpenMesh" layout_of_library
check "the library neither prints nor opens files" silence_of_library
check "shell scripts" shell_syntax
check "clang-tidy" tidiness
((failures == 0)) || {
  echo "lint: $failures of the checks failed" >&2
  exit 1
}
