// The C binding (include/ri.h): what a program calls, or a library while it makes the content of a procedural, becomes requests,
// by the same way as those of a file.
#pragma once
#include "ri/c/target.h"
#include "scene/counts.h"
#include <cstdarg>
#include <ri.h>

namespace alpenglow::ri {

/// The context that the C functions act on, which is none of their arguments.
struct Client {
    Target& to;        ///< receives the calls
    SourcePlace place; ///< of what is called; for a program "call" and which one it is
    const char* by;    ///< " called by a library" or "", for messages
    /// That of this thread, else that of the process; null when there is none.
    static Client* current();
    /// RiBegin, RiContext, RiEnd: the client of all threads that do not expand a procedural; null: none. Must outlive its use.
    static void setOfProcess(Client*);
};

/// While it lives, calls of this thread are those of a library that makes content for an interpreter.
class LibraryCalls {
public:
    /// Failures are reported with the place of the request that asked.
    LibraryCalls(Interpreter& to, const Call& by);
    ~LibraryCalls();
    LibraryCalls(const LibraryCalls&) = delete;
    LibraryCalls& operator=(const LibraryCalls&) = delete;

private:
    InterpreterTarget target_;
    Client client_;
    Client* outer_;
};

/// While it lives, calls of this thread go to a target.
class CallsTo {
public:
    /// place, by: Client's.
    CallsTo(Target& to, const SourcePlace& place, const char* by);
    ~CallsTo();
    CallsTo(const CallsTo&) = delete;
    CallsTo& operator=(const CallsTo&) = delete;

private:
    Client client_;
    Client* outer_;
};

/// One call of ri.h, around everything that is done for it. Calls of a program come one after the other, whatever their thread;
/// what they report reaches the program's error handler when the outermost is done (ri/c/errors.h).
class Boundary {
public:
    /// Waits until no other thread is in a call.
    Boundary();
    ~Boundary();
    Boundary(const Boundary&) = delete;
    Boundary& operator=(const Boundary&) = delete;

private:
    bool locked_;
};

/// A parameter list of C: tokens and values up to RI_NULL.
struct Pairs {
    /// Reads up to RI_NULL.
    explicit Pairs(va_list);
    /// Number of tokens.
    RtInt count() const { return RtInt(tokens.size()); }
    std::vector<RtToken> tokens;
    std::vector<RtPointer> values;
};

/// A request under construction: the arguments of its RIB form, in order. Null pointers and negative counts are reported and drop
/// it; without a client RIE_NOTSTARTED is reported.
class Building : Boundary {
public:
    /// request: its name in the table.
    explicit Building(const char* request);
    /// Append an argument each: a number or text bare, arrays with their n values.
    Building& number(double);
    Building& number(RtFloat f);
    Building& number(RtInt i) { return number(double(i)); }
    Building& numbers(const RtFloat*, int64_t n);
    Building& ints(const RtInt*, int64_t n);
    Building& text(const char*);
    Building& text(const std::string& s) { return text(s.c_str()); }
    Building& texts(const RtToken*, int64_t n);
    /// counts: of a primitive's variables; null where every value is one element. category: of Attribute and Option.
    Building& parameters(RtInt n, const RtToken*, const RtPointer*, const scene::VariableCounts* counts = nullptr,
                         const std::string& category = {});
    /// The same for a primitive of which p holds what its counts follow from.
    Building& variables(RtInt n, const RtToken*, const RtPointer*, const scene::Primitive& p);
    void run() {
        finish([this](const Call& c) { client_->to.execute(c); });
    }
    /// The same, done by somebody else.
    void finish(const std::function<void(const Call&)>& how);
    /// Whether arrays of `n` behind these pointers may be read; otherwise that is reported and the request is dropped.
    bool may(int64_t n, std::initializer_list<const void*>);
    /// Reports a problem; the call is still executed.
    void report(Severity, Rie, const std::string& why, const std::string& hint = {});
    /// Reports, and drops the request.
    void drop(Rie, const std::string& why, const std::string& hint = {});
    /// Null: the request has been dropped.
    Client* client() const { return client_; }

private:
    scene::VariableCounts counted(const scene::Primitive&);
    Value& add(Value::Kind, bool array);
    /// Adds n elements as numbers, or as strings.
    template <class T> void addNumbers(const T*, int64_t n, double (*number)(T));
    void parameter(const char* token, const void* values, const scene::VariableCounts&, const std::string& category);
    /// n strings whose addresses are at `values`; a text at that address itself is taken as the one string.
    void stringValues(const char* token, const void* values, int64_t n);
    Client* client_;
    const Request* request_ = nullptr;
    std::vector<Value> values_;
};

/// Converts a float of C to a number of RIB: the shortest decimal of that float, so that a program and a file that write .1
/// make the same scene.
double numberOf(RtFloat);

/// The sum of counts; -1 with a negative one among them.
int64_t total(const RtInt*, int64_t n);
/// A new light or object, as a handle.
RtPointer newHandle(Client&);
/// The name of a handle in requests. Handles that no call returned get names that no light or object has.
std::string handleName(const Client&, RtPointer);

} // namespace alpenglow::ri
