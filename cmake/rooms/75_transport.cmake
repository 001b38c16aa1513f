room(transport DEPS shading)
target_compile_definitions(transport PRIVATE ALPENGLOW_SHADER_DIR="${CMAKE_SOURCE_DIR}/shaders")
