#include "view/httpserver.h"
#include <algorithm>
#include <array>
#include <sys/random.h>

namespace alpenglow::view {

std::string randomToken() {
    std::array<unsigned char, 16> bytes{};
    for (size_t n = 0; n < bytes.size();) {
        const ssize_t k = ::getrandom(bytes.data() + n, bytes.size() - n, 0);
        if (k > 0) n += size_t(k);
    }
    std::string text;
    for (unsigned char b : bytes) {
        text += "0123456789abcdef"[b >> 4];
        text += "0123456789abcdef"[b & 15];
    }
    return text;
}

bool sameText(const std::string& a, const std::string& b) {
    unsigned char differs = a.size() != b.size();
    for (size_t i = 0; i < a.size(); ++i) differs |= static_cast<unsigned char>(a[i] ^ b[i % std::max<size_t>(b.size(), 1)]);
    return !differs;
}

} // namespace alpenglow::view
