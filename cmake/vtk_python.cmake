# SPDX-License-Identifier: MIT
# TUNICA_VTK_PYTHON: an interpreter that can import vtk, or empty. It reads back what we write.
if(NOT DEFINED TUNICA_VTK_PYTHON)
  set(found "")
  foreach(candidate /usr/bin/python3 python3)
    execute_process(COMMAND ${candidate} -c "import vtk" RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
    if(status EQUAL 0)
      set(found ${candidate})
      break()
    endif()
  endforeach()
  set(TUNICA_VTK_PYTHON "${found}" CACHE STRING "Python with VTK's module; empty where there is none")
endif()
