folder_library(base DEPS TBB::tbb fmt::fmt Threads::Threads)
include(cmake/layout.cmake)
target_include_directories(base PRIVATE ${CMAKE_BINARY_DIR}/generated)
# The sampler in lanes, once for each width and the processors that have it; base/numberlanes.cpp chooses.
foreach(way "4 v2" "8 v3" "16 v4")
  separate_arguments(way)
  list(GET way 0 lanes)
  list(GET way 1 level)
  set(file ${CMAKE_BINARY_DIR}/lanes/numbers${lanes}.cpp)
  file(CONFIGURE OUTPUT ${file} CONTENT "#define ALPENGLOW_LANES ${lanes}\n#include \"base/lanes/numbers.inc\"\n")
  set_source_files_properties(${file} PROPERTIES COMPILE_OPTIONS
    "-march=x86-64-${level};-mprefer-vector-width=512;-fno-vectorize;-fno-slp-vectorize;-fno-builtin")
  target_sources(base PRIVATE ${file})
endforeach()
find_path(XXHASH_HEADERS xxhash.h REQUIRED) # base/digest.cpp, nothing is linked
folder_tests(base DEPS base)
