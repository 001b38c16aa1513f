folder_tests(integrator DEPS integrator ri render)
if(TARGET test_integrator)
  target_include_directories(test_integrator PRIVATE ${CMAKE_SOURCE_DIR}/tests)
endif()
