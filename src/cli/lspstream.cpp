#include "cli/lspstream.h"
#include "base/limits.h"
#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

namespace alpenglow::cli {

namespace {
constexpr std::string_view kName = "content-length:";
constexpr size_t kLongestLength = 48; ///< bytes of a header "Content-Length: ..." that are kept of an endless line
} // namespace

/// The next line without its end; false when it has none yet.
bool MessageStream::takeLine(std::string& line) {
    const size_t end = buffer_.find('\n', at_);
    if (end == std::string::npos) {
        if (held() > limits::kTokenBytes) {
            buffer_.erase(0, buffer_.size() - kLongestLength); // a header may begin behind what is no header
            at_ = 0;
            others_ = true;
        }
        return false;
    }
    line.assign(buffer_, at_, end - at_);
    at_ = end + 1;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
}

MessageStream::Kind MessageStream::header(std::string line) {
    if (line.empty()) {
        if (known_) {
            known_ = others_ = skipping_ = false;
            body_ = true;
        } else if (others_ && !skipping_) { // empty lines between messages do no harm
            others_ = false;
            skipping_ = true;
            return Kind::NoLength;
        }
        return Kind::More;
    }
    // If a body was longer than its Content-Length, the next header follows its rest.
    std::string small = line;
    std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    const size_t name = small.rfind(kName);
    if (name == std::string::npos) {
        others_ = true;
        return Kind::More;
    }
    const size_t a = std::min(line.find_first_not_of(" \t", name + kName.size()), line.size());
    const size_t b = line.find_last_not_of(" \t") + 1;
    size_t length = 0;
    const auto [end, code] = std::from_chars(line.data() + a, line.data() + std::max(a, b), length);
    const bool huge = code == std::errc::result_out_of_range && end == line.data() + b;
    if (!huge && (code != std::errc() || end != line.data() + b || a >= b)) {
        known_ = others_ = false;
        if (skipping_) return Kind::More; // text that only looks like it
        skipping_ = true;
        return Kind::BadLength;
    }
    known_ = true;
    length_ = huge ? SIZE_MAX : length;
    return Kind::More;
}

MessageStream::Kind MessageStream::next(std::string& body) {
    std::string line;
    while (!body_) {
        if (!takeLine(line)) {
            if (at_ > 0) buffer_.erase(0, at_), at_ = 0;
            return Kind::More;
        }
        if (const Kind k = header(std::move(line)); k != Kind::More) return k;
    }
    if (length_ > limits::kServerMessage) {
        body_ = false;
        skipping_ = true; // so much may never come: the next header ends it
        return Kind::TooLong;
    }
    if (held() < length_) return Kind::More;
    body.assign(buffer_, at_, length_);
    buffer_.erase(0, at_ + length_);
    at_ = 0;
    body_ = false;
    return Kind::Message;
}

} // namespace alpenglow::cli
