// The two encodings of RIB that RibWriter uses.
#pragma once
#include "ri/writer.h"

namespace alpenglow::ri {

/// Tokens of a stream, request by request.
class RibEncoder {
public:
    /// to: receives the bytes.
    RibEncoder(std::unique_ptr<ByteSink> to) : to_(std::move(to)) {}
    virtual ~RibEncoder() = default;
    /// Whether only the nearest float of a number counts.
    enum class Precision { Exact, Float };

    /// The name; its arguments follow, then end().
    virtual void begin(std::string_view request) = 0;
    /// Numbers without brackets.
    virtual void bare(std::span<const double>, Precision) = 0;
    /// Numbers in brackets; one text; texts in brackets; the end of the request.
    virtual void array(std::span<const double>, Precision) = 0;
    virtual void text(const std::string&) = 0;
    virtual void texts(std::span<const std::string>) = 0;
    virtual void end() = 0;
    /// Whole lines between requests, without the newline at the end.
    virtual void line(std::string_view) = 0;

    /// last: the stream ends, and the sink is not touched again. False: failed, now or before.
    bool handOn(bool last);
    /// Why it failed, or ""; bytes of the stream so far.
    const std::string& failure() const { return to_->failure(); }
    uint64_t bytes() const { return sent_ + buffer_.size(); }
    Precision parameters = Precision::Float; ///< of parameter lists

protected:
    /// Passes output on if there is enough; call after each token.
    void spill() {
        constexpr size_t kBuffer = 64u << 10;
        if (buffer_.size() >= kBuffer) send();
    }
    std::string buffer_;

private:
    void send();
    std::unique_ptr<ByteSink> to_;
    uint64_t sent_ = 0;
    bool failed_ = false, finished_ = false;
};

/// Encoders that write to the sink.
std::unique_ptr<RibEncoder> asciiEncoder(std::unique_ptr<ByteSink>, const RibFormat&);
std::unique_ptr<RibEncoder> binaryEncoder(std::unique_ptr<ByteSink>);

} // namespace alpenglow::ri
