# libalpenglow.so: the C binding for programs that draw or write RIB (include/ri.h, docs/capi.md), also as libri.so and librib.so. It
# has all of the program; only the binding can be seen from outside.
folder_library(capi DEPS cli)
target_include_directories(capi PRIVATE ${CMAKE_SOURCE_DIR}/include)
add_library(alpenglow_c SHARED ${CMAKE_BINARY_DIR}/generated/alpenglow_c.cpp)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/alpenglow_c.cpp CONTENT "// libalpenglow.so is made of libraries alone.\n")
target_link_libraries(alpenglow_c PRIVATE capi)
set(capi_exports ${CMAKE_SOURCE_DIR}/src/capi/exports.map)
target_link_options(alpenglow_c PRIVATE LINKER:--version-script=${capi_exports} LINKER:--undefined=RiBegin)
set_target_properties(alpenglow_c PROPERTIES OUTPUT_NAME alpenglow SOVERSION ${PROJECT_VERSION_MAJOR}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib LINK_DEPENDS ${capi_exports})
foreach(name libri librib) # as programs load it
  add_custom_command(TARGET alpenglow_c POST_BUILD VERBATIM
    COMMAND ${CMAKE_COMMAND} -E create_symlink libalpenglow.so ${CMAKE_BINARY_DIR}/lib/${name}.so)
endforeach()

folder_tests(capi DEPS capi display)
if(TARGET test_capi)
  target_include_directories(test_capi PRIVATE ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/tests)
  # Programs as anyone would build them: C of 1989, the header, the library.
  foreach(program examples orders)
    add_executable(capi_${program} ${CMAKE_SOURCE_DIR}/tests/capi/programs/${program}.c)
    set_target_properties(capi_${program} PROPERTIES C_STANDARD 90 C_EXTENSIONS OFF RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/capi)
    target_compile_options(capi_${program} PRIVATE -pedantic-errors)
    target_include_directories(capi_${program} PRIVATE ${CMAKE_SOURCE_DIR}/include)
    target_link_libraries(capi_${program} PRIVATE alpenglow_c)
    add_dependencies(test_capi capi_${program})
  endforeach()
  target_compile_definitions(test_capi PRIVATE ALPENGLOW_CAPI_PROGRAMS="${CMAKE_BINARY_DIR}/capi"
    ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>" ALPENGLOW_LIBRARY="$<TARGET_FILE:alpenglow_c>"
    ALPENGLOW_PROCEDURALS="${CMAKE_BINARY_DIR}/procedurals")
  add_dependencies(test_capi alpenglow procedural_facets)
endif()
