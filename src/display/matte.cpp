#include "display/matte.h"
#include "base/murmur.h"
#include <cstdio>

namespace alpenglow::display {
namespace {

std::string hex(uint32_t id) {
    char digits[9];
    std::snprintf(digits, sizeof digits, "%08x", id);
    return digits;
}

/// A string of JSON (RFC 8259). Other bytes than ASCII pass as they are: names are UTF-8.
std::string quoted(const std::string& name) {
    std::string out = "\"";
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') out += '\\';
        if (byte >= 32) {
            out += c;
            continue;
        }
        char code[8];
        std::snprintf(code, sizeof code, "\\u%04x", unsigned(byte));
        out += code;
    }
    return out + '"';
}

} // namespace

uint32_t matteId(std::string_view name) {
    const uint32_t id = murmur3(name), exponent = id >> 23 & 255;
    return exponent == 0 || exponent == 255 ? id ^ 1u << 23 : id;
}

std::vector<std::string> matteChannels(const Matte& m) {
    std::vector<std::string> all;
    for (int pair = 0; pair < m.ranks / 2; ++pair)
        for (const char* leaf : {".R", ".G", ".B", ".A"}) {
            char number[16];
            std::snprintf(number, sizeof number, "%02d", pair);
            all.push_back(m.layer + number + leaf);
        }
    return all;
}

void addMatteMetadata(const Matte& m, std::map<std::string, std::string>& to) {
    const std::string key = "cryptomatte/" + hex(murmur3(m.layer)).substr(0, 7) + "/";
    to[key + "name"] = m.layer;
    to[key + "hash"] = "MurmurHash3_32";
    to[key + "conversion"] = "uint32_to_float32";
    std::string manifest = "{";
    for (const auto& [name, id] : m.names) manifest += (manifest.size() > 1 ? "," : "") + quoted(name) + ":\"" + hex(id) + "\"";
    to[key + "manifest"] = manifest + "}";
}

} // namespace alpenglow::display
