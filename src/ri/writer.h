// Requests to RIB, ASCII or binary (RISpec 3.2, appendix C): what the reader reads back as the same calls.
#pragma once
#include "ri/call.h"
#include "ri/sink.h"
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace alpenglow::ri {

/// How a stream is written.
struct RibFormat {
    bool binary = false; ///< else ASCII
    bool gzip = false;   ///< compressed by gzip
    int indentation = 4; ///< ASCII: blanks for each block around a request
    int columns = 100;   ///< ASCII: longer requests go on in further lines; 0: they do not
};

class RibEncoder;

/// Writes requests one by one, in bounded memory; nothing of one is kept but, in binary, the codes of strings. Not thread safe.
/// Read again, calls are equal: their arguments to the bit, numbers of parameter lists as floats, which is all that counts of
/// them. Unless ColorSamples was written: then those, too, are kept to the bit.
class RibWriter {
public:
    /// Receives the bytes.
    RibWriter(std::unique_ptr<ByteSink>, RibFormat = {});
    /// Passes unfinished output on without reporting failures; finish() reports them.
    ~RibWriter();
    /// call: of requestTable(), its arguments as matchArguments() leaves them. The place is not written.
    void write(const Call& call);
    /// A request that is not in the table, as it was read.
    void write(const std::string& name, const std::vector<Value>& values);
    /// A comment, without the '#'; each line of it becomes one.
    void comment(std::string_view text);
    /// A structure comment, without the "##" (RISpec 3.2, appendix D).
    void structure(std::string_view text);
    /// Text that is RIB already, unchanged, in separate lines: RiArchiveRecord "verbatim".
    void verbatim(std::string_view text);
    /// Passes buffered output on. False: writing failed.
    bool flush();
    /// Ends the stream. Returns false if something could not be written, now or before; failure() has the reason.
    bool finish();
    const std::string& failure() const; ///< the reason of a failure, for messages; "" if there was none
    /// Bytes so far, before gzip.
    uint64_t bytes() const;

private:
    void value(const Value&, bool exact);
    void comments(std::string_view mark, std::string_view text);
    std::unique_ptr<RibEncoder> encoder_;
};

} // namespace alpenglow::ri
