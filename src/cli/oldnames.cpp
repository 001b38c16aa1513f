#include "cli/oldnames.h"
#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

using Use = OldFlag::Use;

constexpr std::string_view kNoWindow = "no window is opened; `alpenglow ptc picture CLOUD out.png` draws it";

constexpr OldName kOldNames[] = {
    {"aqsis", "render", ""},
    {"aqsl", "compile", ""},
    {"aqsltell", "info", ""},
    {"brickinfo", "info", ""},
    {"brickmake", "ptc brick", ""},
    {"catrib", "rib", ""},
    {"hdri2tif", "", "pictures are read as they are; `alpenglow maketx` makes maps of them"},
    {"it", "", "`alpenglow view scene.rib` shows a picture as it grows"},
    {"mkmip", "maketx", ""},
    {"oslc", "compile", ""},
    {"prman", "render", ""},
    {"ptc2brick", "ptc brick", ""},
    {"ptcview", "info", kNoWindow},
    {"ptfilter", "", "`alpenglow ptc filter` and `alpenglow ptc bounce` make clouds of clouds"},
    {"ptmerge", "ptc merge", ""},
    {"ptviewer", "info", kNoWindow},
    {"renderdl", "render", ""},
    {"rendrib", "render", ""},
    {"rgl", "", "`alpenglow render --watch terminal` or `alpenglow view` show a scene while it is drawn"},
    {"ribdepends", "rib", "--stats names the shaders and archives that a scene asks for"},
    {"rndr", "render", ""},
    {"sdrc", "compile", ""},
    {"sdrinfo", "info", ""},
    {"shader", "compile", ""},
    {"shaderdl", "compile", ""},
    {"shaderinfo", "info", ""},
    {"sho", "info", "no window is opened: it prints what is in the picture"},
    {"slc", "compile", ""},
    {"sloinfo", "info", ""},
    {"sltell", "info", ""},
    {"tdlmake", "maketx", ""},
    {"teqser", "maketx", ""},
    {"texmake", "maketx", ""},
    {"txinfo", "info", ""},
    {"txmake", "maketx", ""},
};

constexpr std::string_view kNumbers = "maps hold the numbers that their pictures have",
                           kSize = "maps keep the size of their pictures", kPacked = "maps are packed without loss",
                           kSlo = "shaders are read as source: no object file is written",
                           kOrient = "turn the picture first, for example with `convert`",
                           kSaid = "messages go to standard error";

constexpr OldFlag kMaketxFlags[] = {
    {"-byte", 0, "txmake", Use::Dropped, kNumbers},
    {"-ch", 1, "txmake", Use::Noted, "all channels are kept"},
    {"-colorspace", 1, "tdlmake", Use::Noted, "--srgb and --linear say what the numbers of pictures are"},
    {"-compression", 1, "txmake", Use::Dropped, kPacked},
    {"-deflate", 0, "tdlmake", Use::Dropped, kPacked},
    {"-extraargs", 1, "txmake", Use::Dropped, "nothing reads them"},
    {"-filterwidth", 1, "txmake, tdlmake", Use::Accepted, "--width $1"},
    {"-flips", 0, "tdlmake", Use::Answered, kOrient},
    {"-flipst", 0, "tdlmake", Use::Answered, kOrient},
    {"-flipt", 0, "tdlmake", Use::Answered, kOrient},
    {"-float", 0, "txmake", Use::Dropped, kNumbers},
    {"-format", 1, "txmake", Use::Dropped, "the map's name decides about its format"},
    {"-gamma", 1, "tdlmake", Use::Noted, "--srgb and --linear say what the numbers of pictures are"},
    {"-half", 0, "txmake", Use::Dropped, kNumbers},
    {"-lightprobe", 0, "tdlmake", Use::Answered, "make a latitude-longitude picture of it first, then --envlatl"},
    {"-lzw", 0, "tdlmake", Use::Dropped, kPacked},
    {"-memory", 1, "txmake", Use::Dropped, "memory is taken as it is needed"},
    {"-minmaxshadow", 0, "txmake", Use::Accepted, "--shadow"},
    {"-newer", 0, "txmake, tdlmake", Use::Accepted, "--newer"},
    {"-nomipmap", 0, "tdlmake", Use::Dropped, "maps always have their reduced levels"},
    {"-none", 0, "tdlmake", Use::Dropped, kPacked},
    {"-packbits", 0, "tdlmake", Use::Dropped, kPacked},
    {"-pattern", 1, "txmake", Use::Dropped, "maps always have all reduced levels"},
    {"-pyramidshadow", 0, "txmake", Use::Accepted, "--shadow"},
    {"-progress", 0, "tdlmake", Use::Dropped, kSaid},
    {"-quality", 1, "tdlmake", Use::Dropped, "all filters are computed in full"},
    {"-resize", 1, "txmake", Use::Dropped, kSize},
    {"-sfilterwidth", 1, "txmake", Use::Accepted, "--width $1"},
    {"-short", 0, "txmake", Use::Dropped, kNumbers},
    {"-skymap", 1, "tdlmake", Use::Answered, "the light shader of a sky is in docs/light.md"},
    {"-t", 1, "txmake", Use::Dropped, "all processors are used"},
    {"-tfilterwidth", 1, "txmake", Use::Noted, "--width S T has both widths"},
    {"-twofish", 0, "tdlmake", Use::Answered, "make six pictures of it first, then --envcube"},
    {"-usermipmap", 0, "txmake", Use::Answered, "reduced levels are made of the picture"},
    {"-verbose", 0, "txmake", Use::Dropped, kSaid},
    {"-word", 0, "txmake", Use::Dropped, kNumbers},
};

