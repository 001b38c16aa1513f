# Of the room itself, and of photons on their way through the engine.
room_tests(photons DEPS photons integrator ri render)
if(TARGET test_photons)
  target_include_directories(test_photons PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(test_photons PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_photons alpenglow)
endif()
