// Cryptomatte (Friedman and Jones, Cryptomatte specification 1.2, Psyop): which objects cover each pixel, and by how much.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::display {

/// The id of a name: MurmurHash3_x86_32 of its bytes, with bit 23 flipped where the float of the same bits would be zero,
/// denormal, infinite or no number (specification, "ID generation").
uint32_t matteId(std::string_view name);

/// One set of names, such as those of objects or of materials.
struct Matte {
    std::string layer;                     ///< "CryptoObject"
    int ranks = 6;                         ///< pairs of a pixel, even
    std::map<std::string, uint32_t> names; ///< those that cover something, with their ids
    /// By pixel, in rows from the top, `ranks` times: the bits of an id as a float, and its coverage, 0 to 1. The largest
    /// coverage first; 0 and 0 behind the last.
    std::vector<float> pairs;
};
using MattesRef = std::shared_ptr<const std::vector<Matte>>;

/// The channels of a matte: "CryptoObject00.R" to ".A" hold ranks 0 and 1, "CryptoObject01.R" ...
std::vector<std::string> matteChannels(const Matte&);
/// The entries of a picture's header: cryptomatte/<first seven digits of the layer's hash>/name, hash, conversion, manifest.
void addMatteMetadata(const Matte&, std::map<std::string, std::string>&);

} // namespace alpenglow::display
