// What `alpenglow --version` prints: the version, and what a report of a fault has to say about the machine and the installation.
#include "base/installation.h"
#include "base/processors.h"
#include "cli/version.h"
#include "display/foreign.h"
#include "models/modelfile.h"
#include "rsl/jit/module.h"
#include "rsl/kernel.h"
#include <fmt/format.h>

namespace alpenglow::cli {

namespace {

std::string reportLine(const char* name, const std::string& value) { return fmt::format("  {:<10} {}\n", name, value); }

} // namespace

std::string versionReport() {
    std::string report = softwareName() + "\n";
    report[0] = 'a'; // as the program is called
    std::string error;
    const std::string llvm = rsl::jit::llvmVersion(error);
    report += reportLine("LLVM", llvm.empty() ? "none: " + error : llvm);
    const int lanes = rsl::KernelOptions{}.lanes, threads = defaultThreads();
    report += reportLine("processor", fmt::format("{}, {} thread{}, {} lanes ({})", processorLevel(), threads,
                                                  threads == 1 ? "" : "s", lanes, rsl::jit::name(rsl::jit::isaFor(lanes))));
    const std::string shaders = shippedShaders();
    report += reportLine("shaders", shaders.empty() ? "none" : shaders);
    const char* name = "modules";
    for (const std::string& file :
         {rsl::jit::moduleFile(), display::fileOf(display::pictureModule()), display::fileOf(display::gridModule()),
          models::moduleOf("m.gltf"), models::moduleOf("m.fbx")}) {
        if (file.empty()) continue;
        report += reportLine(name, file);
        name = "";
    }
    report.pop_back(); // the parser ends the line
    return report;
}

} // namespace alpenglow::cli
