#!/bin/bash
# SPDX-License-Identifier: MIT
# readme.sh SOURCE [--write]: the scene in README.md is main() of the example that it names, to the letter;
# --write brings it up to date. The files and folders that the pages link to are there.
set -u
cd "$1" || exit 2
status=0
example=examples/pulse_in_tube.cpp
code=$(sed -n '/^int main() {/,/^}/p' "$example")
if [ "${2-}" = "--write" ]; then
  awk -v example="$example" '
    /^```cpp/ { print; while ((getline line < example) > 0) { if (line ~ /^int main/) on = 1; if (on) print line; if (on && line ~ /^}/) on = 0 } skip = 1; next }
    /^```/ { skip = 0 }
    !skip { print }' README.md >README.md.new && mv README.md.new README.md
fi
shown=$(sed -n '/^```cpp/,/^```$/p' README.md | sed '1d;$d')
if [ "$shown" != "$code" ]; then
  echo "the scene in README.md is not main() of $example (bash tests/layers/readme.sh . --write)"
  status=1
fi
for page in README.md CONTRIBUTING.md docs/*.md; do
  while read -r link; do
    case $link in http*) continue ;; esac
    [ -e "$(dirname "$page")/$link" ] || { echo "$page links to $link, which is not there"; status=1; }
  done < <(sed -e '/^```/,/^```$/d' -e '/^    /d' "$page" | grep -oE '\]\([^)#]+\)' | sed 's/^](//; s/)$//')
done
exit $status
