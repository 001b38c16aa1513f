find_path(BEAST_HEADERS boost/beast/http/parser.hpp REQUIRED) # httpserver.cpp, nothing is linked
folder_library(view DEPS render ri nlohmann_json::nlohmann_json)
# The page goes into the program. Its library is of its own, so that a change of the page builds one small file.
file(GLOB page_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/view/page/*)
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/generated/view_page.cpp DEPENDS ${page_files} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
  COMMAND ${CMAKE_COMMAND} -DOUT=${CMAKE_BINARY_DIR}/generated/view_page.cpp "-DFILES=${page_files}" -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
  COMMENT "The page of alpenglow view" VERBATIM)
target_sources(view PRIVATE ${CMAKE_BINARY_DIR}/generated/view_page.cpp)
