#!/bin/bash
# SPDX-License-Identifier: MIT
# control.sh CHECK MODULES SCRATCH: faults put in on purpose must be found, each with its sentence.
set -u
check=$1
modules=$2
scratch=$3
status=0

# expect SENTENCE MODULES: the tree in $scratch must be refused with it.
expect() {
  local text
  if text=$(bash "$check" "$scratch" "$2" 2>&1) || [[ $text != *"$1"* ]]; then
    printf 'expected "%s", got "%s"\n' "$1" "$text"
    status=1
  fi
}

# header FILE LINE...: a header with these lines after the first two.
header() {
  mkdir -p "$scratch/$(dirname "$1")"
  printf '%s\n' "// SPDX-License-Identifier: MIT" "#pragma once" "${@:2}" >"$scratch/$1"
}

fresh() {
  rm -rf "$scratch"
  header tunica/core/a.hpp '#include <vector>'
  header tunica/mesh/b.hpp '#include "tunica/core/a.hpp"'
}

fresh
bash "$check" "$scratch" "$modules" || { echo "a clean tree was refused"; status=1; }

header tunica/core/up.hpp '#include "tunica/mesh/b.hpp"'
expect 'core must not include tunica/mesh/b.hpp' "$modules"

fresh
header tunica/fluid/c.hpp '#  include <tunica/solid/d.hpp>'
expect 'fluid must not include tunica/solid/d.hpp' "$modules"

fresh
header tunica/utils/c.hpp '#include "tunica/core/a.hpp"'
expect 'utils is not a module' "$modules"

fresh
header tunica/mesh/c.hpp '#include "tunica/mesh/d.hpp"'
header tunica/mesh/d.hpp '#include "tunica/mesh/c.hpp"'
expect 'a cycle of headers' "$modules"

fresh
header tunica/mesh/c.hpp '#include <iostream>'
expect 'too heavy outside io' "$modules"

fresh
header tunica/fem/c.hpp '// virtual in a comment is no fault' 'struct S { virtual void f(); };'
expect 'nothing is virtual in core, fem, la and solid' "$modules"

fresh
header tunica/mesh/c.hpp '#include "tunica/core/gone.hpp"'
expect 'which is not there' "$modules"

fresh
{ echo "core: mesh"; echo "mesh: core"; } >"$scratch/modules.txt"
expect 'core includes mesh, which does not stand above it' "$scratch/modules.txt"

rm -rf "$scratch"
exit $status
