// Renders several frames at once, each in a process forked from the one that reads the scene. Messages and figures are printed in
// frame order.
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include "render/outcome.h"
#include <deque>
#include <functional>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <sys/types.h>
#include <vector>

namespace alpenglow::render {

/// The reading process plans a frame and calls start(), which returns twice: false there, and true in the fork, which renders the
/// frame and calls finish(). Standard output, standard error and messages of the processes are printed in frame order: at once
/// for the first unfinished frame, later for the others. The reading process must not have other threads. Not thread safe, except
/// where stated.
class FrameProcesses {
public:
    /// How the processes work.
    struct Use {
        int most = 2;                           ///< maximum number of rendering processes, 1 to limits::kFramesAtOnce
        const StopFlag* stop = nullptr;         ///< may be null
        int stopSignal = 0;                     ///< sent to each process once *stop is set; 0: none
        std::function<void(bool alone)> begins; ///< called first in each process; alone: no other process renders. May be empty
        std::function<void()> ends;             ///< called last in each process; may be empty
    };
    /// The files that a process writes, which later frames may read.
    struct Writes {
        std::vector<std::string> files; ///< known names
        bool others = false;            ///< and files of names that are not known
        bool declared = false;          ///< `others` is known; false: the process will declare it
    };
    using Take = std::function<void(FrameResult)>;

    /// `messages` receives the messages in order; it must outlive this object.
    FrameProcesses(Use, Diagnostics& messages);
    /// Ends the processes that are still rendering.
    ~FrameProcesses();
    FrameProcesses(const FrameProcesses&) = delete;
    FrameProcesses& operator=(const FrameProcesses&) = delete;

    /// Frames that are rendered at a time.
    int most() const { return use_.most; }
    bool inProcess() const { return process_; } ///< this process was forked by start()
    /// Of this frame.
    const Diagnostics& messages() const { return messages_; }
    /// Sets the receiver of each frame's result, in frame order, after its messages have been printed.
    void setTake(Take t) { take_ = std::move(t); }
    /// Reports a message: in the reading process after those of earlier frames, in a rendering process for its frame. For
    /// Diagnostics::setHandler().
    void say(const Diagnostic&);

    // --- in the reading process ---
    /// Waits until another process may render. Later messages belong to the next frame.
    void openFrame();
    /// Forks the process. what: names the frame in messages. alone: no other process renders; openFrame() must have been called
    /// after waitForFrames(). Throws std::system_error if no process can be made.
    bool start(const std::string& what, Writes, bool alone);
    /// Later messages belong to the reader again.
    void closeFrame();
    /// Waits until all frames are rendered and their messages printed.
    void waitForFrames();

    // --- in either ---
    /// Call before looking for a file of this name: waits for earlier frames that may write it. In a rendering process callable
    /// from any thread.
    void awaitRead(const std::string& name);

    // --- in a rendering process ---
    /// Declares that the files it writes are all known (false), or not (true).
    void declare(bool others);
    /// Call before writing files that earlier frames may read or write: waits until these are rendered. Any thread.
    void awaitTurn();
    /// Sends the result to the reader and ends the process.
    [[noreturn]] void finish(FrameResult);

private:
    enum class Kind : char { Text = 'o', Error = 'e', Message = 'd', Declare = 'w', Ask = 'a', Result = 'r' };
    struct Event {
        Kind kind;
        std::string bytes;
    };
    struct Part { ///< a frame, or messages of the reader between two frames
        std::deque<Event> events;
        std::string what;
        std::string unread; ///< of standard error: start of an incomplete record
        pid_t process = -1; ///< running process; -1: none
        int out = -1, error = -1, answer = -1;
        Writes writes;
        bool asks = false;            ///< waits for an answer
        std::string asked;            ///< waits for this file; "": for its turn
        bool begun = false;           ///< errors and warnings are set
        int errors = 0, warnings = 0; ///< reported before it
        bool result = false;          ///< `made` is set
        FrameResult made;
    };
    int running() const;
    void serve(int milliseconds);
    void askToStop();
    void readFrom(Part&, bool error);
    void split(Part&);
    void take(Part&, Kind, std::string bytes);
    void reap(Part&);
    void sayLost(Part&, int status);
    void answerAll();
    bool mayRead(size_t part, const std::string& name) const;
    void writeOut(const std::string& bytes);
    void printMessages();
    void printEvent(const Event&);
    void send(Kind, const std::string& bytes);
    void await(const std::string& asked);

    Use use_;
    Diagnostics& messages_;
    Take take_;
    std::deque<Part> parts_; ///< those not yet printed, in order
    bool open_ = false;      ///< between openFrame() and closeFrame(): the last part is the frame
    bool stopSent_ = false;
    bool lost_ = false; ///< standard output is closed
    bool process_ = false;
    int answers_ = -1; ///< of the reading process
    std::mutex asking_;
    std::set<std::string> answered_; ///< names
};

} // namespace alpenglow::render
