# A stranger's file just over each limit of base/limits.h.
room_tests(limits DEPS render transport ri display geometry rsl_jit)
if(TARGET test_limits)
  target_include_directories(test_limits PRIVATE ${CMAKE_SOURCE_DIR}/tests)
endif()
