folder_library(rsl/front DEPS rsl_messages shadeops base)
folder_tests(rsl/front DEPS rsl_front)

# The headers in shaders/include go into the program: they are found wherever it is installed.
file(GLOB shipped_headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/include/*.h)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${shipped_headers})
set(header_table "")
foreach(h ${shipped_headers})
  get_filename_component(header_name ${h} NAME)
  file(READ ${h} header_text)
  string(APPEND header_table "    {\"${header_name}\", R\"__rsl__(${header_text})__rsl__\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/shipped_headers.cpp @ONLY CONTENT [[// Generated from shaders/include.
#include "rsl/front/headers.h"
namespace alpenglow::rsl::front {
static constexpr ShippedHeader kHeaders[] = {
@header_table@};
std::span<const ShippedHeader> shippedHeaders() { return kHeaders; }
} // namespace alpenglow::rsl::front
]])
target_sources(rsl_front PRIVATE ${CMAKE_BINARY_DIR}/generated/shipped_headers.cpp)
