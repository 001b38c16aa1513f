// ri.h: archives, and procedurals.
#include "ri/c/pairs.h"
#include <cstdio>
#include <cstdlib>

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {

/// One of the procedurals that every renderer has, with the strings that it takes.
void builtIn(const char* kind, RtPointer data, int strings, const RtFloat* bound) {
    static const RtFloat kUnbounded[6] = {-RI_INFINITY, RI_INFINITY, -RI_INFINITY, RI_INFINITY, -RI_INFINITY, RI_INFINITY};
    Building("Procedural")
        .text(kind)
        .texts(static_cast<const RtToken*>(data), strings)
        .numbers(bound ? bound : kUnbounded, 6)
        .run();
}

/// The text that a format makes of its arguments.
std::string printed(const char* format, va_list list) {
    va_list again;
    va_copy(again, list);
    const int n = std::vsnprintf(nullptr, 0, format, again);
    va_end(again);
    if (n <= 0) return {};
    std::string text(size_t(n) + 1, '\0');
    (void)std::vsnprintf(text.data(), text.size(), format, list);
    text.resize(size_t(n));
    return text;
}

/// A comment as callbacks get it: a format that prints it, so that it has no arguments.
void give(RtArchiveCallback callback, std::string kind, const std::string& text) {
    std::string format;
    for (const char c : text) format += c == '%' ? "%%" : std::string(1, c);
    callback(kind.data(), format.data());
}

} // namespace

extern "C" {

RtVoid RiProcDelayedReadArchive(RtPointer data, RtFloat) { builtIn("DelayedReadArchive", data, 1, nullptr); }
RtVoid RiProcRunProgram(RtPointer data, RtFloat) { builtIn("RunProgram", data, 2, nullptr); }
RtVoid RiProcDynamicLoad(RtPointer data, RtFloat) { builtIn("DynamicLoad", data, 2, nullptr); }
RtVoid RiProcFree(RtPointer data) { std::free(data); }

RtVoid RiProcedural(RtPointer data, RtBound bound, RtProcSubdivFunc subdivide, RtProcFreeFunc free) {
    Building b("Procedural");
    if (b.may(1, {bound, reinterpret_cast<const void*>(subdivide)})) {
        if (subdivide == RiProcDelayedReadArchive) builtIn("DelayedReadArchive", data, 1, bound);
        else if (subdivide == RiProcRunProgram) builtIn("RunProgram", data, 2, bound);
        else if (subdivide == RiProcDynamicLoad) builtIn("DynamicLoad", data, 2, bound);
        else
            b.text("DynamicLoad").texts(nullptr, 0).numbers(bound, 6).finish([&](const Call& by) {
                b.client()->to.subdivide([&](float detail) { subdivide(data, detail); }, {bound, bound + 6}, by);
            });
    }
    if (free) free(data);
}

RtVoid RiReadArchiveV(RtToken name, RtArchiveCallback callback, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building b("ReadArchive");
    Lexer::Comments comments;
    if (callback) comments = [callback](const std::string& kind, const std::string& text) { give(callback, kind, text); };
    b.text(name).parameters(n, tokens, values).finish([&](const Call& c) { b.client()->to.readArchive(c, comments); });
}
RtVoid RiReadArchive(RtToken name, RtArchiveCallback callback, ...) {
    ALPENGLOW_PAIRS(callback);
    RiReadArchiveV(name, callback, ALPENGLOW_LIST);
}

RtVoid RiArchiveRecord(RtToken type, const char* format, ...) {
    Building b("ArchiveRecord");
    if (!b.may(1, {type, format})) return;
    const std::string kind = type;
    if (kind != "comment" && kind != "structure" && kind != "verbatim")
        return b.drop(Rie::BadToken, "type \"" + kind.substr(0, 80) + "\" is not known", "comment, structure or verbatim");
    va_list list;
    va_start(list, format);
    const std::string text = printed(format, list);
    va_end(list);
    b.text(kind).text(text).finish([&](const Call& by) { b.client()->to.record(kind, text, by); });
}

RtArchiveHandle RiArchiveBeginV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    Building("ArchiveBegin").text(name).parameters(n, tokens, values).run();
    return const_cast<char*>(name); // RiReadArchive takes the name
}
RtArchiveHandle RiArchiveBegin(RtToken name, ...) {
    ALPENGLOW_PAIRS(name);
    return RiArchiveBeginV(name, ALPENGLOW_LIST);
}
RtVoid RiArchiveEnd(void) { Building("ArchiveEnd").run(); }

RtVoid RiSystem(RtToken command) { Building("System").text(command).run(); }

} // extern "C"
