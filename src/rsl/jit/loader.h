// A relocatable ELF file, as our code generator makes them, brought into memory: enough of a linker for x86-64, none of LLVM.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace alpenglow::rsl::jit {

/// Machine code in memory. Pages are never writable and executable at once.
class LoadedObject {
public:
    /// Addresses of functions outside, by name, besides the few of the C library; null for what it does not know.
    using Outside = std::function<void*(const std::string& name)>;
    /// Null with the reason in `error` when the file is damaged or needs what we do not provide (sections, relocations, symbols).
    static std::unique_ptr<LoadedObject> load(const std::string& elf, std::string& error, const Outside& = {});
    ~LoadedObject();
    LoadedObject(const LoadedObject&) = delete;
    LoadedObject& operator=(const LoadedObject&) = delete;
    /// Address of a function that the object defines, or null.
    void* find(const std::string& name) const;

private:
    LoadedObject() = default;
    void* memory_ = nullptr;
    size_t size_ = 0;
    std::map<std::string, void*> symbols_;
};

} // namespace alpenglow::rsl::jit
