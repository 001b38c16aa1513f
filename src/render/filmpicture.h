// From a film to its pictures, and from part files to the picture of the whole (`alpenglow merge`).
#pragma once
#include "render/outputs.h"

namespace alpenglow::render {

/// The key under which a film keeps what planToText() made.
inline constexpr const char* kPicturesKey = "alpenglow:pictures";
/// The part file that lies beside a picture.
std::string sidecarName(const std::string& picture);

/// Writes all pictures of a film. Sample count, ranges, seed and noise are added to their metadata. False when one could not be
/// written.
bool writeFilm(const Film&, const OutputPlan&, PictureFacts, const Imager&, bool allowWrite, Diagnostics&);

/// How merging ended.
enum class MergeResult { Done, NoInput, NoOutput };
/// What merging may do, and where it looks first for the imager's shaders; the parts say where their renders looked.
struct MergeSettings {
    bool allowWrite = false, allowExec = false;
    std::vector<std::string> shaderPaths;
};
/// Adds the films of part files (pictures stand for their sidecars) and writes what one render of all their samples would have
/// written: `output` (by the rules of -o), or the pictures the parts name when it is empty. The imager is that of the first part; one
/// that cannot be run (its shader is gone) is an error, and the pictures are written without it.
MergeResult mergePictures(const std::vector<std::string>& parts, const std::string& output, const MergeSettings&, Diagnostics&);

} // namespace alpenglow::render
