// SPDX-License-Identifier: MIT
// The one translation unit that holds doctest's implementation and main. Its declarations are already in
// the precompiled header, so the implementation is asked for by its own macro too.
#define DOCTEST_CONFIG_IMPLEMENT
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
