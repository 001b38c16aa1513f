// Where the bytes of a written stream go: the other side of source.h.
#pragma once
#include "base/file.h"
#include <memory>
#include <ostream>
#include <string>
#include <string_view>

namespace alpenglow::ri {

/// A one-way stream of bytes. After the first failure nothing more is written.
class ByteSink {
public:
    virtual ~ByteSink() = default;
    /// Writes all of these bytes. Returns false after an error; failure() has the reason.
    virtual bool write(std::string_view bytes) = 0;
    /// Hands on what is held back, so that a reader at the other end of a pipe has all that was written.
    virtual bool flush() = 0;
    /// Passes everything on and ends the stream; no write() may follow. Returns false after an error; failure() has the reason.
    virtual bool finish() { return flush(); }
    /// Why a write failed, or "".
    const std::string& failure() const { return failure_; }

protected:
    std::string failure_;
};

/// Appends to a text, which must outlive the sink.
std::unique_ptr<ByteSink> stringSink(std::string& to);
/// The stream must outlive the sink.
std::unique_ptr<ByteSink> streamSink(std::ostream&);
/// An open descriptor, which stays open; a pipe's reader sees what was flushed.
std::unique_ptr<ByteSink> descriptorSink(int descriptor);
/// Creates or empties a file; a pipe of that name is written to. Null if it cannot be opened, with the reason in *why.
std::unique_ptr<ByteSink> fileSink(const std::string& path, std::string* why);
/// A file that appears when it is whole. finish() does not commit it: that is the caller's. It must outlive the sink.
std::unique_ptr<ByteSink> outputSink(OutputFile&);
/// Gzip, in front of another sink.
std::unique_ptr<ByteSink> deflating(std::unique_ptr<ByteSink> to);

} // namespace alpenglow::ri
