# Of the folder itself, and of photons on their way through the engine.
folder_tests(photonmap DEPS photonmap integrator ri render)
if(TARGET test_photonmap)
  target_include_directories(test_photonmap PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(test_photonmap PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_photonmap alpenglow)
endif()
