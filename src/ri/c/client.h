// The C binding (include/ri.h): what a library calls while it makes the content of a procedural becomes requests at the
// procedural's place, by the same way as those of a file.
#pragma once
#include "ri/interpreter.h"
#include "scene/counts.h"
#include <cstdarg>
#include <ri.h>

namespace alpenglow::ri {

/// Who the C functions of this thread talk to, while it lives. C gives them no argument that could say so.
class Client {
public:
    Client(Interpreter& to, const Call& by);
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;
    /// Null when nobody has asked this thread for content.
    static Client* current();

    Interpreter& in;
    const Call& by; ///< the request that asked; failures are reported with its place
private:
    Client* outer_;
};

/// A parameter list of C: tokens and values up to RI_NULL.
struct Pairs {
    explicit Pairs(va_list);
    RtInt count() const { return RtInt(tokens.size()); }
    std::vector<RtToken> tokens;
    std::vector<RtPointer> values;
};

/// A request under construction: the arguments of its RIB form, in order. Null pointers and negative counts are reported and drop
/// it; without a client nothing happens.
class Building {
public:
    explicit Building(const char* request);
    Building& number(double);
    Building& numbers(const RtFloat*, int64_t n);
    Building& ints(const RtInt*, int64_t n);
    Building& text(const char*);
    Building& texts(const RtToken*, int64_t n);
    /// counts: of a primitive's variables; null where every value is one element. category: of Attribute.
    Building& parameters(RtInt n, const RtToken*, const RtPointer*, const scene::VariableCounts* counts = nullptr,
                         const std::string& category = {});
    /// The same for a primitive of which p holds what its counts follow from.
    Building& variables(RtInt n, const RtToken*, const RtPointer*, const scene::Primitive& p);
    void run();
    /// Whether arrays of `n` behind these pointers may be looked at: reported otherwise, and the request is dropped.
    bool may(int64_t n, std::initializer_list<const void*>);
    Client* client() const { return client_; }

private:
    scene::VariableCounts counted(const scene::Primitive&);
    void drop(const std::string& why);
    Value& add(Value::Kind, bool array);
    void parameter(const char* token, const void* values, const scene::VariableCounts&, const std::string& category);
    Client* client_;
    const Request* request_ = nullptr;
    std::vector<Value> values_;
};

/// The sum of counts; -1 with a negative one among them.
int64_t total(const RtInt*, int64_t n);
/// A number that this reader has not given to a light or an object of a library before, as a handle and as what requests call it.
RtPointer newHandle(Client&, std::string& name);
std::string handleName(RtPointer);

} // namespace alpenglow::ri
