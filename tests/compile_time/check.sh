#!/bin/bash
# SPDX-License-Identifier: MIT
# check.sh INCLUDE_DIR LIMIT COMPILER FLAGS...: any header alone costs at most LIMIT seconds of CPU time.
# A header costs at least what those that it includes cost, so the ones that nobody includes are measured.
# One that is over is measured twice more, and the least counts.
set -u
export LC_ALL=C
include=$1
limit=$2
compiler=("${@:3}")
cd "$include" || exit 2
empty=$(mktemp -d)
trap 'rm -rf "$empty"' EXIT

seconds() {  # user + system time of compiling one header
  printf '#include "%s"\n' "$1" >"$empty/alone.cpp"
  local TIMEFORMAT='%U %S'
  { time "${compiler[@]}" -fsyntax-only "$empty/alone.cpp" 2>"$empty/errors"; } 2>&1 | awk '{print $1 + $2}'
  [ ! -s "$empty/errors" ] || { cat "$empty/errors" >&2; }
}

# Those of optional solvers are left out: they cost what their library's headers cost.
tops=$(comm -23 <(find tunica -name '*.hpp' | grep -vE '/la/(cholmod|hypre|petsc)\.hpp$' | sort) \
                <(grep -rhoE '^#include "tunica/[^"]+' tunica | sed 's,.*",,' | sort -u))
status=0
for header in $tops; do
  least=$(seconds "$header")
  for _ in 1 2; do
    awk "BEGIN { exit !($least > $limit) }" || break
    least=$(printf '%s\n%s\n' "$least" "$(seconds "$header")" | sort -g | head -n 1)
  done
  printf '%s %s s\n' "$header" "$least"
  if awk "BEGIN { exit !($least > $limit) }"; then
    printf '%s alone takes %s s, more than %s s\n' "$header" "$least" "$limit"
    status=1
  fi
  [ ! -s "$empty/errors" ] || status=1
done
exit $status
