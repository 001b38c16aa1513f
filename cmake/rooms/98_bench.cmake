# What is measured (bench/RESULTS.md). Not part of the default build: `ninja bench` builds all of it, bench/run.sh runs it.
add_custom_target(bench)
add_executable(pattern_bench EXCLUDE_FROM_ALL bench/pattern_bench.cpp)
# The hand-written patterns: for every processor and width a file of one include. Straight code: no loop or basic block is vectorised.
foreach(way "scalar kScalar 1 v4" "avx512_16 kAvx512x16 16 v4" "avx512_32 kAvx512x32 32 v4" "avx512_64 kAvx512x64 64 v4"
            "avx2_scalar kAvx2Scalar 1 v3" "avx2_8 kAvx2x8 8 v3" "avx2_16 kAvx2x16 16 v3")
  separate_arguments(way)
  list(GET way 0 name)
  list(GET way 1 list)
  list(GET way 2 lanes)
  list(GET way 3 level)
  set(file ${CMAKE_BINARY_DIR}/bench/hand_${name}.cpp)
  file(CONFIGURE OUTPUT ${file} CONTENT "#define HAND_LIST ${list}\n#define HAND_LANES ${lanes}\n#include \"hand_patterns.inc\"\n")
  set_source_files_properties(${file} PROPERTIES COMPILE_OPTIONS
    "-O3;-march=x86-64-${level};-mprefer-vector-width=512;-fno-vectorize;-fno-slp-vectorize;-Wno-explicit-specialization-storage-class")
  target_sources(pattern_bench PRIVATE ${file})
endforeach()
target_include_directories(pattern_bench PRIVATE bench/patterns)
target_link_libraries(pattern_bench PRIVATE display base)
add_dependencies(bench pattern_bench rsl_bench)
add_executable(rib_bench EXCLUDE_FROM_ALL bench/rib_bench.cpp)
target_link_libraries(rib_bench PRIVATE ri)
add_dependencies(bench rib_bench)
