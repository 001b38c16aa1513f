#include "ri/c/target.h"
#include <exception>
#include <fmt/format.h>

namespace alpenglow::ri {

std::string Target::handleName(int number) const {
    const auto own = named_.find(number);
    return own == named_.end() ? nameOf(number) : own->second;
}

void subdivideHere(Target& to, const std::function<void(float)>& make, const Call& by) {
    const auto bare = [&](const char* request) {
        Call c;
        c.place = by.place;
        c.request = findRequest(request);
        to.execute(c);
    };
    bare("AttributeBegin");
    try {
        make(RI_INFINITY);
    } catch (const std::exception& e) {
        to.reporter().error(Rie::System, by.place, fmt::format("Procedural: its function threw: {}", e.what()));
    } catch (...) { to.reporter().error(Rie::System, by.place, "Procedural: its function threw something"); }
    bare("AttributeEnd");
}

void InterpreterTarget::execute(const Call& call) {
    if (held_) (void)held_->note(call); // the interpreter reports errors when it executes them
    in_.execute(call);
    executed();
}

void InterpreterTarget::executed() {
    if (!in_.holdsBack()) held_.reset();
    else if (!held_) held_.emplace(in_.declarations, colorSamples(), in_.snapshot());
}

int InterpreterTarget::colorSamples() const {
    if (held_) return held_->colorSamples;
    return in_.nRGB.empty() ? 3 : int(in_.nRGB.size() / 3);
}

/// Not as a file could name its own: archives share the interpreter with the program.
std::string InterpreterTarget::nameOf(int number) const { return fmt::format("library:{}", number); }

std::optional<Matrix> InterpreterTarget::between(const std::string& from, const std::string& to) {
    const auto a = in_.namedSystem(from), b = in_.namedSystem(to);
    if (!a || !b) return {};
    return a->first() * inverse(b->first());
}

void InterpreterTarget::subdivide(const std::function<void(float)>& make, const std::vector<float>& bound, const Call& by) {
    if (in_.holdsBack()) return subdivideHere(*this, make, by);
    in_.subdivide(make, "", bound, by);
}

void InterpreterTarget::readArchive(const Call& call, const Lexer::Comments& comments) {
    auto before = std::exchange(in_.settings.comments, comments ? comments : in_.settings.comments);
    execute(call);
    in_.settings.comments = std::move(before);
}

void InterpreterTarget::record(const std::string& type, const std::string& text, const Call& by) {
    if (type != "verbatim") return; // other records only matter in a file
    in_.expand(text, by);
    executed();
}

} // namespace alpenglow::ri