constexpr OldFlag kCompileFlags[] = {
    {"-C", 0, "shader", Use::Dropped, "the preprocessor is built in"},
    {"-O", 0, "shaderdl", Use::Dropped, "shaders are always optimised"},
    {"-O0", 0, "shaderdl", Use::Dropped, "shaders are always optimised"},
    {"-O1", 0, "shaderdl", Use::Dropped, "shaders are always optimised"},
    {"-O2", 0, "shaderdl", Use::Dropped, "shaders are always optimised"},
    {"-O3", 0, "shaderdl", Use::Dropped, "shaders are always optimised"},
    {"-U", 1, "shader", Use::Noted, "no macro is taken away"},
    {"-autoplug", 0, "shader", Use::Dropped, "plug-ins are found by what they are called"},
    {"-d", 1, "shaderdl", Use::Dropped, kSlo},
    {"-f", 0, "shader", Use::Dropped, kSlo},
    {"-lint", 0, "shader", Use::Dropped, "-W warns of what the light transport cannot follow"},
    {"-lintpoint", 0, "shader", Use::Dropped, "-W warns of what the light transport cannot follow"},
    {"-lintspace", 0, "shader", Use::Dropped, "-W warns of what the light transport cannot follow"},
    {"-nolint", 0, "shader", Use::Dropped, "warnings are asked for by -W"},
    {"-o", 1, "shader, shaderdl, aqsl, oslc", Use::Noted, kSlo},
    {"-old", 0, "shader", Use::Dropped, kSlo},
    {"-q", 0, "shader", Use::Accepted, "--quiet"},
    {"-s", 1, "shader", Use::Dropped, "messages name the file that is read"},
    {"-strict", 0, "shader", Use::Dropped, "errors are always errors"},
    {"-v", 0, "shader, shaderdl", Use::Dropped, kSaid},
    {"-w", 0, "shaderdl", Use::Dropped, "warnings are asked for by -W"},
};

constexpr OldFlag kInfoFlags[] = {
    {"-a", 0, "shaderinfo", Use::Dropped, "everything is printed"},
    {"-archive", 0, "aqsltell", Use::Dropped, "everything is printed"},
    {"-d", 0, "shaderinfo", Use::Dropped, "everything is printed"},
    {"-info", 0, "ptviewer", Use::Dropped, "everything is printed"},
    {"-m", 0, "sloinfo", Use::Accepted, "--json"},
    {"-multiply", 1, "ptviewer", Use::Dropped, "no window is opened"},
    {"-onlyinfo", 0, "ptviewer", Use::Dropped, "everything is printed"},
    {"-p", 0, "sloinfo", Use::Dropped, "everything is printed"},
    {"-t", 0, "shaderinfo", Use::Dropped, "everything is printed"},
    {"-v", 0, "sloinfo", Use::Dropped, "everything is printed"},
    {"-window", 2, "ptviewer", Use::Dropped, "no window is opened"},
};

constexpr OldFlag kRibFlags[] = {
    {"-archives", 1, "renderdl", Use::Accepted, "--searchpath $1"},
    {"-ascii", 0, "catrib", Use::Accepted, "--ascii"},
    {"-binary", 0, "catrib, renderdl", Use::Accepted, "--binary"},
    {"-callprocedurals", 0, "renderdl", Use::Accepted, "--expand"},
    {"-gzip", 0, "catrib, renderdl", Use::Accepted, "--gzip"},
    {"-indent", 1, "prman", Use::Accepted, "--indent $1"},
    {"-p", 1, "prman", Use::Dropped, "RIB is read by one thread"},
    {"-progress", 0, "prman, renderdl", Use::Dropped, kSaid},
    {"-rif", 1, "prman", Use::Accepted, "--filter $1"},
    {"-t", 1, "prman, renderdl", Use::Dropped, "RIB is read by one thread"},
    {"-precision", 1, "prman", Use::Dropped, "numbers are written so that they read back as they were"},
};

