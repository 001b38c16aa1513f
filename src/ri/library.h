// Libraries that a scene has make content (Procedural "DynamicLoad").
#pragma once
#include <memory>
#include <string>

namespace alpenglow::ri {

/// The three functions of a library (include/ri.h). What they do, the program does: they run in it.
struct Library {
    /// As in include/ri.h.
    void* (*convertParameters)(const char* data) = nullptr;
    void (*subdivide)(void* data, float detail) = nullptr;
    void (*free)(void* data) = nullptr;
    std::string path; ///< the file

    /// Null with a reason when the file is no library that can be loaded here, or lacks one of the functions. It stays loaded: it
    /// may have threads of its own.
    static std::unique_ptr<Library> load(const std::string& path, std::string& why);
};

} // namespace alpenglow::ri
