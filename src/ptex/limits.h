// Limits of Ptex files, in addition to base/limits.h.
#pragma once
#include <cstddef>
#include <cstdint>

namespace alpenglow::limits {

inline constexpr uint32_t kPtexFaces = 50'000'000;           ///< of a file
inline constexpr int kPtexChannels = 64;                     ///< of a file
inline constexpr int kPtexSide = 15;                         ///< logarithm of the pixels along a side of a face
inline constexpr size_t kPtexFaceNumbers = size_t(1) << 27;  ///< of all channels of one face
inline constexpr size_t kPtexWholeNumbers = size_t(1) << 20; ///< of a level of a face; larger ones are read by their tiles
inline constexpr size_t kPtexTiles = size_t(1) << 20;        ///< of a level of a face
inline constexpr size_t kPtexHeadBytes = size_t(1) << 30;    ///< data of all faces: sizes, neighbours, means, file positions
inline constexpr size_t kPtexMetas = 1'000'000;              ///< entries of the metadata of a file
inline constexpr size_t kPtexMetaBytes = size_t(256) << 20;  ///< metadata of a file
inline constexpr size_t kPtexCacheBytes = size_t(256) << 20; ///< faces in the cache of a frame

} // namespace alpenglow::limits
