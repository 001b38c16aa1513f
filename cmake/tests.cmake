# What the tests need besides what the program needs (scripts/packages-tests.txt). Where it is missing the program is built without
# them: ./render installs the packages of the program only. ./check installs the others and configures again.
set(without_tests ${CMAKE_BINARY_DIR}/without-tests) # tells ./check
file(REMOVE ${without_tests})
if(ALPENGLOW_TESTS)
  find_package(GTest QUIET)
  find_package(rapidcheck CONFIG QUIET)
  find_package(Python3 QUIET COMPONENTS Interpreter)
  find_library(EMBREE_LIBRARY embree3)
  if(GTest_FOUND AND rapidcheck_FOUND AND Python3_FOUND AND EMBREE_LIBRARY)
    enable_testing()
    set(ALPENGLOW_TEST_OPTIONS ${quick_options} CACHE STRING "Options of the tests' own code: quick to build")
  else()
    message(NOTICE "Without the tests: they need GoogleTest, RapidCheck, Python 3 and Embree 3 (scripts/packages-tests.txt).")
    file(TOUCH ${without_tests})
    set(ALPENGLOW_TESTS OFF)
  endif()
endif()
