#include "mutate.h"
#include <algorithm>
#include <bit>
#include <cctype>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <zlib.h>

namespace alpenglow::fuzz {
namespace {

constexpr size_t kLongest = 64 << 10; ///< bytes of an input: beyond, time goes into size

const char* const kExtremes[] = {"0",
                                 "-0",
                                 "1",
                                 "-1",
                                 "1e38",
                                 "-1e38",
                                 "1e-38",
                                 "3.4e39",
                                 "1e999",
                                 "-1e999",
                                 "1e-999",
                                 "2147483647",
                                 "-2147483648",
                                 "4294967296",
                                 "1073741824",
                                 "65536",
                                 "0.5",
                                 "-0.5",
                                 "255",
                                 "256",
                                 "16777217",
                                 "1e9",
                                 "-1e9",
                                 "1e5",
                                 "3",
                                 "1e308",
                                 "nan",
                                 "inf",
                                 "1e-20",
                                 "7",
                                 "999999999999999999999999",
                                 ".",
                                 "1e",
                                 "-"};

const uint32_t kBig[] = {0,      1,      2,       3,          0x7f,       0x80,       0xff,       0x100,      0x7fff,
                         0x8000, 0xffff, 0x10000, 0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000, 0x7fc00000, 0x40000000};

void putNumber(Bytes& b, size_t at, uint32_t v, size_t n, bool big) {
    for (size_t i = 0; i < n && at + i < b.size(); ++i) b[at + i] = char(v >> 8 * (big ? n - 1 - i : i));
}

uint32_t crcOf(const Bytes& b, size_t at, size_t n) {
    return uint32_t(crc32(0, reinterpret_cast<const Bytef*>(b.data() + at), uInt(n)));
}

uint32_t numberAt(const Bytes& b, size_t at, bool big) {
    uint32_t v = 0;
    for (size_t i = 0; i < 4 && at + i < b.size(); ++i) v |= uint32_t(uint8_t(b[at + i])) << 8 * (big ? 3 - i : i);
    return v;
}

bool isNumber(const std::string& w) {
    const unsigned char c = static_cast<unsigned char>(w[0]);
    return std::isdigit(c) ||
           ((w[0] == '-' || w[0] == '.') && w.size() > 1 && (std::isdigit(static_cast<unsigned char>(w[1])) || w[1] == '.'));
}

} // namespace

Bytes mutateBytes(Random& r, Bytes b, const Seeds& seeds) {
    for (size_t turn = 0, n = 1 + r.below(r.once(4) ? 12 : 3); turn < n; ++turn) {
        if (b.empty()) return r.of(seeds);
        // Headers more often than bodies.
        const size_t at = r.once(3) ? r.below(b.size()) : r.below(std::min<size_t>(b.size(), 256));
        const size_t some = std::min(b.size() - at, 1 + r.below(r.once(5) ? 256 : 8));
        switch (r.below(10)) {
        case 0:
            b[at] = char(b[at] ^ (1 << r.below(8)));
            break;
        case 1:
            b[at] = char(r.next());
            break;
        case 2:
            b[at] = char(kBig[r.below(7)]);
            break;
        case 3:
            putNumber(b, at, r.of(kBig), 4, r.once(2));
            break;
        case 4:
            putNumber(b, at, r.of(kBig), 2, r.once(2));
            break;
        case 5:
            b.erase(at, some);
            break;
        case 6:
            b.insert(at, b.substr(at, some));
            break;
        case 7:
            if (r.once(3)) b.resize(at);
            else b.insert(at, some, char(r.once(2) ? 0 : r.next()));
            break;
        case 8: {
            const Bytes& other = r.of(seeds);
            const size_t from = r.below(other.size());
            b.replace(at, some, other.substr(from, 1 + r.below(256)));
            break;
        }
        default:
            putNumber(b, at, numberAt(b, at, false) + uint32_t(r.below(9)) - 4, 4, false);
            break;
        }
    }
    if (b.size() > kLongest) b.resize(kLongest);
    return b;
}

std::vector<std::string> wordsOf(const Bytes& text) {
    std::vector<std::string> out;
    for (size_t i = 0; i < text.size();) {
        size_t end = i + 1;
        const auto is = [&](size_t k, auto test) { return test(static_cast<unsigned char>(text[k])); };
        const auto name = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; };
        const auto blank = [](unsigned char c) { return std::isspace(c) != 0; };
        if (is(i, name) || (text[i] == '-' && end < text.size() && is(end, name)))
            while (end < text.size() && is(end, name)) ++end;
        else if (is(i, blank))
            while (end < text.size() && is(end, blank)) ++end;
        else if (text[i] == '"') {
            while (end < text.size() && text[end] != '"' && text[end] != '\n') ++end;
            end = std::min(end + 1, text.size());
        }
        out.push_back(text.substr(i, end - i));
        i = end;
    }
    return out;
}

