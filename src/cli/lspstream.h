// Cuts the bytes that a client of the language server sends into messages: headers, an empty line, as many bytes as
// Content-Length says. Other text is reported once, and the next header is searched.
#pragma once
#include <cstddef>
#include <string>

namespace alpenglow::cli {

/// Splits a stream of bytes into messages. Feed bytes, then call next() until it returns More.
class MessageStream {
public:
    /// What next() found.
    enum class Kind {
        More,      ///< nothing whole is there yet
        Message,   ///< one message
        BadLength, ///< a Content-Length that is no number
        NoLength,  ///< headers without one
        TooLong    ///< longer than limits::kServerMessage: it is skipped
    };
    /// Appends bytes of the stream.
    void feed(const char* bytes, size_t count) { buffer_.append(bytes, count); }
    /// The next message or fault; `body` is set for a message.
    Kind next(std::string& body);
    /// Bytes that are held.
    size_t held() const { return buffer_.size() - at_; }

private:
    Kind header(std::string line);
    bool takeLine(std::string& line);

    std::string buffer_;
    size_t at_ = 0, length_ = 0;
    bool known_ = false;    ///< the length has been read
    bool body_ = false;     ///< the empty line has been read
    bool others_ = false;   ///< lines that are no length stood before it
    bool skipping_ = false; ///< after a fault, until the next length
};

} // namespace alpenglow::cli
