# Of the room itself, and of photons on their way through the engine.
room_tests(photons DEPS photons transport ri render)
if(TARGET test_photons)
  target_include_directories(test_photons PRIVATE ${CMAKE_SOURCE_DIR}/tests)
endif()
