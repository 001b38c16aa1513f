folder_library(shadeops DEPS base)
folder_tests(shadeops DEPS shadeops)
if(TARGET test_shadeops)
  target_sources(test_shadeops PRIVATE ${CMAKE_SOURCE_DIR}/tests/shadeops/jets_runtime.cpp)
endif()

# The runtime as bitcode, one file a lane width, from the same headers as the program's own copy (src/shadeops/sections.cpp).
# clang 19 whatever compiles the rest: the JIT reads LLVM 19 bitcode. The target attributes only set what vector code is sensible.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^19[.]")
  set(ALPENGLOW_CLANG ${CMAKE_CXX_COMPILER})
else()
  include(cmake/clang19.cmake)
  find_clang19(ALPENGLOW_CLANG NAMES clang++-19 clang++)
  if(NOT ALPENGLOW_CLANG)
    message(FATAL_ERROR "no clang 19 found for the runtime's bitcode: install clang-19 or set ALPENGLOW_CLANG")
  endif()
endif()
set(bitcode_dir ${CMAKE_BINARY_DIR}/bitcode)
file(MAKE_DIRECTORY ${bitcode_dir})
set(bitcode_source ${CMAKE_SOURCE_DIR}/src/shadeops/bitcode/runtime.inc)
# Bitcode holds the name of the file that was compiled, and the program holds the bitcode: this name has no folder of the build in it.
file(CONFIGURE OUTPUT ${bitcode_dir}/runtime.cpp CONTENT "#include \"shadeops/bitcode/runtime.inc\"\n")
foreach(lanes 4 8 16 32 64)
  set(march x86-64-v4)
  if(lanes EQUAL 4)
    set(march x86-64-v2)
  elseif(lanes EQUAL 8)
    set(march x86-64-v3)
  endif()
  set(bc ${bitcode_dir}/runtime${lanes}.bc)
  add_custom_command(OUTPUT ${bc}
    COMMAND ${ALPENGLOW_CLANG} -x c++ -std=c++20 -O2 -c -emit-llvm -march=${march} -DALPENGLOW_BITCODE -DALPENGLOW_LANES=${lanes}
      -ffp-contract=off -fno-math-errno -fno-trapping-math -fno-exceptions -fno-rtti -fno-vectorize -fno-slp-vectorize -fno-builtin
      -fno-stack-protector -fno-asynchronous-unwind-tables -Wall -Wno-psabi -I${CMAKE_SOURCE_DIR}/src
      -MD -MF ${bc}.d -MT ${bc} bitcode/runtime.cpp -o ${bc}
    WORKING_DIRECTORY ${CMAKE_BINARY_DIR} DEPENDS ${bitcode_source} DEPFILE ${bc}.d COMMENT "Runtime bitcode, ${lanes} lanes" VERBATIM)
endforeach()
# The program holds those of 16 lanes and more. Only --lanes asks for fewer: these are files beside its modules, so that ./render
# need not wait for them. They end in a digest of what the program holds, which takes none from other sources.
set(bitcode_names runtime16.bc runtime32.bc runtime64.bc)
set(bitcode_files ${bitcode_names})
list(TRANSFORM bitcode_files PREPEND ${bitcode_dir}/)
add_custom_command(OUTPUT ${bitcode_dir}/hash.txt
  COMMAND ${CMAKE_COMMAND} -E sha256sum ${bitcode_names} > hashes.txt
  COMMAND ${CMAKE_COMMAND} -E sha256sum hashes.txt > hash.txt
  DEPENDS ${bitcode_files} WORKING_DIRECTORY ${bitcode_dir} VERBATIM)
set(narrow_files)
foreach(lanes 4 8)
  set(file ${CMAKE_BINARY_DIR}/bin/alpenglow_runtime${lanes}.bc)
  add_custom_command(OUTPUT ${file} COMMAND ${CMAKE_COMMAND} -E cat runtime${lanes}.bc hash.txt > ${file}
    DEPENDS ${bitcode_dir}/runtime${lanes}.bc ${bitcode_dir}/hash.txt WORKING_DIRECTORY ${bitcode_dir} VERBATIM)
  list(APPEND narrow_files ${file})
endforeach()
add_custom_target(narrow_lanes ALL DEPENDS ${narrow_files})
set_source_files_properties(${CMAKE_SOURCE_DIR}/src/shadeops/bitcode.cpp PROPERTIES
  OBJECT_DEPENDS "${bitcode_files};${bitcode_dir}/hash.txt"
  COMPILE_DEFINITIONS "ALPENGLOW_BITCODE_DIR=\"${bitcode_dir}\"")
