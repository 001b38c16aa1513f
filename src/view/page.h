// The files of the page of a view (src/view/page), which are built into the program.
#pragma once
#include <cstddef>
#include <string>

namespace alpenglow::view {

/// A file of the page, compiled into the program.
struct PageFile {
    const char* name; ///< in the URL
    const char* type; ///< media type
    const char* text; ///< contents, zero-terminated
    size_t size;      ///< bytes, without the zero
};
/// Null: there is none of that name.
const PageFile* pageFile(const std::string& name);

} // namespace alpenglow::view
