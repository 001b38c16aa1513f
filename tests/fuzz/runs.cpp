// What is run with an input.
#include "display/imageio.h"
#include "program.h"
#include "ri/models/model.h"
#include "ri/reader.h"
#include "rsl/front/ast.h"
#include "scene/scene.h"
#include "targets.h"
#include "texture/texture.h"
#include "worker.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fcntl.h>
#include <unistd.h>

namespace alpenglow::fuzz {
namespace {

Outcome outcomeOf(int status) {
    static const int documented[] = {0, 1, 2, 3, 4, 5, 130};
    if (std::find(std::begin(documented), std::end(documented), status) == std::end(documented)) return Outcome::Status;
    if (status == 0) return Outcome::Ok;
    return saidAnything() ? Outcome::Refused : Outcome::Mute;
}

/// A choice that depends on nothing but the input.
size_t choice(const Bytes& b, size_t n) {
    uint64_t h = 1469598103934665603u;
    for (char c : b) h = (h ^ uint8_t(c)) * 1099511628211u;
    return size_t(Random(h).below(n));
}

struct NoPictures : scene::FrameConsumer {
    void render(std::shared_ptr<const scene::Frame>) override {}
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

} // namespace

Outcome readRib(const Bytes& b) {
    Diagnostics d;
    NoPictures consumer;
    ri::RibReader reader({}, consumer, d);
    const bool good = reader.readMemory(b, "s.rib");
    return good ? Outcome::Ok : d.errors() ? Outcome::Refused : Outcome::Mute;
}

Outcome readModelFile(const Bytes& b) {
    int said = 0;
    bool fits = true;
    {
        ri::ModelLog log([&](Severity, Rie, const SourcePlace&, const std::string&) { ++said; });
        const std::string name = b.empty() || b[0] == 'p' ? "m.ply" : "m.obj";
        for (const scene::Primitive& p :
             ri::readModel(name, b, [&](const std::string&) { return std::optional<std::string>(b); }, log)) {
            const scene::Param* P = scene::find(p.params, "P");
            size_t corners = 0;
            for (int n : p.ints) corners += size_t(n);
            fits = fits && P && (p.kind == "Points" || corners == p.ints2.size());
            for (int i : p.ints2) fits = fits && i >= 0 && size_t(i) < P->numbers.size() / 3;
            for (const scene::Param& v : p.params)
                for (float f : v.numbers) fits = fits && std::isfinite(f);
        }
    }
    return !fits ? Outcome::Differs : said ? Outcome::Refused : Outcome::Ok;
}

Outcome renderRib(const Bytes& b) {
    putMaps();
    putFile("s.rib", b);
    std::vector<std::string> a{"render", "--progress", "none", "--threads",   "2", "--format",
                               "8x6",    "--spp",      "1",    "--max-depth", "4"};
    if (choice(b, 3) == 0) a.insert(a.end(), {"--hider", "path"});
    a.push_back("s.rib");
    return outcomeOf(program(a));
}

Outcome checkShader(const Bytes& b) {
    Diagnostics d;
    rsl::FrontOptions o;
    o.includePaths = {source("shaders/include")};
    const auto p = rsl::compileText(b, "z.sl", o, d);
    return p ? Outcome::Ok : d.errors() ? Outcome::Refused : Outcome::Mute;
}

Outcome shadeShader(const Bytes& b) {
    putMaps();
    putFile("z.sl", b);
    return outcomeOf(program({"shade", "--patch", "--format", "6x4", "-o", "o.exr", "z.sl"}));
}

/// The widths of the machine code must not show.
Outcome shadeInWidths(const Bytes& b) {
    putMaps();
    putFile("z.sl", b);
    std::array<Bytes, 3> pictures;
    int status = 0;
    for (size_t i = 0; i < 3; ++i) {
        status = program({"shade", "--patch", "--format", "6x4", "-o", "o.exr", "--lanes", std::to_string(4 << i), "z.sl"});
        if (status > 1) break;
        pictures[i] = contentsOf("o.exr");
    }
    return pictures[0] == pictures[1] && pictures[0] == pictures[2] ? outcomeOf(status)
           : status > 1                                             ? outcomeOf(status)
                                                                    : Outcome::Differs;
}

Outcome renderShader(const Bytes& b) {
    putMaps();
    putFile("z.sl", b);
    const auto has = [&](const char* word) { return b.find(word) != Bytes::npos; };
    std::string s = "Format 8 6 1\nPixelSamples 1 1\nShadingRate 8\nDisplay \"o.exr\" \"openexr\" \"rgba\"\nProjection "
                    "\"perspective\" \"fov\" 40\n";
    if (has("imager")) s += "Imager \"z\"\n";
    s += "Translate 0 0 4\nWorldBegin\nLightSource \"pointlight\" 1 \"intensity\" 9 \"from\" [2 2 -3]\n";
    if (has("light ")) s += "LightSource \"z\" 2\nAttributeBegin\nAreaLightSource \"z\" 3\nDisk 2 .2 360\nAttributeEnd\n";
    if (has("volume")) s += "Atmosphere \"z\"\nInterior \"z\"\n";
    if (has("displacement")) s += "Displacement \"z\"\nAttribute \"displacementbound\" \"sphere\" [.2]\n";
    s += has("surface") ? "Surface \"z\"\n" : "Surface \"plastic\"\n";
    s += "Sphere 1 -1 1 360\nTranslate .5 0 .7\nPolygon \"P\" [-1 -1 0 -1 1 0 1 1 0 1 -1 0] \"st\" [0 0 0 1 1 1 1 0]\nWorldEnd\n";
    putFile("s.rib", s);
    std::vector<std::string> a{"render", "--progress", "none", "--threads", "2", "--max-depth", "3", "s.rib"};
    if (choice(b, 2)) a.insert(a.begin() + 1, {"--hider", "path", "--spp", "1"});
    return outcomeOf(program(a));
}

Outcome evaluate(const Bytes& b) {
    if (b.empty() || b[0] == '-' || b.find('\0') != Bytes::npos) return Outcome::Ok; // no command line
    clearOutput();
    int status = program({"eval", "--lanes", "4", b});
    const Bytes narrow = outputSoFar();
    clearOutput();
    if (program({"eval", "--lanes", "16", b}) != status || outputSoFar() != narrow) return Outcome::Differs;
    return outcomeOf(status);
}

Outcome decodePicture(const Bytes& b) {
    Diagnostics d;
    display::ReadOptions o;
    o.levels = true;
    auto m = display::decodeImage({reinterpret_cast<const uint8_t*>(b.data()), b.size()}, "x.tx", d, o);
    if (!m) return d.errors() ? Outcome::Refused : Outcome::Mute;
    if (m->data.size() != m->sampleCount()) return Outcome::Status;
    if (m->sampleCount() > (1u << 20)) return Outcome::Ok;
    const auto map = texture::makeTextureFrom(*m);
    float v[64] = {};
    for (float x : {0.1f, 0.9f, -3.0f, INFINITY}) {
        texture::lookup2D(map.get(), 0, std::min(60, m->channelCount()), x, 1 - x, 0.1f, 0, 0, 0.3f, {}, v);
        texture::environment(map.get(), {}, 0, 1, Vec3(x, 1, .2f), Vec3(), Vec3(), {}, v);
    }
    return Outcome::Ok;
}

Outcome usePicture(const Bytes& b) {
    putMaps();
    putFile("x.tx", b);
    switch (choice(b, 6)) {
    case 0:
        return outcomeOf(program({"diff", "x.tx", "a.tx", "-o", "o.png"}));
    case 1:
        return outcomeOf(program({"maketx", "--mode", "periodic", "--filter", "gaussian", "x.tx", "o.exr"}));
    case 2:
        return outcomeOf(program({"maketx", "--shadow", "x.tx", "o.exr"}));
    case 3:
        return outcomeOf(program({"maketx", "--envcube", "x.tx", "x.tx", "x.tx", "a.tx", "x.tx", "x.tx", "o.exr"}));
    case 4:
        return outcomeOf(program({"maketx", "--envlatl", "x.tx", "o.exr"}));
    default:
        break;
    }
    putFile("z.sl",
            "surface z() { uniform float r[2] = {0, 0}; matrix m = 1; textureinfo(\"x.tx\", \"resolution\", r); "
            "textureinfo(\"x.tx\", \"viewingmatrix\", m);\n"
            "Ci = texture(\"x.tx\") + environment(\"x.tx\", N) + shadow(\"x.tx\", P) + r[0] + comp(m, 0, 0); Oi = 1; }\n");
    putFile("s.rib",
            "Format 6 4 1\nDisplay \"o.exr\" \"openexr\" \"rgb\"\nTranslate 0 0 3\nWorldBegin\nSurface \"z\"\nSphere 1 -1 1 "
            "360\nWorldEnd\n");
    return outcomeOf(program({"render", "--progress", "none", "--threads", "2", "s.rib"}));
}

Outcome usePart(const Bytes& b) {
    putFile("x.part", b);
    putFile("p.rib", partScene);
    if (choice(b, 3)) return outcomeOf(program({"merge", "x.part", "-o", "o.exr"}));
    return outcomeOf(program({"render", "--progress", "none", "--threads", "2", "--hider", "path", "--spp", "4", "--checkpoint",
                              "x.part", "--resume", "p.rib"}));
}

Outcome serveEditor(const Bytes& b) {
    putFile("in", b);
    const int in = open("in", O_RDONLY), old = dup(0);
    dup2(in, 0);
    close(in);
    const int status = program({"lsp"});
    dup2(old, 0);
    close(old);
    return status == 0 || status == 1 ? Outcome::Ok : outcomeOf(status);
}

Outcome commandLine(const Bytes& b) {
    std::vector<std::string> arguments;
    for (size_t at = 0; at < b.size();) {
        const size_t end = std::min(b.find(' ', at), b.size());
        const std::string a = b.substr(at, end - at);
        // What the user names is written, run, or waited for: nothing outside of the folder here.
        if (!a.empty() && a.find('/') == std::string::npos && a.find("..") == std::string::npos &&
            a.find('\0') == std::string::npos && a.find("watch") == std::string::npos && a.find("allow") == std::string::npos)
            arguments.push_back(a);
        at = end + 1;
    }
    putMaps();
    putFile("p.rib", partScene);
    putFile("z.sl", "surface z(float Kd = 1) { Ci = Kd * Cs; Oi = Os; }\n");
    return outcomeOf(program(arguments));
}

} // namespace alpenglow::fuzz
