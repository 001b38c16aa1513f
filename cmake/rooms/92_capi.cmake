# libalpenglow.so: the C binding for programs that draw or write RIB (include/ri.h, docs/capi.md), also as libri.so and librib.so. It
# has all of the program; only the binding can be seen from outside.
add_library(alpenglow_c SHARED)
file(GLOB capi_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/capi/*.cpp)
target_sources(alpenglow_c PRIVATE ${capi_sources})
target_include_directories(alpenglow_c PRIVATE ${CMAKE_SOURCE_DIR}/include)
target_link_libraries(alpenglow_c PRIVATE cli)
set(capi_exports ${CMAKE_SOURCE_DIR}/src/capi/exports.map)
target_link_options(alpenglow_c PRIVATE LINKER:--version-script=${capi_exports} LINKER:--build-id=sha1)
set_target_properties(alpenglow_c PROPERTIES OUTPUT_NAME alpenglow SOVERSION ${PROJECT_VERSION_MAJOR}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib LINK_DEPENDS ${capi_exports})
foreach(name libri librib) # as programs load it
  add_custom_command(TARGET alpenglow_c POST_BUILD VERBATIM
    COMMAND ${CMAKE_COMMAND} -E create_symlink libalpenglow.so ${CMAKE_BINARY_DIR}/lib/${name}.so)
endforeach()
