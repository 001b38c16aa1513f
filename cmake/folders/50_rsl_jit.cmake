# rsl_jit: kernels, cache, loader. LLVM is in a module of its own that is loaded when a kernel is not in the cache.
find_package(LLVM 19.1 REQUIRED CONFIG PATHS /usr/lib/llvm-19/cmake NO_DEFAULT_PATH)
file(GLOB jit_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/rsl/jit/*.cpp ${CMAKE_SOURCE_DIR}/src/rsl/*.cpp)
file(GLOB jit_llvm_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/rsl/jit/llvm/*.cpp)
# The program and the module pass these types to each other: both hold the digest of their headers and compare it when one loads the
# other. The build ids of both are in the key of the kernel cache.
set(jit_headers ${CMAKE_SOURCE_DIR}/src/rsl/ir/ir.h ${CMAKE_SOURCE_DIR}/src/rsl/kernel.h ${CMAKE_SOURCE_DIR}/src/rsl/jit/module.h
    ${CMAKE_SOURCE_DIR}/src/rsl/front/ast.h ${CMAKE_SOURCE_DIR}/src/rsl/front/plugin.h ${CMAKE_SOURCE_DIR}/src/shadeops/descriptor.h
    ${CMAKE_SOURCE_DIR}/src/shadeops/types.h ${CMAKE_SOURCE_DIR}/src/base/diagnostics.h)
set(jit_stamp ${CMAKE_BINARY_DIR}/generated/rsl/jit/stamp.h)
string(TOUPPER "${CMAKE_BUILD_TYPE}" jit_build_type)
set(jit_compiler "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${jit_build_type}} ${instrument}")
add_custom_command(OUTPUT ${jit_stamp} DEPENDS ${jit_headers} ${CMAKE_SOURCE_DIR}/cmake/stamp.cmake
  COMMAND ${CMAKE_COMMAND} -DOUT=${jit_stamp} "-DFILES=${jit_headers}" "-DEXTRA=${jit_compiler}" -P ${CMAKE_SOURCE_DIR}/cmake/stamp.cmake
  VERBATIM)
add_library(alpenglow_jit MODULE ${jit_llvm_sources} ${jit_stamp})
target_include_directories(alpenglow_jit PRIVATE ${CMAKE_BINARY_DIR}/generated)
target_link_options(alpenglow_jit PRIVATE LINKER:--build-id=sha1)
target_include_directories(alpenglow_jit SYSTEM PRIVATE ${LLVM_INCLUDE_DIRS})
target_compile_options(alpenglow_jit PRIVATE -fvisibility=hidden)
# names of kinds and instructions: the only code shared with the program
target_sources(alpenglow_jit PRIVATE ${CMAKE_SOURCE_DIR}/src/rsl/ir/ir.cpp)
set_source_files_properties(${CMAKE_SOURCE_DIR}/src/rsl/ir/ir.cpp PROPERTIES ALPENGLOW_ALONE ON) # in two libraries
# Where LLVM's archives are there the module holds what it uses of them: it loads in 20 ms of processor time. With the shared
# library, which has all targets and the libraries that these need, it takes 65.
if(TARGET LLVMX86CodeGen)
  llvm_map_components_to_libnames(jit_llvm bitreader coroutines linker passes x86codegen)
  target_link_options(alpenglow_jit PRIVATE LINKER:--as-needed,--gc-sections,--exclude-libs,ALL)
  target_link_libraries(alpenglow_jit PRIVATE ${jit_llvm})
else()
  target_link_libraries(alpenglow_jit PRIVATE LLVM)
endif()
set_target_properties(alpenglow_jit PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

add_library(rsl_jit STATIC ${jit_sources} ${jit_stamp})
target_include_directories(rsl_jit PRIVATE ${CMAKE_BINARY_DIR}/generated)
target_link_options(rsl_jit INTERFACE LINKER:--build-id=sha1)
target_link_libraries(rsl_jit PUBLIC rsl_ir rsl_front shadeops base ${CMAKE_DL_LIBS})
add_dependencies(rsl_jit alpenglow_jit)
folder_tests(rsl/jit DEPS rsl_jit)
if(TARGET test_rsl_jit)
  target_include_directories(test_rsl_jit PRIVATE ${CMAKE_BINARY_DIR}/generated)
endif()
folder_tests(language DEPS rsl_jit)
if(TARGET test_language) # the second evaluator, and the programs that it is asked about
  target_sources(test_language PRIVATE ${CMAKE_SOURCE_DIR}/tests/language/walker.cpp ${CMAKE_SOURCE_DIR}/tests/language/walker_values.cpp
                 ${CMAKE_SOURCE_DIR}/tests/language/walker_shadeops.cpp ${CMAKE_SOURCE_DIR}/tests/language/programs.cpp
                 ${CMAKE_SOURCE_DIR}/tests/language/programs_grammar.cpp)
  target_link_libraries(test_language PRIVATE rapidcheck)
endif()
add_executable(rsl_bench EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/bench/rsl_bench.cpp)
target_link_libraries(rsl_bench PRIVATE rsl_jit)
