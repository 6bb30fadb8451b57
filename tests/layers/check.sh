#!/bin/bash
# SPDX-License-Identifier: MIT
# check.sh INCLUDE_DIR MODULES: every include of the library against the table of modules; the table and
# the headers must have no cycle; a few habits of the headers. Prints what is wrong and returns 1.
set -u
export LC_ALL=C
include=$1
table=$2
cd "$include" || exit 2

# The table is its own proof: a module may name only modules above it.
# Then each line `file:module` of the library must be covered by it.
grep -roE '^ *# *include +["<]tunica/[^">]+' --include='*.hpp' tunica | sed -E 's, *# *include +["<],,' |
  sort | awk -F: -v table="$table" '
  BEGIN {
    while ((getline line < table) > 0) {
      if (line ~ /^#/ || line ~ /^ *$/) continue
      split(line, half, ":")
      module = half[1]
      n = split(half[2], names, " ")
      for (i = 1; i <= n; i++) {
        if (!(names[i] in known)) complain("modules: " module " includes " names[i] ", which does not stand above it")
        allowed[module, names[i]] = 1
      }
      known[module] = 1
      allowed[module, module] = 1
    }
  }
  function complain(text) { print text; bad = 1 }
  {
    split($1, from, "/"); split($2, to, "/")
    if (!(from[2] in known)) complain($1 ": " from[2] " is not a module of the table")
    else if (!((from[2], to[2]) in allowed)) complain($1 ": " from[2] " must not include " $2)
  }
  END { exit bad }' || exit 1

# Headers of one module: no cycle either (include guards would hide one).
if ! loop=$(grep -roE '^ *# *include +"tunica/[^"]+' --include='*.hpp' tunica |
            sed -E 's,: *# *include +", ,' | tsort 2>&1 >/dev/null) || [ -n "$loop" ]; then
  printf 'a cycle of headers:\n%s\n' "$loop"
  exit 1
fi

status=0
complain() { printf '%s\n' "$1"; status=1; }
for header in $(find tunica -name '*.hpp' | sort); do
  case $header in tunica/*/*.hpp) ;; *) complain "$header: not in a module" ;; esac
  [ "$(head -n 1 "$header")" = "// SPDX-License-Identifier: MIT" ] || complain "$header: no SPDX line"
  [ "$(sed -n '/^#/{p;q}' "$header")" = "#pragma once" ] || complain "$header: no #pragma once before all else"
  lines=$(wc -l <"$header")
  [ "$lines" -le 300 ] || complain "$header: $lines lines, more than 300"
  while read -r name; do
    [ -f "$name" ] || complain "$header: includes $name, which is not there"
  done < <(sed -nE 's,^ *# *include +"(.*)".*,\1,p' "$header")
  # A call that is not seen through would cost a kernel its registers: nothing is virtual there.
  case $header in
    tunica/core/*|tunica/fem/*|tunica/la/*|tunica/solid/*)
      if virtual=$(sed -E 's,//.*,,' "$header" | grep -nwE 'virtual|std::function|std::any'); then
        complain "$header:$virtual: nothing is virtual in core, fem, la and solid"
      fi ;;
  esac
  case $header in
    tunica/io/*) ;;
    *) if heavy=$(grep -nE '^ *# *include +<(iostream|regex|functional|filesystem)>' "$header"); then
         complain "$header:$heavy: too heavy outside io"
       fi ;;
  esac
done
exit $status
