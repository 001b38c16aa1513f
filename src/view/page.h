// The files of the page of a view (src/view/page), which are built into the program.
#pragma once
#include <cstddef>
#include <string>

namespace alpenglow::view {

struct PageFile {
    const char* name;
    const char* type;
    const char* text;
    size_t size;
};
/// Null: there is none of that name.
const PageFile* pageFile(const std::string& name);

} // namespace alpenglow::view