constexpr OldFlag kPtcFlags[] = {
    {"-addpn", 1, "brickmake", Use::Dropped, "brick maps always hold places and normals"},
    {"-addpresence", 1, "brickmake", Use::Dropped, "brick maps always hold which voxels are met"},
    {"-ignorenormals", 1, "brickmake", Use::Noted, "points keep their normals"},
    {"-maxdepth", 1, "brickmake, ptc2brick", Use::Noted, "the cloud decides about the depth"},
    {"-maxerror", 1, "brickmake, ptc2brick", Use::Noted, "brick maps are made to their own tolerance"},
    {"-newer", 1, "brickmake", Use::Dropped, "the brick map is made anew"},
    {"-omitgeometry", 1, "brickmake", Use::Dropped, "brick maps always hold which voxels are met"},
    {"-progress", 1, "brickmake", Use::Dropped, kSaid},
    {"-radiusscale", 1, "brickmake, ptc2brick", Use::Noted, "points keep their radii"},
    {"-splitangle", 1, "brickmake", Use::Noted, "sides of surfaces are distinguished by their normals"},
};

} // namespace

std::span<const OldName> oldNames() { return kOldNames; }

const OldName* oldNameOf(const char* program) {
    std::string_view name = program ? program : "";
    name = name.substr(name.find_last_of('/') + 1);
    if (name.ends_with(".exe")) name.remove_suffix(4);
    for (const OldName& n : kOldNames)
        if (n.name == name) return &n;
    return nullptr;
}

std::span<const OldFlag> toolFlags(std::string_view command) {
    if (command == "maketx") return kMaketxFlags;
    if (command == "compile") return kCompileFlags;
    if (command == "info") return kInfoFlags;
    if (command == "rib") return kRibFlags;
    if (command == "ptc") return kPtcFlags;
    return {};
}

/// "-rif NAME -rifargs A B -rifend" as "-rif" and one word, in which each is quoted.
static void joinRifArguments(std::vector<std::string>& args) {
    const auto quoted = [](const std::string& s) {
        const char quote = s.find('\'') == s.npos ? '\'' : '"';
        return quote + s + quote;
    };
    for (size_t i = 0; i + 1 < args.size(); ++i) {
        if (args[i] != "-rif") continue;
        std::string all = quoted(args[i + 1]);
        size_t end = i + 2;
        if (end < args.size() && args[end] == "-rifargs") {
            for (++end; end < args.size() && args[end] != "-rifend"; ++end) all += " " + quoted(args[end]);
            end = std::min(end + 1, args.size());
        }
        args[i + 1] = all;
        args.erase(args.begin() + long(i + 2), args.begin() + long(end));
        ++i;
    }
}

void takeCatrib(std::vector<std::string>& args, const OldName* name) {
    const auto at = std::find_if(args.begin(), args.end(), [](const std::string& a) { return a == "-catrib" || a == "-cat"; });
    if (!args.empty() && args[0] == "render" && at != args.end()) {
        // prman's flag has the name of the output behind it, renderdl's has not.
        const bool named = *at == "-catrib" && (!name || name->name != "renderdl");
        const bool output = named && args.end() - at > 2 && (at[1] == "-" || access(at[1].c_str(), F_OK) != 0) && at[1][0] != '+';
        *at = "-o";
        if (!output) args.erase(at);
        args[0] = "rib";
    }
    if (!args.empty() && (args[0] == "rib" || args[0] == "render")) joinRifArguments(args);
    if (!name || name->name != "catrib" || args.empty() || args[0] != "rib") return;
    const auto has = [&](std::string_view flag) { return std::find(args.begin(), args.end(), flag) != args.end(); };
    const auto set = [](const char* variable) {
        const char* v = std::getenv(variable);
        return std::string(v ? v : "");
    };
    if (set("RIFORMAT") == "binary" && !has("-ascii") && !has("--ascii") && !has("-binary")) args.push_back("--binary");
    if (set("RICOMPRESSION") == "gzip" && !has("-gzip")) args.push_back("--gzip");
    if (const std::string server = set("RISERVER"); !server.empty() && !has("-o")) args.insert(args.end(), {"-o", server});
}

std::string oldNamesPage() {
    std::string out = "| name | here |\n|---|---|\n";
    for (const OldName& n : kOldNames)
        out += n.command.empty()
                   ? fmt::format("| `{}` | not done: {} |\n", n.name, n.instead)
                   : fmt::format("| `{}` | `alpenglow {}`{}{} |\n", n.name, n.command, n.instead.empty() ? "" : "; ", n.instead);
    for (const std::string_view command : {"maketx", "compile", "info", "rib", "ptc"})
        out += fmt::format("\nFlags that `alpenglow {}` takes in addition to its own:\n\n{}", command,
                           flagsPage(toolFlags(command)));
    return out;
}

} // namespace alpenglow::cli
