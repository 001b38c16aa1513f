# The IR and its passes: two folders, one library.
file(GLOB rsl_ir_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/rsl/ir/*.cpp ${CMAKE_SOURCE_DIR}/src/rsl/passes/*.cpp)
if(rsl_ir_sources)
  add_library(rsl_ir STATIC ${rsl_ir_sources})
  target_link_libraries(rsl_ir PUBLIC rsl_front shadeops base)
endif()
folder_tests(rsl/ir DEPS rsl_ir)
