# The program: build/<preset>/bin/alpenglow. Its tests run it as a user does.
# All but main() is a library, which the fuzzer has, too.
file(GLOB cli_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/cli/*.cpp)
list(FILTER cli_sources EXCLUDE REGEX "/main[.]cpp$")
find_package(CLI11 REQUIRED)
add_library(cli STATIC ${cli_sources})
target_link_libraries(cli PUBLIC view render ri models integrator shading texture display pointcloud photonmap ptex rsl_jit shadeops base
                      CLI11::CLI11 nlohmann_json::nlohmann_json)
add_executable(alpenglow ${CMAKE_SOURCE_DIR}/src/cli/main.cpp)
target_link_libraries(alpenglow PRIVATE cli)
add_custom_target(commit_header
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_SOURCE_DIR} -DOUT=${CMAKE_BINARY_DIR}/generated/alpenglow_commit.h -P ${CMAKE_SOURCE_DIR}/cmake/commit.cmake
  BYPRODUCTS ${CMAKE_BINARY_DIR}/generated/alpenglow_commit.h COMMENT "The commit, for --version" VERBATIM)
add_dependencies(cli commit_header)
set_source_files_properties(${CMAKE_SOURCE_DIR}/src/cli/version.cpp PROPERTIES ALPENGLOW_ALONE ON) # a new commit compiles it again
target_include_directories(cli PRIVATE ${CMAKE_BINARY_DIR}/generated)
folder_tests(cli DEPS render display integrator)
if(TARGET test_cli)
  target_compile_definitions(test_cli PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_cli alpenglow)
endif()

# The pages made from tables; tests of this folder fail when a page is not what this makes.
add_custom_target(shadeops_manual
  COMMAND alpenglow info --shadeops --markdown > ${CMAKE_SOURCE_DIR}/docs/shadeops.md
  COMMAND alpenglow info --requests --markdown > ${CMAKE_SOURCE_DIR}/docs/rib.md
  COMMAND alpenglow info --options --markdown > ${CMAKE_SOURCE_DIR}/docs/options.md
  COMMAND alpenglow info --messages --markdown > ${CMAKE_SOURCE_DIR}/docs/messages.md
  DEPENDS alpenglow COMMENT "docs/shadeops.md, docs/rib.md, docs/options.md, docs/messages.md" VERBATIM)
