// Sources of the bytes of a RIB stream: memory, a file, an istream, each possibly gzip-compressed.
#pragma once
#include "base/limits.h"
#include "base/stopflag.h"
#include <cstddef>
#include <istream>
#include <memory>
#include <string>
#include <string_view>

namespace alpenglow::ri {

/// A one-way stream of bytes.
class ByteSource {
public:
    virtual ~ByteSource() = default;
    /// Up to `size` bytes into `out`, as many as are there now, at least one; 0 = end or failure.
    virtual size_t read(char* out, size_t size) = 0;
    /// Why the stream ended early (damaged gzip, read error, limit), or "". Valid once read() has returned 0.
    const std::string& failure() const { return failure_; }
    /// True when `failure` is a limit (RIE_LIMIT) rather than damage (RIE_BADFILE).
    bool limitHit() const { return limitHit_; }

protected:
    std::string failure_;
    bool limitHit_ = false;
};

/// The text must outlive the source.
std::unique_ptr<ByteSource> memorySource(std::string_view text);
/// The stream must outlive the source.
std::unique_ptr<ByteSource> streamSource(std::istream& in);
/// A file, or one in a zip archive: "a.zip!b.rib", or "a.zip" where only one is RIB (zip.h). Null when it cannot be opened or is
/// a directory; *why says which. regular: nor anything else but a regular file, at
/// once; opening a pipe waits for its writer. stop: set: the source is at its end, also where it waits for bytes; may be null.
std::unique_ptr<ByteSource> fileSource(const std::string& path, std::string* why, bool regular = false,
                                       const StopFlag* stop = nullptr);
/// What a source has, read at once, up to `most` bytes; the source itself, for what is behind them, is kept only where there is
/// more.
std::unique_ptr<ByteSource> inMemory(std::unique_ptr<ByteSource> source, size_t most);
/// Descriptor 0, unbuffered.
std::unique_ptr<ByteSource> standardInput(const StopFlag* stop);
/// Inflates when the stream starts with 1f 8b (concatenated members too), else passes it through.
/// Limits: limits::kGzipRatio, and `most` inflated bytes.
std::unique_ptr<ByteSource> inflating(std::unique_ptr<ByteSource> raw, size_t most = limits::kGzipBytes);

} // namespace alpenglow::ri
