#include "ri/library.h"
#include "base/installation.h"
#include "ri/c/client.h"
#include "scene/scene.h"
#include <dlfcn.h>
#include <exception>
#include <fmt/format.h>
#include <unistd.h>

namespace alpenglow::ri {

namespace {

/// One function of every file of the C binding, so that a program that has this file has them all (a static library gives only
/// what is asked for) and libraries find them in it.
[[gnu::used]] const void* const kBinding[] = {
    reinterpret_cast<const void*>(&RiDeclare),      reinterpret_cast<const void*>(&RiPolygonV),
    reinterpret_cast<const void*>(&RiFormat),       reinterpret_cast<const void*>(&RiMakeTextureV),
    reinterpret_cast<const void*>(&RiReadArchiveV), reinterpret_cast<const void*>(&RiErrorPrint),
    reinterpret_cast<const void*>(&RiBoxFilter),    reinterpret_cast<const void*>(&RiBxdfV)};

/// Where the binding is in a library that was itself loaded for its loader alone (Python's ctypes, cgkit), others do not see it.
void offerBinding() {
    static const bool offered = dlopen(codeFile().c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL) != nullptr;
    (void)offered; // false: it is in the program
}

} // namespace

std::unique_ptr<Library> Library::load(const std::string& path, std::string& why) {
    offerBinding();
    void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        const char* reason = dlerror();
        why = fmt::format("it cannot be loaded: {}", reason ? reason : "no reason was given");
        return nullptr;
    }
    std::string missing;
    const auto symbol = [&](const char* name) {
        void* s = dlsym(handle, name);
        if (!s) missing += (missing.empty() ? "" : ", ") + std::string(name);
        return s;
    };
    auto l = std::make_unique<Library>();
    l->path = path;
    l->convertParameters = reinterpret_cast<decltype(l->convertParameters)>(symbol("ConvertParameters"));
    l->subdivide = reinterpret_cast<decltype(l->subdivide)>(symbol("Subdivide"));
    l->free = reinterpret_cast<decltype(l->free)>(symbol("Free"));
    if (missing.empty()) return l;
    why = fmt::format("it does not define {}", missing);
    return nullptr;
}

/// The library of a name, loaded at its first use. Null if it cannot be loaded, which is reported once.
const Library* Interpreter::libraryOf(const std::string& name, const SourcePlace& place) {
    const auto [slot, fresh] = libraries_.try_emplace(name);
    if (!fresh) return slot->second.get();
    std::string looked, why;
    const std::string path = findForeign({name, name + ".so", "lib" + name + ".so"}, R_OK, looked);
    if (path.empty()) {
        reporter.error(Rie::NoFile, place, fmt::format("library \"{}\" of procedurals was not found", name),
                       "looked in " + looked + "; Option \"searchpath\" \"procedural\" names folders");
        return nullptr;
    }
    slot->second = Library::load(path, why);
    if (!slot->second)
        reporter.error(Rie::System, place, fmt::format("library \"{}\" of procedurals: {}", path, why),
                       "ConvertParameters, Subdivide and Free are what it needs, by C names; include/ri.h has what it may call");
    return slot->second.get();
}

void Interpreter::runLibrary(const std::string& name, const std::string& data, const std::vector<float>& bound,
                             const Call& call) {
    if (!frameWanted()) return;
    const Library* library = libraryOf(name, call.place);
    if (!library) return;
    std::vector<char> text(data.c_str(), data.c_str() + data.size() + 1); // a copy: a library may write into it
    try {
        void* own = library->convertParameters(text.data());
        subdivide([&](float detail) { library->subdivide(own, detail); }, name, bound, call);
        library->free(own);
    } catch (const std::exception& e) {
        reporter.error(Rie::System, call.place, fmt::format("library \"{}\" of procedurals threw: {}", name, e.what()));
    }
}

void Interpreter::subdivide(const std::function<void(float)>& make, const std::string& name, const std::vector<float>& bound,
                            const Call& call) {
    if (motion_) {
        reporter.error(Rie::BadMotion, call.place, "Procedural cannot be in a motion block");
        return;
    }
    if (!mayMake(call)) return;
    const double detail = detailOf(bound);
    if (detail < 0) return; // not in the picture
    if (!begin(BlockKind::Attribute, call)) return;
    inPart(fmt::format("library:{}", ++programSerial_), [&] {
        const LibraryCalls calls(*this, call);
        const auto threw = [&](const char* what) { // C++ libraries may; what they made before stays
            reporter.error(Rie::System, call.place,
                           (name.empty() ? "the function of a Procedural" : fmt::format("library \"{}\" of procedurals", name)) +
                               " threw" + what);
        };
        try {
            make(detail < 1e38 ? float(detail) : RI_INFINITY);
        } catch (const std::exception& e) { threw((std::string(": ") + e.what()).c_str()); } catch (...) {
            threw("");
        }
        return call.place;
    });
    end(BlockKind::Attribute, call);
}

} // namespace alpenglow::ri
