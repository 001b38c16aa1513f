# bench/RESULTS.md, "Rays beside Embree".
add_executable(ray_bench EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/bench/ray_bench.cpp ${CMAKE_SOURCE_DIR}/bench/ray_set.cpp
  ${CMAKE_SOURCE_DIR}/bench/box_embree.cpp)
target_include_directories(ray_bench PRIVATE ${CMAKE_SOURCE_DIR})
target_link_libraries(ray_bench PRIVATE render ri integrator embree3)
