room(world DEPS lobes clouds photons ptex shading)
target_compile_definitions(world PRIVATE ALPENGLOW_SHADER_DIR="${CMAKE_SOURCE_DIR}/shaders")
