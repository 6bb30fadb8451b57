#!/bin/bash
# SPDX-License-Identifier: MIT
# check.sh EXAMPLE.cpp TABLE COMPILER FLAGS...: the modules that an example pulls in, by the compiler's own
# list of dependencies, are those of its line of the table.
set -u
export LC_ALL=C
name=$(basename "$1" .cpp)
expected=$(sed -nE "s/^$name: *//p" "$2")
if ! dependencies=$("${@:3}" -MM "$1"); then exit 1; fi
found=$(grep -oE 'tunica/[a-z_]+/[a-z0-9_]+\.hpp' <<<"$dependencies" | cut -d/ -f2 | sort -u | xargs)
expected=$(xargs -n 1 <<<"$expected" | sort -u | xargs)
if [ "$found" != "$expected" ]; then
  printf '%s pulls in "%s"; the table says "%s"\n' "$name" "$found" "$expected"
  exit 1
fi
printf '%s: %s\n' "$name" "$found"
