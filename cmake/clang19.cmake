# find_clang19(<variable> NAMES <name>...): the path of a clang of version 19, or <variable>-NOTFOUND. The first of the names found
# that says it is version 19; Debian's clang-19 also installs unversioned names in /usr/lib/llvm-19/bin.
function(is_clang19 validator program)
  execute_process(COMMAND ${program} --version OUTPUT_VARIABLE text ERROR_QUIET RESULT_VARIABLE status)
  if(NOT status EQUAL 0 OR NOT text MATCHES "clang version 19\\.")
    set(${validator} FALSE PARENT_SCOPE)
  endif()
endfunction()
function(find_clang19 variable)
  cmake_parse_arguments(A "" "" "NAMES" ${ARGN})
  find_program(${variable} NAMES ${A_NAMES} PATHS /usr/lib/llvm-19/bin VALIDATOR is_clang19)
  set(${variable} ${${variable}} PARENT_SCOPE)
endfunction()
