# The tests of scripts/lint.
if(ALPENGLOW_TESTS)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  add_test(NAME Lint.Rules COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tests/lint/lint_test.py)
  add_test(NAME Lint.DrawingOfFolders COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/scripts/draw_folders --check)
endif()
