// Archives and System (RISpec 3.2, 7.3).
#include "ri/interpreter.h"

namespace alpenglow::ri {
namespace {

void readArchive(Interpreter& in, const Call& c) { in.readArchive(c.text(0), c.place); }

} // namespace

std::vector<Request> archiveRequests() {
    const Kind k = Kind::Archive;
    return {
        {"ReadArchive", "string name; ..", k, kAnywhere, false, "Executes another RIB file, or an inline archive.",
         "\"part.rib\"", readArchive},
        {"ArchiveBegin", "string name; ..", k, kAnywhere, false,
         "The requests up to ArchiveEnd are kept under a name, for ReadArchive.", "\"part\"",
         [](Interpreter& in, const Call& c) { in.beginRecording(c); }},
        {"ArchiveEnd", "", k, kAnywhere, false, "Ends the inline archive.", "",
         [](Interpreter& in, const Call& c) { in.reporter.error(Rie::Nesting, c.place, "ArchiveEnd without ArchiveBegin"); }},
        {"ArchiveRecord", "string type; string text; ..", k, kAnywhere, false, "Text for a RIB writer; has no effect when read.",
         "\"comment\" \"by hand\"", [](Interpreter&, const Call&) {}},
        {"System", "string command", Kind::Other, kAnywhere, false, "A shell command; it is never run.", "\"ls\"",
         [](Interpreter& in, const Call& c) {
             in.incapable(c, in.settings.allowExec ? "System is not run by this version"
                                                   : "System runs foreign code: it needs --allow-exec and is left out");
         }},
    };
}

} // namespace alpenglow::ri
