// Options of render in one text.
#include "cli/renderarguments.h"
#include <CLI/CLI.hpp>

namespace alpenglow::cli {

std::string readRenderOptions(const std::string& text, RenderArguments& a) {
    CLI::App app;
    app.set_help_flag();
    addRenderOptions(app, a);
    try {
        app.parse(text, false);
        if (!a.scenes.empty()) return "\"" + a.scenes[0] + "\" is no option";
        a.scenes = {"-"}; // no scene is read, and none is missing
        checkRenderArguments(a, app);
        a.scenes.clear();
    } catch (const CLI::ParseError& e) { return e.what(); }
    if (a.watch || a.framesAtOnce > 1 || !a.preview.empty() || !a.tev.empty())
        return "--watch, --frames-at-once, --preview and --display tev are for scenes in files";
    return {};
}

} // namespace alpenglow::cli
