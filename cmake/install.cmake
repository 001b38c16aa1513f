# `cmake --install build/release --prefix P`: the program and all that belongs to it. Files find each other by relative paths
# (cmake/layout.cmake), so P may be moved as a whole. Target `installable` builds what is installed.
include(CMakePackageConfigHelpers)
set(installed_targets alpenglow_jit)
foreach(module alpenglow_pictures alpenglow_grids alpenglow_gltf alpenglow_models) # where their libraries were found
  if(TARGET ${module})
    list(APPEND installed_targets ${module})
  endif()
endforeach()

# Manual pages and completions, made by the program from the descriptions of its options.
set(help_folder ${CMAKE_BINARY_DIR}/share)
add_custom_command(OUTPUT ${help_folder}/help-files DEPENDS alpenglow ${CMAKE_SOURCE_DIR}/cmake/helpfiles.cmake
  COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:alpenglow> -DOUT=${help_folder} -P ${CMAKE_SOURCE_DIR}/cmake/helpfiles.cmake
  COMMENT "Manual pages and completions" VERBATIM)
add_custom_target(installable ALL
  DEPENDS ${help_folder}/help-files alpenglow alpenglow_c blender_addon narrow_lanes ${installed_targets})

install(TARGETS alpenglow RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS alpenglow_c LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES ${CMAKE_BINARY_DIR}/lib/libri.so ${CMAKE_BINARY_DIR}/lib/librib.so DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS ${installed_targets} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/alpenglow)
install(FILES ${narrow_files} DESTINATION ${CMAKE_INSTALL_LIBDIR}/alpenglow)
if(TARGET _alpenglow)
  add_dependencies(installable _alpenglow)
  set(python_place ${CMAKE_INSTALL_LIBDIR}/alpenglow/python)
  install(TARGETS _alpenglow LIBRARY DESTINATION ${python_place}/alpenglow)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/python/ DESTINATION ${python_place} USE_SOURCE_PERMISSIONS FILES_MATCHING PATTERN "*.py"
    PATTERN "*.pyi" PATTERN py.typed PATTERN oslc PATTERN __pycache__ EXCLUDE)
endif()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/shaders/ DESTINATION ${CMAKE_INSTALL_DATADIR}/alpenglow/shaders)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/editors/vscode DESTINATION ${CMAKE_INSTALL_DATADIR}/alpenglow/editors)
install(DIRECTORY ${help_folder}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR})
foreach(folder bash-completion zsh fish)
  install(DIRECTORY ${help_folder}/${folder} DESTINATION ${CMAKE_INSTALL_DATADIR})
endforeach()

# For programs that call the library, plug-ins and libraries of procedurals: <ri.h> and <alpenglow/rslplugin.h>.
install(FILES ${CMAKE_SOURCE_DIR}/include/ri.h ${CMAKE_SOURCE_DIR}/include/RifPlugin.h ${CMAKE_SOURCE_DIR}/include/alpenglow/rslplugin.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/alpenglow)
set(config_folder ${CMAKE_INSTALL_DATADIR}/cmake/alpenglow)
set(include_folder ${CMAKE_INSTALL_INCLUDEDIR})
set(library_folder ${CMAKE_INSTALL_LIBDIR})
configure_package_config_file(${CMAKE_SOURCE_DIR}/packaging/alpenglowConfig.cmake.in
  ${CMAKE_BINARY_DIR}/packaging/alpenglowConfig.cmake INSTALL_DESTINATION ${config_folder} PATH_VARS include_folder library_folder)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/packaging/alpenglowConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/packaging/alpenglowConfig.cmake ${CMAKE_BINARY_DIR}/packaging/alpenglowConfigVersion.cmake
  DESTINATION ${config_folder})
set(pkgconfig_folder ${CMAKE_INSTALL_DATADIR}/pkgconfig)
file(RELATIVE_PATH pkgconfig_include /${pkgconfig_folder} /${CMAKE_INSTALL_INCLUDEDIR})
file(RELATIVE_PATH pkgconfig_libraries /${pkgconfig_folder} /${CMAKE_INSTALL_LIBDIR})
file(RELATIVE_PATH pkgconfig_shaders /${pkgconfig_folder} /${CMAKE_INSTALL_DATADIR}/alpenglow/shaders)
configure_file(${CMAKE_SOURCE_DIR}/packaging/alpenglow.pc.in ${CMAKE_BINARY_DIR}/packaging/alpenglow.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/packaging/alpenglow.pc DESTINATION ${pkgconfig_folder})

# The desktop: files ending in .rib are shown by `alpenglow view`.
install(FILES ${CMAKE_SOURCE_DIR}/packaging/alpenglow.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES ${CMAKE_SOURCE_DIR}/packaging/alpenglow-mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages
  RENAME alpenglow.xml)
install(FILES ${CMAKE_SOURCE_DIR}/packaging/alpenglow.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)

# The links of the README lead to docs/ and examples/ beside it.
foreach(document README.md CHANGES.md SECURITY.md LICENSE)
  install(FILES ${CMAKE_SOURCE_DIR}/${document} DESTINATION ${CMAKE_INSTALL_DOCDIR})
endforeach()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs ${CMAKE_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
  USE_SOURCE_PERMISSIONS) # examples/procedural has a program

if(ALPENGLOW_TESTS)
  add_test(NAME Install.MovedFolder COMMAND ${CMAKE_SOURCE_DIR}/tests/install/moved_folder ${CMAKE_BINARY_DIR})
  add_test(NAME Package.CleanRoot COMMAND ${CMAKE_SOURCE_DIR}/tests/package/clean_root ${CMAKE_BINARY_DIR})
  set_tests_properties(Install.MovedFolder Package.CleanRoot PROPERTIES LABELS install SKIP_RETURN_CODE 77)
  set_tests_properties(Package.CleanRoot PROPERTIES TIMEOUT 3600)
endif()
