room_tests(transport DEPS transport ri render)
if(TARGET test_transport)
  target_include_directories(test_transport PRIVATE ${CMAKE_SOURCE_DIR}/tests)
endif()
