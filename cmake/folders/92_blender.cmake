# The add-on for Blender as a file for its "Install add-on": alpenglow-blender.zip in the build folder (docs/blender.md).
set(blender_folder ${CMAKE_SOURCE_DIR}/editors/blender)
file(GLOB_RECURSE blender_files CONFIGURE_DEPENDS RELATIVE ${blender_folder} ${blender_folder}/alpenglow/*.py
  ${blender_folder}/alpenglow/*.sl ${blender_folder}/alpenglow/*.h)
set(blender_sources ${blender_files})
list(TRANSFORM blender_sources PREPEND ${blender_folder}/)
set(blender_zip ${CMAKE_BINARY_DIR}/alpenglow-blender.zip)
add_custom_command(OUTPUT ${blender_zip} DEPENDS ${blender_sources} WORKING_DIRECTORY ${blender_folder}
  COMMAND ${CMAKE_COMMAND} -E rm -f ${blender_zip}
  COMMAND ${CMAKE_COMMAND} -E tar cf ${blender_zip} --format=zip -- ${blender_files} COMMENT "Add-on for Blender" VERBATIM)
add_custom_target(blender_addon ALL DEPENDS ${blender_zip})
install(FILES ${blender_zip} DESTINATION ${CMAKE_INSTALL_DATADIR}/alpenglow/editors)

# Exporters of others and ours: nightly, each only where its program is installed (status 77: skipped).
if(ALPENGLOW_TESTS)
  foreach(exporter blender vtk geomview mayavi)
    if(EXISTS ${CMAKE_SOURCE_DIR}/tests/exporters/${exporter}_test.py)
      string(SUBSTRING ${exporter} 0 1 first)
      string(TOUPPER ${first} first)
      string(SUBSTRING ${exporter} 1 -1 rest)
      add_test(NAME Exporters.${first}${rest} COMMAND ${Python3_EXECUTABLE}
        ${CMAKE_SOURCE_DIR}/tests/exporters/${exporter}_test.py
        $<TARGET_FILE:alpenglow> ${CMAKE_BINARY_DIR}/exporters/${exporter})
      set_tests_properties(Exporters.${first}${rest} PROPERTIES LABELS exporters SKIP_RETURN_CODE 77 TIMEOUT 3600)
    endif()
  endforeach()
endif()
