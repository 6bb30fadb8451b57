# SPDX-License-Identifier: MIT
# Compile through ccache where it is found; the sloppiness is what it needs for precompiled headers.
find_program(TUNICA_CCACHE ccache)
mark_as_advanced(TUNICA_CCACHE)
if(TUNICA_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${TUNICA_CCACHE})
endif()
