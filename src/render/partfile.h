// Part files: a film on disk, whole and exact. `--samples A:B` writes one, `merge` adds several, a checkpoint is one.
//
// Layout, little-endian: "ALPGPART", version (u32), size of the header (u32), CRC-32 of the header (u32), header, packed sums
// (zlib), CRC-32 of the packed sums (u32). Header: picture size, window, seed, scene digest, channels, ranges, counters,
// metadata. Sums: per pixel, in rows, the integers of film.h, then its AOVs (version 2; version 1 had no
// sums of the samples that met a surface and is refused, as a guess would not be the figure of the whole). A film whose pixels
// have different numbers of samples is version 4: its header ends with the steps (u32), each pixel with its rate (u16). A changed
// byte anywhere is noticed.
#pragma once
#include "base/file.h"
#include "render/film.h"
#include <memory>

namespace alpenglow::render {

/// Writes the film under a temporary name and renames it when whole. False with an error when it could not be written.
bool savePart(const Film&, const std::string& path, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
/// The film in a part file; null with an error reported when the file is missing, not a part file, of another version,
/// truncated, damaged, or beyond the limits. Memory in use stays in proportion to the size of the file.
std::unique_ptr<Film> loadPart(const std::string& path, Diagnostics&);
/// The same from bytes; `name` is for messages.
std::unique_ptr<Film> parsePart(std::span<const uint8_t> bytes, const std::string& name, Diagnostics&);

/// Removes a part file that belonged to an older picture. Nothing happens where there is none, or another kind of file.
void removePart(const std::string& path);

/// Loads all parts and adds them. Null with an error when one cannot be read or does not fit the others. Any order of the
/// parts gives the same bits.
std::unique_ptr<Film> mergeParts(const std::vector<std::string>& paths, Diagnostics&);

} // namespace alpenglow::render
