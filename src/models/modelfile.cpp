#include "models/modelfile.h"
#include "base/childmodule.h"
#include "base/installation.h"
#include "base/limits.h"
#include "models/check.h"
#include "models/stream.h"
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>

namespace alpenglow::models {

namespace {

struct Module {
    const char *file, *variable, *needs;
};
constexpr Module kGltf{"libalpenglow_gltf.so", "ALPENGLOW_GLTF", "Draco (libdraco7)"};
constexpr Module kOthers{"libalpenglow_models.so", "ALPENGLOW_MODELS", "assimp (libassimp5)"};

std::string ending(const std::string& path) {
    std::string e = std::filesystem::path(path).extension().string();
    for (char& c : e) c = char(std::tolower(static_cast<unsigned char>(c)));
    return e;
}

const Module& moduleFor(const std::string& path) {
    const std::string e = ending(path);
    return e == ".gltf" || e == ".glb" ? kGltf : kOthers;
}

void refuse(Diagnostics& d, const std::string& path, const std::string& why, Rie code = Rie::BadFile) {
    d.report(Severity::Error, code, {path, 0, 0}, fmt::format("the model cannot be read: {}", why));
}

std::optional<Model> received(const ChildResult& child, const std::string& path, Diagnostics& d) {
    std::vector<uint8_t> bytes(writtenBytes(child));
    std::optional<Model> m;
    if (readWritten(child, bytes.data(), bytes.size())) m = fromBytes(bytes);
    if (!m) {
        refuse(d, path, "the module that reads it was built from other sources than this program");
        return {};
    }
    bytes = {};
    check(*m);
    int count = 0;
    for (const Note& n : m->notes)
        if (count++ < limits::kModelMessages)
            d.report(n.error ? Severity::Error : Severity::Warning, n.error ? Rie::Range : Rie::Incapable, {path, 0, 0}, n.text);
    if (count > limits::kModelMessages)
        d.report(Severity::Warning, Rie::Limit, {path, 0, 0}, fmt::format("{} more notes", count - limits::kModelMessages));
    return m;
}

} // namespace

const std::vector<std::string>& foreignEndings() {
    static const std::vector<std::string> all = {".gltf", ".glb", ".fbx", ".dae", ".3ds", ".stl",  ".blend", ".x",   ".x3d",
                                                 ".lwo",  ".ac",  ".ase", ".off", ".dxf", ".ms3d", ".b3d",   ".3mf", ".amf",
                                                 ".md2",  ".md3", ".cob", ".ifc", ".smd", ".bvh",  ".irr",   ".lws", ".nff"};
    return all;
}

bool namedAsForeignModel(const std::string& path) {
    const std::vector<std::string>& all = foreignEndings();
    return std::find(all.begin(), all.end(), ending(path)) != all.end();
}

std::string moduleOf(const std::string& path) {
    const Module& of = moduleFor(path);
    return moduleFile(of.file, of.variable);
}

std::optional<Model> readForeignModel(const std::string& path, Diagnostics& d) {
    std::error_code e;
    const auto bytes = std::filesystem::file_size(path, e);
    if (e) {
        refuse(d, path, e.message(), Rie::NoFile);
        return {};
    }
    if (bytes > limits::kModelBytes) {
        refuse(d, path, fmt::format("it is larger than {} GiB", limits::kModelBytes >> 30), Rie::Limit);
        return {};
    }
    const Module& of = moduleFor(path);
    const std::string module = moduleOf(path);
    if (module.empty()) {
        d.report(Severity::Error, Rie::Incapable, {path, 0, 0},
                 fmt::format("the module that reads such models, {}, is not there", of.file),
                 "docs/models.md says what it is built from; .ply and .obj are read without it");
        return {};
    }
    const ChildResult child =
        runChildModule(module, kReadForeignModel, kForeignModelBytes, [&](void* function, int to, char* why, int size) {
            return reinterpret_cast<ReadForeignModel>(function)(path.c_str(), to, why, size);
        });
    using End = ChildResult::End;
    switch (child.end) {
    case End::Done:
        return received(child, path, d);
    case End::Late:
        refuse(d, path, fmt::format("its reader took more than {} seconds", limits::kProgramSeconds), Rie::Limit);
        break;
    case End::Signal:
        refuse(d, path, fmt::format("its reader ended by signal {}", child.signal));
        break;
    case End::NoModule:
        refuse(d, path, fmt::format("{} cannot be loaded: {} (it needs {})", of.file, child.why, of.needs), Rie::Incapable);
        break;
    case End::NoChild:
    case End::Failed:
        refuse(d, path, child.why.empty() ? "its reader failed" : child.why);
        break;
    }
    return {};
}

} // namespace alpenglow::models
