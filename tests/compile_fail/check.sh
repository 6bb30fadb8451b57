#!/bin/bash
# SPDX-License-Identifier: MIT
# check.sh CASE.cpp COMPILER FLAGS...: the case compiles with -DRIGHT; without it, it must not, and the
# compiler must say the sentence of the line `// SAYS: ...` within 25 lines.
set -u
export LC_ALL=C  # plain quotation marks in the compiler's messages
case=$1
compiler=("${@:2}" -fsyntax-only)
sentence=$(sed -n 's,^// SAYS: ,,p' "$case")
[ -n "$sentence" ] || { echo "$case: no line // SAYS:"; exit 1; }

if ! text=$("${compiler[@]}" -DRIGHT "$case" 2>&1); then
  printf 'the right composition does not compile:\n%s\n' "$text" | head -n 60
  exit 1
fi
if text=$("${compiler[@]}" "$case" 2>&1); then
  echo "the wrong composition compiles"
  exit 1
fi
lines=$(wc -l <<<"$text")
status=0
[ "$lines" -le 25 ] || { echo "$lines lines, more than 25"; status=1; }
grep -qF "$sentence" <<<"$text" || { echo "it does not say: $sentence"; status=1; }
[ $status -eq 0 ] || head -n 60 <<<"$text"
echo "$lines lines"
exit $status
