# SPDX-License-Identifier: MIT
# tunica::tunica, and one target more for each optional library that was found.

# add_component(name headers...): the header-only target tunica::<name>.
function(tunica_add_component name)
  set(target tunica_${name})
  if(name STREQUAL "tunica")
    set(target tunica)
  endif()
  add_library(${target} INTERFACE)
  add_library(tunica::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_sources(${target} INTERFACE
    FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${ARGN})
endfunction()

file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/tunica/*.hpp)
set(zlib_headers ${headers})
list(FILTER zlib_headers INCLUDE REGEX "/io/zlib[a-z_]*\\.hpp$")
list(REMOVE_ITEM headers ${zlib_headers})
list(FILTER headers EXCLUDE REGEX "/la/(cholmod|hypre|petsc)\\.hpp$")

tunica_add_component(tunica ${headers})
target_link_libraries(tunica INTERFACE Eigen3::Eigen Threads::Threads)

if(ZLIB_FOUND AND zlib_headers)
  tunica_add_component(zlib ${zlib_headers})
  target_link_libraries(tunica_zlib INTERFACE tunica ZLIB::ZLIB)
endif()
include(${CMAKE_CURRENT_LIST_DIR}/solvers.cmake)
