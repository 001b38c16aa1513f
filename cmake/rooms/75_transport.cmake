# Rooms of transport: src/world < src/answers < src/wave < src/transport (docs/architecture.md).
file(GLOB_RECURSE transport_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/world/*.cpp ${CMAKE_SOURCE_DIR}/src/answers/*.cpp
  ${CMAKE_SOURCE_DIR}/src/wave/*.cpp ${CMAKE_SOURCE_DIR}/src/transport/*.cpp)
add_library(transport STATIC ${transport_sources})
target_link_libraries(transport PUBLIC lobes shading)
target_compile_definitions(transport PRIVATE ALPENGLOW_SHADER_DIR="${CMAKE_SOURCE_DIR}/shaders")
