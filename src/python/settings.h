// What Python asks of a render, by the options of `alpenglow render`, so that none is described twice.
#pragma once
#include "cli/renderarguments.h"
#include "render/renderer.h"
#include "ri/reader.h"

namespace alpenglow::python {

/// The arguments of a command line without its scenes, flags of other renderers too. Throws Error with what is wrong; options
/// that would take hold of the whole process (--watch, --cwd, --preview, --frames-at-once ...) are.
cli::RenderArguments renderArguments(std::vector<std::string> flags);
/// For a reader; defers: procedurals may wait until rays come to them.
ri::ReaderOptions readerOptions(const cli::RenderArguments&, bool defers);

/// The exit status of the program (cli::Status) for what came of a run.
int statusOf(const render::Outcome&, const Diagnostics&, bool interrupted, bool memory);

} // namespace alpenglow::python
