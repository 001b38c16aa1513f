# Of the folder itself, and of scenes that read Ptex files.
folder_tests(ptex DEPS ptex display)
if(TARGET test_ptex)
  target_include_directories(test_ptex PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(test_ptex PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_ptex alpenglow)
endif()
