# Of the room itself, and of what scenes bake and read.
room_tests(clouds DEPS clouds texture display)
if(TARGET test_clouds)
  target_include_directories(test_clouds PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(test_clouds PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_clouds alpenglow)
endif()
