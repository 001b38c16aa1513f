// Several frames drawn at a time, each in a process that begins as a copy of the one that reads the scene. Their messages and
// figures come out in the order of the frames.
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

/// The process that reads plans a frame and calls start(), which returns twice: false there, true in a copy of it, which draws
/// the frame and calls finish(). What processes write to standard output and standard error, and what is reported, comes out
/// frame by frame: of the first frame that is not done at once, of the others when it is their turn. The reading process must not
/// have other threads. Not thread safe, but for the functions that say so.
class FrameProcesses {
public:
    struct Use {
        int most = 2;                           ///< processes that draw at a time, 1 to limits::kFramesAtOnce
        const StopFlag* stop = nullptr;         ///< may be null
        int stopSignal = 0;                     ///< is sent to each process once *stop is set; 0: none
        std::function<void(bool alone)> begins; ///< called in each process first; alone: no other draws meanwhile. May be empty
        std::function<void()> ends;             ///< called in each process last; may be empty
    };
    /// What a process writes, which later frames may read.
    struct Writes {
        std::vector<std::string> files; ///< known names
        bool others = false;            ///< and files of names that are not known
        bool settled = false;           ///< `others` is known; false: the process will say
    };
    using Take = std::function<void(FrameResult)>;

    /// `told` gets the messages in their order; it outlives this.
    FrameProcesses(Use, Diagnostics& told);
    /// Ends the processes that still draw.
    ~FrameProcesses();
    FrameProcesses(const FrameProcesses&) = delete;
    FrameProcesses& operator=(const FrameProcesses&) = delete;

    int most() const { return use_.most; }
    bool inProcess() const { return process_; } ///< this is a copy that start() made
    const Diagnostics& told() const { return told_; }
    /// Gets the result of each frame, in their order, when all that it said is told.
    void setTake(Take t) { take_ = std::move(t); }
    /// A message of whoever runs: of the reading process behind those of the frames so far, of a drawing one for its frame. For
    /// Diagnostics::setHandler().
    void say(const Diagnostic&);

    // --- in the process that reads ---
    /// Waits until one process more may draw. Messages from here on belong to the frame that comes.
    void openFrame();
    /// Makes the process. what: names the frame in messages. alone: no other draws meanwhile, openFrame() has been called behind
    /// settle(). Throws std::system_error where there can be no further process.
    bool start(const std::string& what, Writes, bool alone);
    /// Messages from here on belong to the reader again.
    void closeFrame();
    /// Waits until all frames are drawn and told of.
    void settle();

    // --- in either ---
    /// Before a file of this name is looked for: waits for earlier frames that may write it. In a process that draws, any thread.
    void awaitRead(const std::string& name);

    // --- in a process that draws ---
    /// The files that it writes are known now but for none (false) or some (true).
    void declare(bool others);
    /// Before files are written that earlier frames may read, or write too: waits until these are drawn. Any thread.
    void awaitTurn();
    /// Hands the result over and ends the process.
    [[noreturn]] void finish(FrameResult);

private:
    enum class Kind : char { Text = 'o', Error = 'e', Message = 'd', Declare = 'w', Ask = 'a', Result = 'r' };
    struct Event {
        Kind kind;
        std::string bytes;
    };
    struct Part { ///< a frame, or what the reader says between two
        std::deque<Event> events;
        std::string what;
        std::string unread; ///< of standard error, the beginning of a record
        pid_t process = -1; ///< that runs; -1: none
        int out = -1, error = -1, answer = -1;
        Writes writes;
        bool asks = false;            ///< waits for an answer
        std::string asked;            ///< for the file of this name; "": for its turn
        bool begun = false;           ///< the two below hold
        int errors = 0, warnings = 0; ///< told before it
        bool result = false;          ///< `made` holds
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
    void tell();
    void tellEvent(const Event&);
    void send(Kind, const std::string& bytes);
    void await(const std::string& asked);

    Use use_;
    Diagnostics& told_;
    Take take_;
    std::deque<Part> parts_; ///< those that are not told of, in order
    bool open_ = false;      ///< between openFrame() and closeFrame(): the last part is the frame
    bool stopSent_ = false;
    bool lost_ = false; ///< standard output takes no more
    bool process_ = false;
    int answers_ = -1; ///< of the reading process
    std::mutex asking_;
    std::set<std::string> answered_; ///< names
};

} // namespace alpenglow::render
