# A stranger's file just over each limit of base/limits.h, and what it may not do to the program as a user runs it.
folder_tests(limits DEPS render integrator ri display geometry rsl_jit)
if(TARGET test_limits)
  target_include_directories(test_limits PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(test_limits PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_limits alpenglow)
endif()
