// RIB as text: a request a line, blocks indented.
#include "ri/decimal.h"
#include "ri/encoder.h"
#include <algorithm>

namespace alpenglow::ri {
namespace {

constexpr int kDeepest = 20; // blocks that still indent

/// Whether a request opens a block, or closes one. Else and ElseIf do both.
bool opens(std::string_view r) { return r.ends_with("Begin") || r == "Else" || r == "ElseIf"; }
bool closes(std::string_view r) { return r.ends_with("End") || r == "Else" || r == "ElseIf"; }

class Ascii : public RibEncoder {
public:
    Ascii(std::unique_ptr<ByteSink> to, const RibFormat& f)
        : RibEncoder(std::move(to)), indentation_(size_t(std::clamp(f.indentation, 0, 16))), columns_(f.columns) {}

    void begin(std::string_view request) override {
        if (closes(request)) depth_ = std::max(0, depth_ - 1);
        startLine(0);
        buffer_ += request;
        if (opens(request)) ++depth_;
        more_ = opens(request) ? 0 : 1;
    }
    void end() override {
        buffer_ += '\n';
        spill();
    }
    void line(std::string_view s) override {
        startLine(0);
        buffer_ += s;
        end();
    }
    void bare(std::span<const double> v, Precision p) override {
        for (const double d : v) {
            number(d, p);
            put("", "");
        }
    }
    void array(std::span<const double> v, Precision p) override {
        for (size_t i = 0; i < v.size(); ++i) {
            number(v[i], p);
            put(i == 0 ? "[" : "", i + 1 == v.size() ? "]" : "");
        }
        if (v.empty()) empty();
    }
    void text(const std::string& s) override {
        quote(s);
        put("", "");
    }
    void texts(std::span<const std::string> v) override {
        for (size_t i = 0; i < v.size(); ++i) {
            quote(v[i]);
            put(i == 0 ? "[" : "", i + 1 == v.size() ? "]" : "");
        }
        if (v.empty()) empty();
    }

private:
    void startLine(int more) {
        lineStart_ = bytes();
        buffer_.append(indentation_ * size_t(std::min(kDeepest, depth_) + more), ' ');
    }
    void number(double d, Precision p) {
        item_.clear();
        p == Precision::Float ? appendAsFloat(item_, d) : appendNumber(item_, d);
    }
    void quote(const std::string& s) {
        item_ = '"';
        for (const char c : s) {
            const char* const from = "\n\r\t\b\f\"\\";
            const char* const to = "nrtbf\"\\";
            const auto u = static_cast<unsigned char>(c);
            if (const char* at = c ? std::char_traits<char>::find(from, 7, c) : nullptr) {
                item_ += '\\';
                item_ += to[at - from];
            } else if (u < 32 || u == 127) {
                item_ += '\\';
                for (int shift = 6; shift >= 0; shift -= 3) item_ += char('0' + ((u >> shift) & 7));
            } else item_ += c;
        }
        item_ += '"';
    }
    void empty() {
        item_.clear();
        put("[", "]");
    }
    /// item_, in the next line where this one is full.
    void put(std::string_view before, std::string_view after) {
        const size_t n = before.size() + item_.size() + after.size();
        if (columns_ > 0 && bytes() - lineStart_ + 1 + n > size_t(columns_)) {
            buffer_ += '\n';
            startLine(more_);
        } else buffer_ += ' ';
        buffer_ += before;
        buffer_ += item_;
        buffer_ += after;
        spill();
    }

    size_t indentation_;
    int columns_;
    int depth_ = 0; ///< blocks around the next request
    int more_ = 1;  ///< additional indentation of continuation lines, in steps
    uint64_t lineStart_ = 0;
    std::string item_;
};

} // namespace

std::unique_ptr<RibEncoder> asciiEncoder(std::unique_ptr<ByteSink> to, const RibFormat& f) {
    return std::make_unique<Ascii>(std::move(to), f);
}

} // namespace alpenglow::ri
