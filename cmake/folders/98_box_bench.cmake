# bench/RESULTS.md, "The Muttenzer box".
add_executable(box_bench EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/bench/box_bench.cpp ${CMAKE_SOURCE_DIR}/bench/box_embree.cpp
  ${CMAKE_SOURCE_DIR}/bench/box_oracle_time.cpp ${CMAKE_SOURCE_DIR}/bench/box_oracle_count.cpp ${CMAKE_SOURCE_DIR}/bench/profile.cpp)
target_include_directories(box_bench PRIVATE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/tests)
target_compile_definitions(box_bench PRIVATE ALPENGLOW_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
target_link_libraries(box_bench PRIVATE render ri integrator embree3 ${CMAKE_DL_LIBS})
