folder_library(bsdf DEPS shadeops base)
folder_tests(bsdf DEPS bsdf)
# The stages in lanes, once for each width and the processors that have it; bsdf/lobelanes.cpp chooses. Nothing in them is
# vectorised beyond what the source says.
foreach(way "1 v2" "1 v3" "4 v2" "8 v3" "16 v4")
  separate_arguments(way)
  list(GET way 0 lanes)
  list(GET way 1 level)
  set(file ${CMAKE_BINARY_DIR}/lanes/stages${lanes}${level}.cpp)
  file(CONFIGURE OUTPUT ${file} CONTENT "#define ALPENGLOW_LANES ${lanes}\n#define ALPENGLOW_STAGES ${lanes}${level}\n#include \"bsdf/lanes/stages.inc\"\n")
  set_source_files_properties(${file} PROPERTIES COMPILE_OPTIONS
    "-march=x86-64-${level};-mprefer-vector-width=512;-fno-vectorize;-fno-slp-vectorize;-fno-builtin")
  target_sources(bsdf PRIVATE ${file})
endforeach()
