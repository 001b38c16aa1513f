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

# So does the RSL that shaders get from the program itself: library/FOLDER/NAME.sl defines NAME.
set(library_table "")
foreach(folder functions:Function structures:Structure classes:Class)
  string(REGEX REPLACE ".*:" "" library_kind ${folder})
  string(REGEX REPLACE ":.*" "" library_folder ${folder})
  file(GLOB library_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/rsl/library/${library_folder}/*.sl)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${library_files})
  foreach(f ${library_files})
    get_filename_component(library_name ${f} NAME_WE)
    file(READ ${f} library_text)
    string(APPEND library_table
      "    {LibraryText::Kind::${library_kind}, \"${library_name}\", R\"__rsl__(${library_text})__rsl__\"},\n")
  endforeach()
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/rsl_library.cpp @ONLY CONTENT [[// Generated from src/rsl/library.
#include "rsl/front/library.h"
namespace alpenglow::rsl::front {
static constexpr LibraryText kTexts[] = {
@library_table@};
std::span<const LibraryText> libraryTexts() { return kTexts; }
} // namespace alpenglow::rsl::front
]])
target_sources(rsl_front PRIVATE ${CMAKE_BINARY_DIR}/generated/shipped_headers.cpp ${CMAKE_BINARY_DIR}/generated/rsl_library.cpp)
