// Files of models that modules read: libalpenglow_gltf.so (tinygltf) and libalpenglow_models.so (assimp). Either may be missing.
// They work in a child process (base/childmodule.h).
#pragma once
#include "base/diagnostics.h"
#include "models/model.h"
#include <optional>

namespace alpenglow::models {

/// Whether a name ends as such files do: .gltf and .glb, or one of assimp's. Not .ply and .obj, which ri/models reads.
bool namedAsForeignModel(const std::string& path);
/// The endings, with dots, for messages and documents.
const std::vector<std::string>& foreignEndings();

/// The file of the module that reads models of such a name (base/installation.h); "" when it is not there.
std::string moduleOf(const std::string& path);

/// The file, checked (check.h). Its notes are reported. Nothing: an error was reported, which says so when it is the module that
/// is missing.
std::optional<Model> readForeignModel(const std::string& path, Diagnostics&);

/// The one function of a module: reads the file at `path` and writes toBytes() of its model to the descriptor `to`; 0 when it is
/// done. Else `why`, of whySize bytes, says what went wrong.
using ReadForeignModel = int (*)(const char* path, int to, char* why, int whySize);
inline constexpr const char* kReadForeignModel = "alpenglow_read_model";
/// Bytes of memory that a module may take.
inline constexpr uint64_t kForeignModelBytes = uint64_t(8) << 30;

/// What the function of a module does around its reader, which throws std::exception with a text.
int sendModel(const char* path, int to, char* why, int whySize, void (*read)(const std::string& path, Model&));

} // namespace alpenglow::models
