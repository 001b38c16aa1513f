// Streams of requests: what reads, filters, counts and writes them one by one.
#pragma once
#include "ri/call.h"
#include "ri/reader.h"
#include <string>
#include <vector>

namespace alpenglow::ri {

/// Takes the requests of a stream in their order.
class RequestReceiver {
public:
    virtual ~RequestReceiver() = default;
    /// The next request; the call may change afterwards.
    virtual void request(const Call&) = 0;
    /// One that is not in the table, with all values up to the next name.
    virtual void unknown(const std::string& name, const std::vector<Value>& values) = 0;
    /// kind: "comment" or "structure"; the text behind # or ##.
    virtual void comment(const std::string& kind, const std::string& text) = 0;
    /// Whether the rest of the stream is of no use: it need not be read.
    virtual bool over() const { return false; }
};

/// The requests of a file as they stand: no archive is read, no condition decided, nothing executed, so that streams of any
/// length pass in bounded memory. "-": standard input. Bad requests are reported and left out. False: the file cannot be read,
/// which was reported.
bool passOn(const std::string& path, RequestReceiver& to, Diagnostics& reported, const StopFlag* stop = nullptr);
/// The same for text in memory.
void passOnText(const std::string& text, const std::string& name, RequestReceiver& to, Diagnostics& reported);
/// The requests of a file as a reader of these options executes them: in place of archives, and of procedurals that may be made,
/// what is in them; conditions are decided. All that the reader checks is checked.
bool passOnExpanded(const std::string& path, ReaderOptions options, RequestReceiver& to, Diagnostics& reported);

} // namespace alpenglow::ri
