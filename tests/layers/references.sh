#!/bin/bash
# SPDX-License-Identifier: MIT
# references.sh SOURCE: every key cited as [KEY99] or [KEY99, (4)] has an entry in docs/references.bib.
set -u
export LC_ALL=C
cd "$1" || exit 2
status=0
keys=$(grep -roshE '\[[A-Z]{2,}[0-9]{2}[^]]*\]' --include='*.hpp' --include='*.cpp' --include='*.md' \
         include examples tests bench docs | grep -oE '\b[A-Z]{2,}[0-9]{2}\b' | grep -v '^KEY99$' | sort -u)
for key in $keys; do
  grep -qE "^@[a-z]+\{$key," docs/references.bib || { echo "[$key] is not in docs/references.bib"; status=1; }
done
[ -n "$keys" ] || { echo "no citation found at all"; status=1; }
exit $status
