// Receives the requests that calls of the C binding become: executes them, or writes them.
#pragma once
#include "ri/c/sketch.h"
#include "ri/interpreter.h"
#include "ri/lexer.h"
#include <functional>
#include <map>
#include <optional>
#include <ri.h>
#include <string>
#include <vector>

namespace alpenglow::ri {

/// Receiver of the calls of one context of the C binding.
class Target {
public:
    virtual ~Target() = default;
    /// Receives a request. Its parameter list is not yet typed; its place is that of the call.
    virtual void execute(const Call&) = 0;
    /// Where faults of calls are reported.
    virtual Reporter& reporter() = 0;
    /// Whether further requests are ignored.
    virtual bool stopped() const { return false; }
    // These determine how many values the arrays of the next call have.
    virtual const Declarations& declarations() const = 0;
    /// Numbers of a colour; the attributes in effect.
    virtual int colorSamples() const = 0;
    virtual scene::AttributesRef attributes() = 0;
    /// A number that no light or object of this target has.
    virtual int nextHandle() = 0;
    /// The name that requests use for the light or object of a number.
    std::string handleName(int) const;
    /// Sets the name that the program has chosen ("__handleid").
    void nameHandle(int number, std::string name) { named_[number] = std::move(name); }
    /// From one space to another; nothing where one of them is not known.
    virtual std::optional<Matrix> between(const std::string& from, const std::string& to) = 0;
    /// Content made by calls, with the graphics state saved before and restored after; `make` gets the area in pixels of the
    /// bound. What it throws is reported.
    virtual void subdivide(const std::function<void(float)>& make, const std::vector<float>& bound, const Call& by) = 0;
    /// ReadArchive; comments: gets those of the archive, may be empty.
    virtual void readArchive(const Call&, const Lexer::Comments& comments) = 0;
    /// RiArchiveRecord: "comment", "structure" or "verbatim".
    virtual void record(const std::string& type, const std::string& text, const Call& by) = 0;
    /// RiErrorHandler: "ignore", "print" or "abort".
    virtual void errorHandler(const std::string& /*style*/) {}

protected:
    virtual std::string nameOf(int) const = 0;

private:
    std::map<int, std::string> named_;
};

/// Executes calls.
class InterpreterTarget : public Target {
public:
    /// The interpreter must outlive the target.
    explicit InterpreterTarget(Interpreter& in) : in_(in) {}
    void execute(const Call&) override;
    Reporter& reporter() override { return in_.reporter; }
    bool stopped() const override { return in_.stopped(); }
    const Declarations& declarations() const override { return held_ ? held_->declarations : in_.declarations; }
    int colorSamples() const override;
    scene::AttributesRef attributes() override { return held_ ? held_->attributes : in_.snapshot(); }
    int nextHandle() override { return in_.nextHandle(); }
    std::optional<Matrix> between(const std::string& from, const std::string& to) override;
    void subdivide(const std::function<void(float)>& make, const std::vector<float>& bound, const Call& by) override;
    void readArchive(const Call&, const Lexer::Comments& comments) override;
    void record(const std::string& type, const std::string& text, const Call& by) override;

private:
    std::string nameOf(int) const override;
    void executed();
    Interpreter& in_;
    std::optional<Sketch> held_; ///< while calls are kept for later, or passed over
};

/// Calls `make` between AttributeBegin and AttributeEnd with an unknown area. Exceptions of it are reported.
void subdivideHere(Target&, const std::function<void(float)>& make, const Call& by);

} // namespace alpenglow::ri
