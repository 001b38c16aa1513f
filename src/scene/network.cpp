#include "scene/network.h"

namespace alpenglow::scene {
namespace {

constexpr char kSeparator = '\x1f'; // between who keeps a pattern and its handle: in no text of a file
constexpr std::string_view kKeepers[] = {"surface", "displacement", "interior", "light"};

} // namespace

std::string keptHandle(Keeper k, std::string_view handle) {
    return std::string(kKeepers[size_t(k)]) + kSeparator + std::string(handle);
}

bool isKept(std::string_view key) { return key.find(kSeparator) != key.npos; }

std::string_view plainHandle(std::string_view key) {
    const size_t at = key.find(kSeparator);
    return at == key.npos ? key : key.substr(at + 1);
}

} // namespace alpenglow::scene
