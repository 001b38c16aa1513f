# Of the room itself, in this process, and of the program's command.
room_tests(view DEPS view)
if(TARGET test_view)
  target_include_directories(test_view PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(test_view PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_view alpenglow)
endif()
