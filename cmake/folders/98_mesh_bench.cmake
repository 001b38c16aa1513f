# Large meshes (bench/RESULTS.md).
add_executable(mesh_bench EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/bench/mesh_bench.cpp)
target_include_directories(mesh_bench PRIVATE ${CMAKE_SOURCE_DIR})
target_link_libraries(mesh_bench PRIVATE render ri integrator)
