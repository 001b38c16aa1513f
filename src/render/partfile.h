// Part files: a complete, exact film on disk. `--samples A:B` writes one, `merge` adds several, a checkpoint is one.
//
// Layout, little-endian: "ALPGPART", version (u32), size of the header (u32), CRC-32 of the header (u32), header, packed sums
// (zlib), CRC-32 of the packed sums (u32). Header: picture size, window, seed, scene digest, channels, ranges, counters,
// metadata. Sums: for each pixel, in rows, the integers of film.h, then its AOVs (version 2; version 1 has no sums of samples
// that hit a surface and is rejected, because estimates would not match the complete render). An adaptive film is version 4: its
// header ends with the steps (u32), and each pixel has its rate (u16). A changed byte anywhere is detected.
#pragma once
#include "base/file.h"
#include "render/film.h"
#include <memory>

namespace alpenglow::render {

/// Writes the film under a temporary name and renames it when complete. Returns false with an error if it cannot be written.
bool savePart(const Film&, const std::string& path, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
/// Reads the film from a part file. Returns null with an error if the file is missing, not a part file, of another version,
/// truncated, damaged, or beyond the limits. Memory use is proportional to the size of the file.
std::unique_ptr<Film> loadPart(const std::string& path, Diagnostics&);
/// The same from bytes; `name` is for messages.
std::unique_ptr<Film> parsePart(std::span<const uint8_t> bytes, const std::string& name, Diagnostics&);

/// Removes the part file of an older picture. Does nothing if there is none, or if the file is of another kind.
void removePart(const std::string& path);

/// Loads all parts and adds them. Returns null with an error if one cannot be read or does not match the others. Any order of the
/// parts gives the same bits.
std::unique_ptr<Film> mergeParts(const std::vector<std::string>& paths, Diagnostics&);

} // namespace alpenglow::render
