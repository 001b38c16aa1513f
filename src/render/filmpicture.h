// From a film to its pictures, and from part files to the picture of the whole (`alpenglow merge`).
#pragma once
#include "render/outputs.h"

namespace alpenglow::render {

/// The key under which a film keeps what planToText() made.
inline constexpr const char* kPicturesKey = "alpenglow:pictures";
/// The key under which a part of --part keeps which samples the whole has, as rangeText().
inline constexpr const char* kWholeKey = "alpenglow:whole";
/// "A:B", and back; nothing unless A < B and B is at most limits::kSamplesPerPixel.
std::string rangeText(SampleRange);
std::optional<SampleRange> rangeFromText(const std::string&);
/// What of the whole is in none of the ranges, ascending.
std::vector<SampleRange> missingSamples(const std::vector<SampleRange>& ranges, SampleRange whole);
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
    std::optional<SampleRange> expect; ///< the samples that the parts must hold together, no fewer and no more
};
/// Adds the films of part files (pictures stand for their sidecars) and writes what one render of all their samples would have
/// written: `output` and what -o leaves beside it, or the pictures the parts name when it is empty. The imager is that of the
/// first part; one that cannot be run (its shader is gone) is an error, and the pictures are written without it. Samples that are
/// missing are a warning, and an error when they were expected; the pictures are written with a part file beside them, so that
/// the rest can be added.
MergeResult mergePictures(const std::vector<std::string>& parts, const std::string& output, const MergeSettings&, Diagnostics&);

} // namespace alpenglow::render
