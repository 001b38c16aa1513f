# Where installed files are, for the program (base/installation.h) and for cmake/install.cmake: paths relative to the program's
# folder, so that an installation can be moved. The version goes the same way.
include(GNUInstallDirs)
file(RELATIVE_PATH installed_modules ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/alpenglow)
file(RELATIVE_PATH installed_shaders ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/alpenglow/shaders)
# The same from libalpenglow.so, and from the package of Python (its folder's parent is what PYTHONPATH names).
set(installed_python ${CMAKE_INSTALL_LIBDIR}/alpenglow/python/alpenglow)
file(RELATIVE_PATH library_shaders ${CMAKE_INSTALL_FULL_LIBDIR} ${CMAKE_INSTALL_FULL_DATADIR}/alpenglow/shaders)
file(RELATIVE_PATH python_shaders ${CMAKE_INSTALL_FULL_LIBDIR}/alpenglow/python/alpenglow
  ${CMAKE_INSTALL_FULL_DATADIR}/alpenglow/shaders)
configure_file(${CMAKE_SOURCE_DIR}/cmake/configured.h.in ${CMAKE_BINARY_DIR}/generated/base/configured.h @ONLY)

# The build folder has the layout of an installation: programs in bin/ find the shaders where installed ones do.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/alpenglow)
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/shaders ${CMAKE_BINARY_DIR}/share/alpenglow/shaders SYMBOLIC)