Bytes mutateText(Random& r, const Bytes& seed, const Seeds& seeds, const std::vector<std::string>& dictionary) {
    std::vector<std::string> w = wordsOf(seed);
    for (size_t turn = 0, n = 1 + r.below(r.once(4) ? 16 : 4); turn < n && !w.empty(); ++turn) {
        const size_t at = r.below(w.size()), some = std::min(w.size() - at, 1 + r.below(r.once(4) ? 40 : 4));
        const auto here = w.begin() + std::ptrdiff_t(at), end = here + std::ptrdiff_t(some);
        switch (r.below(10)) {
        case 0:
            w.erase(here, end);
            break;
        case 1: {
            const std::vector<std::string> run(here, end);
            for (size_t k = 0, times = r.once(8) ? 40 : 1; k < times; ++k)
                w.insert(w.begin() + std::ptrdiff_t(at), run.begin(), run.end());
            break;
        }
        case 2:
            std::swap(w[at], w[r.below(w.size())]);
            break;
        case 3:
        case 4:
            w[at] = r.of(dictionary);
            break;
        case 5:
            w.insert(here, {r.of(dictionary), " "});
            break;
        case 6:
        case 7: { // the next number
            size_t k = at;
            while (k < w.size() && !isNumber(w[k])) ++k;
            if (k < w.size()) w[k] = r.once(3) ? std::to_string(int64_t(r.below(2000)) - 1000) : r.of(kExtremes);
            break;
        }
        case 8: {
            const std::vector<std::string> other = wordsOf(r.of(seeds));
            const size_t from = r.below(other.size()), count = std::min(other.size() - from, 1 + r.below(60));
            w.insert(here, other.begin() + std::ptrdiff_t(from), other.begin() + std::ptrdiff_t(from + count));
            break;
        }
        default:
            if (!w[at].empty()) w[at][r.below(w[at].size())] = char(r.next());
            break;
        }
    }
    Bytes out;
    for (const std::string& s : w) out += s;
    if (out.size() > kLongest) out.resize(kLongest);
    if (r.once(24)) out.resize(r.below(out.size() + 1));
    return out;
}

namespace {

/// RISpec 3.2, appendix C.2: codes below 0200 are ASCII.
void binaryNumber(Random& r, Bytes& out, const std::string& text) {
    const double v = std::atof(text.c_str());
    const auto put = [&](uint64_t bits, int n) {
        for (int i = n - 1; i >= 0; --i) out += char(bits >> 8 * i);
    };
    const bool whole = std::fabs(v) <= INT32_MAX && v == std::trunc(v);
    if (whole && r.once(2)) {
        out += char(0203);
        put(uint64_t(int64_t(v)), 4);
    } else if (r.once(4) && v > -100 && v < 100) { // two bytes, one of them a fraction
        out += char(0205);
        put(uint64_t(int64_t(v * 256)), 2);
    } else if (r.once(3)) {
        out += char(0245);
        put(std::bit_cast<uint64_t>(v), 8);
    } else {
        out += char(0244);
        put(std::bit_cast<uint32_t>(std::fabs(v) > double(FLT_MAX) ? (v > 0 ? HUGE_VALF : -HUGE_VALF) : float(v)), 4);
    }
}

} // namespace

Bytes binaryRib(Random& r, const Bytes& text) {
    Bytes out;
    std::vector<std::string> requests, strings;
    for (const std::string& w : wordsOf(text)) {
        if (isNumber(w) && !r.once(6)) binaryNumber(r, out, w);
        else if (w.size() >= 2 && w[0] == '"' && w.size() < 200 && !r.once(6)) {
            const std::string s = w.substr(1, w.size() - 2);
            const auto known = std::find(strings.begin(), strings.end(), s);
            if (known != strings.end()) out += {char(0317), char(known - strings.begin())};
            else if (r.once(3) && strings.size() < 200) {
                out += {char(0315), char(strings.size()), char(0240), char(s.size())};
                out += s;
                out += {char(0317), char(strings.size())};
                strings.push_back(s);
            } else if (s.size() < 16) out += char(0220 + s.size()), out += s;
            else out += {char(0240), char(s.size())}, out += s;
        } else if (std::isupper(static_cast<unsigned char>(w[0])) && w.size() > 3 && !r.once(4)) {
            auto known = std::find(requests.begin(), requests.end(), w);
            const char code = char(known - requests.begin());
            if (known == requests.end()) {
                out += {char(0314), code, char(0220 + std::min<size_t>(w.size(), 15))};
                out += w.substr(0, 15);
                requests.push_back(w);
            }
            out += {char(0246), code};
        } else out += w;
    }
    return out;
}

Bytes gzipped(const Bytes& text) {
    z_stream z{};
    if (deflateInit2(&z, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) return text;
    Bytes out(deflateBound(&z, uLong(text.size())) + 64, '\0');
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    z.avail_in = uInt(text.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = uInt(out.size());
    deflate(&z, Z_FINISH);
    out.resize(z.total_out);
    deflateEnd(&z);
    return out;
}

Bytes repaired(Bytes b) {
    if (b.compare(0, 4, "\x89PNG") == 0) {
        for (size_t at = 8; at + 12 <= b.size();) {
            const size_t n = numberAt(b, at, true);
            if (n > b.size() - at - 12) break;
            putNumber(b, at + 8 + n, crcOf(b, at + 4, n + 4), 4, true);
            at += n + 12;
        }
    } else if (b.compare(0, 8, "ALPGPART") == 0 &&
               b.size() > 24) { // version, size of the header, its sum, header, sums, their sum
        const size_t n = numberAt(b, 12, false);
        if (n > b.size() - 24) return b;
        putNumber(b, 16, crcOf(b, 20, n), 4, false);
        putNumber(b, b.size() - 4, crcOf(b, 20 + n, b.size() - 24 - n), 4, false);
    }
    return b;
}

Bytes framed(const std::vector<std::string>& messages) {
    Bytes out;
    for (const std::string& m : messages) out += "Content-Length: " + std::to_string(m.size()) + "\r\n\r\n" + m;
    return out;
}

std::vector<std::string> messagesOf(const Bytes& b) {
    std::vector<std::string> out;
    static const std::string head = "Content-Length: ";
    for (size_t at = 0; (at = b.find(head, at)) != Bytes::npos;) {
        const size_t n = size_t(std::max(0, std::atoi(b.c_str() + at + head.size()))), body = b.find("\r\n\r\n", at);
        if (body == Bytes::npos) break;
        out.push_back(b.substr(body + 4, n));
        at = body + 4;
    }
    return out;
}

} // namespace alpenglow::fuzz
