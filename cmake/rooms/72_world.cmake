room(world DEPS lobes clouds photons shading)
target_compile_definitions(world PRIVATE ALPENGLOW_SHADER_DIR="${CMAKE_SOURCE_DIR}/shaders")
