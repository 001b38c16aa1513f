// RIB in bytes (RISpec 3.2, appendix C.2; docs/design/ri.md, "Binary form").
#include "base/limits.h"
#include "ri/encoder.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <unordered_map>

namespace alpenglow::ri {
namespace {

constexpr size_t kCodes = 65536;    // of strings
constexpr size_t kShortCodes = 256; // of one byte
constexpr size_t kNamed = 64;       // bytes of the longest string that gets a code

bool isFloat(double d) { return double(float(d)) == d || std::isnan(d); }
/// Not -0, whose sign an integer would lose.
bool isInt(double d) { return d >= -2147483648.0 && d <= 2147483647.0 && d == std::floor(d) && (d != 0 || !std::signbit(d)); }

class Binary : public RibEncoder {
public:
    explicit Binary(std::unique_ptr<ByteSink> to) : RibEncoder(std::move(to)) {}

    void begin(std::string_view request) override {
        auto slot = requests_.find(request);
        const bool fresh = slot == requests_.end() && requests_.size() < 256;
        if (fresh) slot = requests_.emplace(request, requests_.size()).first;
        if (slot == requests_.end()) { // there are no more codes
            buffer_ += request;
            buffer_ += ' ';
            return;
        }
        if (fresh) {
            put(0314);
            put(unsigned(slot->second));
            literal(request);
        }
        put(0246);
        put(unsigned(slot->second));
    }
    /// Costs one byte a request, so that messages have line numbers.
    void end() override {
        buffer_ += '\n';
        spill();
    }
    void line(std::string_view s) override {
        buffer_ += s;
        end();
    }
    void bare(std::span<const double> v, Precision p) override {
        for (const double d : v) number(d, p);
    }
    void array(std::span<const double> v, Precision p) override {
        // Whole numbers that no float holds stay what they are.
        const bool floats = v.size() <= 0xffffffffu && std::all_of(v.begin(), v.end(), [p](double d) {
                                return isFloat(d) || (p == Precision::Float && !isInt(d));
                            });
        if (floats) {
            counted(0310, v.size());
            for (const double d : v) {
                big(std::bit_cast<uint32_t>(toFloat(d)), 4);
                spill();
            }
            return;
        }
        put('[');
        for (const double d : v) {
            number(d, p);
            spill();
        }
        put(']');
    }
    /// A short string gets a code at its second occurrence.
    void text(const std::string& s) override {
        if (s.size() < 2 || s.size() > kNamed) return literal(s);
        const auto known = strings_.find(s);
        if (known == strings_.end()) {
            if (strings_.size() < kCodes) strings_.emplace(s, kNone);
            return literal(s);
        }
        size_t& code = known->second;
        if (code == kNone) {
            code = codes_++;
            put(code < kShortCodes ? 0315 : 0316);
            big(code, code < kShortCodes ? 1 : 2);
            literal(s);
        }
        put(code < kShortCodes ? 0317 : 0320);
        big(code, code < kShortCodes ? 1 : 2);
    }
    void texts(std::span<const std::string> v) override {
        put('[');
        for (const std::string& s : v) {
            text(s);
            spill();
        }
        put(']');
    }

private:
    static constexpr size_t kNone = size_t(-1);

    void put(unsigned byte) { buffer_ += char(byte); }
    void big(uint64_t v, int bytes) {
        for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) put(unsigned(v >> shift) & 0xff);
    }
    /// A code whose last two bits are the bytes of a length, less one, and the length.
    void counted(unsigned code, uint64_t n) {
        int bytes = 1;
        while (bytes < 4 && n >> (8 * bytes)) ++bytes;
        put(code + unsigned(bytes - 1));
        big(n, bytes);
    }
    void literal(std::string_view s) {
        if (s.size() < 16) put(0220 + unsigned(s.size()));
        else counted(0240, s.size());
        buffer_ += s;
    }
    void number(double d, Precision p) {
        if (isInt(d)) {
            // Others take shorter forms than four bytes as unsigned: those are for numbers that are the same either way.
            int bytes = 1;
            while (bytes < 4 && (d < 0 || d >= double(int64_t(1) << (8 * bytes - 1)))) ++bytes;
            put(0200 + unsigned(bytes - 1));
            big(uint32_t(int32_t(d)), bytes);
        } else if (p == Precision::Float || isFloat(d)) {
            put(0244);
            big(std::bit_cast<uint32_t>(toFloat(d)), 4);
        } else {
            put(0245);
            big(std::bit_cast<uint64_t>(d), 8);
        }
    }

    std::map<std::string, size_t, std::less<>> requests_;
    std::unordered_map<std::string, size_t> strings_; ///< kNone: seen once
    size_t codes_ = 0;
};

} // namespace

std::unique_ptr<RibEncoder> binaryEncoder(std::unique_ptr<ByteSink> to) { return std::make_unique<Binary>(std::move(to)); }

} // namespace alpenglow::ri
