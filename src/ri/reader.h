// Public interface of this folder: reads RIB streams, produces frames.
#pragma once
#include "base/limits.h"
#include "base/readlog.h"
#include "base/stopflag.h"
#include "scene/deferred.h"
#include "scene/frameconsumer.h"
#include <functional>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::ri {

struct Call;
struct Value;

/// Settings of a reader; fixed after construction.
struct ReaderOptions {
    std::vector<std::string> searchPaths; ///< folders for archives, after those of Option "searchpath" "archive"
    /// Folders for archives, and for programs and libraries of procedurals, behind all others: those that the environment names.
    std::vector<std::string> lastArchivePaths, lastProceduralPaths;
    bool allowExec = false;                          ///< RunProgram, DynamicLoad, System were asked for by the user
    double programSeconds = limits::kProgramSeconds; ///< that a program may take for one answer
    const StopFlag* stop = nullptr;                  ///< set: the rest is not read; may be null
    bool allowRead = true;               ///< archives may lie anywhere; false: below the folders that archive.cpp names
    bool regularFiles = false;           ///< readFile() refuses pipes and devices: the scene is read more than once
    size_t mostLights = limits::kLights; ///< of one frame; further ones are reported
    /// Whether procedurals that rays may not reach (deferred.cpp has the conditions) are primitives of the kind scene::kDeferred
    /// until RibReader::make() expands them. False: all are expanded at once.
    bool defers = false;
    bool threads = true;            ///< archives may be parsed by several threads; false: none is started
    std::vector<int> frames;        ///< only these FrameBegin numbers are rendered; empty = all. Worlds outside frames always are
    std::shared_ptr<ReadLog> reads; ///< gets every scene and archive that is read or missed; may be null
    /// Called with the number of each FrameBegin, rendered or not.
    std::function<void(int)> frameSeen;
    /// Called for each frame on its own copy of the options, just before it is handed over: the command line takes precedence.
    std::function<void(scene::Options&)> overrides;
    /// Comments of the stream, as ReadArchive's callback gets them: kind "comment" or "structure", text after # or ##. Those
    /// inside a request and behind it come once it is executed.
    std::function<void(const std::string& kind, const std::string& text)> comments;
    /// Set: called with each request of streams and archives that are read; what it adds to `by` is executed in its place. Not
    /// with what inline archives repeat, which has passed it when it was stored.
    std::function<void(const Call&, std::vector<Call>& by)> filter;
    /// Set: called with each request before it is executed, and nothing is kept of primitives, so that streams of any length are
    /// read in bounded memory; frames are empty. In place of archives, and of procedurals that may be made, come the requests
    /// that are in them; conditions are decided. What is left open by an archive is closed.
    std::function<void(const Call&)> executed;
    /// With `executed`, of requests that are not in the table, each time. `values`: all up to the next name.
    std::function<void(const std::string& name, const std::vector<Value>& values)> unknown;
};

/// Reads streams one after the other into one graphics state. Every problem is reported; nothing throws, nothing stops early
/// but ErrorHandler "abort". Not thread safe.
class RibReader {
public:
    /// The consumer and the diagnostics must outlive the reader.
    RibReader(ReaderOptions, scene::FrameConsumer&, Diagnostics&);
    ~RibReader();
    /// Each returns true when this stream brought no error. Blocks left open at its end are closed with an error, an open world
    /// renders what there is; options, attributes and declarations stay for the next stream.
    bool readFile(const std::string& path); ///< "-" is standard input
    bool readMemory(std::string_view text, const std::string& name);
    bool readStream(std::istream& in, const std::string& name);
    /// Declares that the next stream is another scene. If a world was read since the last call, the state is reset to that at the
    /// last call. Otherwise the streams held options only, for all later scenes, and the state is kept.
    void nextScene();
    /// While FrameConsumer::render() runs, with ReaderOptions::defers: expands deferred procedurals of the frame, or of the last
    /// result of this function, and returns the new frame. `which`: numbers by scene::deferredNumber(); none: all, also those
    /// inside of others. If one of them has light sources, all are expanded. Null: no frame is being rendered.
    std::shared_ptr<const scene::Frame> make(const scene::Frame&, std::span<const int> which);
    /// For a process that was forked: programs of procedurals stay with its parent, and are started again here when needed.
    void leavePrograms();
    /// Ends the programs that were started.
    void endPrograms();

private:
    struct Inside;
    std::unique_ptr<Inside> in_;
};

} // namespace alpenglow::ri
