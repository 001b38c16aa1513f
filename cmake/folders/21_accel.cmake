folder_library(accel DEPS geometry)
# Searches of small scenes in lanes, once for each width and the processors that have it; accel/directblock.cpp chooses.
foreach(way "4 v2" "8 v3" "16 v4")
  separate_arguments(way)
  list(GET way 0 lanes)
  list(GET way 1 level)
  set(file ${CMAKE_BINARY_DIR}/lanes/direct${lanes}.cpp)
  file(CONFIGURE OUTPUT ${file} CONTENT "#define ALPENGLOW_LANES ${lanes}\n#define ALPENGLOW_STAGES ${lanes}${level}\n#include \"accel/lanes/direct.inc\"\n")
  set_source_files_properties(${file} PROPERTIES COMPILE_OPTIONS
    "-march=x86-64-${level};-mprefer-vector-width=512;-fno-vectorize;-fno-slp-vectorize;-fno-builtin")
  target_sources(accel PRIVATE ${file})
endforeach()
folder_tests(accel DEPS accel)
