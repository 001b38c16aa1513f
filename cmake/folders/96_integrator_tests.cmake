# Of the folders themselves, and of scenes that need them: these are drawn by the integrator (tests/integrator/harness.h).
foreach(folder world services integrator)
  folder_tests(${folder} DEPS integrator ri render)
  if(TARGET test_${folder})
    target_include_directories(test_${folder} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  endif()
endforeach()
