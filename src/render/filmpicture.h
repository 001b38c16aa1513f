// Converts a film to pictures, and part files to the complete picture (`alpenglow merge`).
#pragma once
#include "render/outputs.h"

namespace alpenglow::render {

/// Metadata key of a film for the result of planToText().
inline constexpr const char* kPicturesKey = "alpenglow:pictures";
/// Metadata key of a part by --part for the samples of the complete picture, as rangeText().
inline constexpr const char* kWholeKey = "alpenglow:whole";
/// Converts to "A:B", and back; returns nothing unless A < B and B is at most limits::kSamplesPerPixel.
std::string rangeText(SampleRange);
/// The reverse.
std::optional<SampleRange> rangeFromText(const std::string&);
/// The samples of `whole` that are in none of the ranges, ascending.
std::vector<SampleRange> missingSamples(const std::vector<SampleRange>& ranges, SampleRange whole);
/// Name of the part file next to a picture.
std::string sidecarName(const std::string& picture);

/// Writes all pictures of a film and adds sample count, ranges, seed and noise to their metadata. Returns false if one could not
/// be written.
bool writeFilm(const Film&, const OutputPlan&, PictureFacts, const Imager&, bool allowWrite, Diagnostics&);

/// Result of merging.
enum class MergeResult { Done, NoInput, NoOutput };
/// Permissions for merging, and the first search path for the imager's shaders; the parts hold the search paths of their renders.
struct MergeSettings {
    bool allowWrite = false, allowExec = false; ///< as OutputPolicy::allowWrite; imagers may run programs
    std::vector<std::string> shaderPaths;       ///< before those of the parts
    std::optional<SampleRange> expect;          ///< samples that the parts must hold together, exactly
};
/// Adds the films of part files (a picture stands for its sidecar) and writes what a single render of all their samples would
/// have written: `output` with its sidecars, or the pictures named in the parts if it is empty. Uses the imager of the first
/// part; if it cannot run (its shader is missing), that is an error, and the pictures are written without it. Missing samples are
/// a warning, or an error if they were expected; pictures and a part file are written in both cases, so that the rest can be
/// added.
MergeResult mergePictures(const std::vector<std::string>& parts, const std::string& output, const MergeSettings&, Diagnostics&);

} // namespace alpenglow::render
