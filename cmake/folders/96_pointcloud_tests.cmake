# Of the folder itself, and of what scenes bake and read.
folder_tests(pointcloud DEPS pointcloud texture display)
if(TARGET test_pointcloud)
  target_include_directories(test_pointcloud PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(test_pointcloud PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_pointcloud alpenglow)
endif()
