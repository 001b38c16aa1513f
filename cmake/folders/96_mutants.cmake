# Single mistakes that the tests must notice (tests/mutants/run). On every change only whether the list still fits the source; nightly all of
# them, in a build of their own.
if(ALPENGLOW_TESTS)
  add_test(NAME Mutants.ListFitsTheSource COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tests/mutants/run --check)
  add_test(NAME Mutants.AreKilled COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tests/mutants/run --nightly-only)
  set_tests_properties(Mutants.ListFitsTheSource Mutants.AreKilled PROPERTIES LABELS mutants)
  set_tests_properties(Mutants.AreKilled PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 14400 RUN_SERIAL TRUE)
endif()
