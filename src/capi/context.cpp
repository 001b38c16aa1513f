// Contexts of the C binding: RiBegin, RiEnd, RiContext (RISpec 3.2, section 4). Which one is current is a matter of the process,
// as the specification has it.
#include "capi/output.h"
#include "cli/command.h"
#include "ri/c/client.h"
#include "ri/c/errors.h"
#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>

#undef RI_A
extern "C" RtToken RI_A;

namespace alpenglow::capi {

namespace {

/// Messages name options as the command line spells them; who calls a library has no command line.
void reportOfProgram(Diagnostic d) {
    if ((d.message + d.hint).find("--") != std::string::npos)
        d.hint += std::string(d.hint.empty() ? "" : "; ") +
                  "a program that calls the library takes such options from the environment variable ALPENGLOW_OPTIONS";
    ri::noteError(d);
}

struct Context {
    Diagnostics diags{reportOfProgram};
    std::unique_ptr<Output> output;
    std::optional<ri::Client> client;
};

/// All contexts, of which the C binding has handles. Never destroyed: a program may end in the middle.
std::vector<std::unique_ptr<Context>>& contexts() {
    static auto* all = new std::vector<std::unique_ptr<Context>>;
    return *all;
}

Context* currentContext() {
    const ri::Client* c = ri::Client::current();
    for (const auto& x : contexts())
        if (&*x->client == c) return x.get();
    return nullptr;
}

void fault(Rie code, const std::string& message, const std::string& hint = {}) {
    Diagnostic d;
    d.code = code;
    d.message = message;
    d.hint = hint;
    ri::noteError(d);
}

std::string environment(const char* variable) {
    const char* value = std::getenv(variable);
    return value ? value : "";
}

std::unique_ptr<Output> outputOf(const std::string& name, Diagnostics& diags) {
    if (name.empty() || name == "__render" || name.starts_with("launch:")) // the last two: as Pixar's binding of Python has them
        return drawing(environment("ALPENGLOW_OPTIONS"), diags);
    if (name[0] == '|') {
        diags.report(Severity::Error, Rie::Incapable, {}, fmt::format("RiBegin: \"{}\" is a command, and none is run", name),
                     "\"-\" writes RIB to standard output, which a pipe takes further");
        return nullptr;
    }
    return ribFile(name, diags);
}

/// One of the tokens that are variables, so that the library has them all.
[[gnu::used]] const void* const kTokens = &RI_A;

/// What RiErrorPrint prints is what the program prints.
const bool kPrinterSet = [] {
    ri::setErrorPrinter(cli::printer());
    return true;
}();

} // namespace

} // namespace alpenglow::capi

using namespace alpenglow;
using namespace alpenglow::capi;

extern "C" {

RtVoid RiBegin(RtToken given) {
    const ri::Boundary boundary;
    const ri::Client* c = ri::Client::current();
    if (c && !currentContext()) return fault(Rie::IllState, "RiBegin: not while a library makes the content of a procedural");
    std::string name = given ? given : "";
    if (name.empty()) name = environment("RISERVER");
    auto context = std::make_unique<Context>();
    try {
        context->output = outputOf(name, context->diags);
    } catch (const std::exception& e) { fault(Rie::System, fmt::format("RiBegin: {}", e.what())); }
    if (!context->output) return;
    context->client.emplace(ri::Client{context->output->target(), {"call", 1, 0}, ""});
    ri::Client::setOfProcess(&*context->client);
    contexts().push_back(std::move(context));
}

RtVoid RiEnd(void) {
    const ri::Boundary boundary;
    Context* context = currentContext();
    if (!context) {
        if (ri::Client::current()) return fault(Rie::IllState, "RiEnd: not while a library makes the content of a procedural");
        return ri::noteNotStarted("RiEnd");
    }
    try {
        context->output->end(context->client->place);
    } catch (const std::exception& e) { fault(Rie::System, fmt::format("RiEnd: {}", e.what())); }
    ri::Client::setOfProcess(nullptr);
    std::erase_if(contexts(), [&](const auto& c) { return c.get() == context; });
}

RtContextHandle RiGetContext(void) {
    const ri::Boundary boundary;
    return currentContext();
}

RtVoid RiContext(RtContextHandle handle) {
    const ri::Boundary boundary;
    if (ri::Client::current() && !currentContext())
        return fault(Rie::IllState, "RiContext: not while a library makes the content of a procedural");
    for (const auto& c : contexts())
        if (c.get() == handle) return ri::Client::setOfProcess(&*c->client);
    if (!handle) return ri::Client::setOfProcess(nullptr); // what RiGetContext gives when there is none
    fault(Rie::BadHandle, "RiContext: there is no such context",
          "RiGetContext gives the handle of the current one; RiEnd ends it");
}

} // extern "C"
