// What is fuzzed: where the seeds come from, how inputs are made, what is run.
#include "targets.h"
#include "mutate.h"
#include "ri/requests/request.h"
#include "shadeops/descriptor.h"
#include "worker.h"
#include <algorithm>
#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;

namespace alpenglow::fuzz {
namespace {

std::vector<std::string> ribWords() {
    std::vector<std::string> words = ri::requestNames();
    for (const char* w : {"[",
                          "]",
                          "\"",
                          "[1 2 3]",
                          "[ ]",
                          "\"P\"",
                          "\"Pw\"",
                          "\"st\"",
                          "\"varying float x\"",
                          "\"uniform string[2] names\"",
                          "\"vertex\"",
                          "#",
                          "##",
                          "\n",
                          "\\",
                          "0",
                          "-1",
                          "1e38",
                          "ReadArchive \"s.rib\"",
                          "WorldEnd",
                          "WorldBegin",
                          "\"\\0\"",
                          "[1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]",
                          "[0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]",
                          "\"texture\"",
                          "\"a.tx\""})
        words.push_back(w);
    return words;
}

std::vector<std::string> slWords() {
    std::vector<std::string> words;
    for (const shadeops::Shadeop& s : shadeops::allShadeops()) words.push_back(s.name);
    for (const char* w : {"(",          ")",         "{",        "}",         ";",
                          ",",          "=",         "+=",       "[",         "]",
                          "\"",         ".",         "^",        "?",         ":",
                          "->",         "::",        "!",        "||",        "&&",
                          "<",          "==",        "/*",       "*/",        "//",
                          "#",          "##",        "\\\n",     "#define A", "#include \"x.h\"",
                          "#if",        "#endif",    "surface",  "light",     "displacement",
                          "volume",     "imager",    "class",    "struct",    "public",
                          "float",      "color",     "point",    "vector",    "normal",
                          "matrix",     "string",    "void",     "shader",    "uniform",
                          "varying",    "output",    "extern",   "return",    "break",
                          "continue 2", "if",        "else",     "for",       "illuminance",
                          "illuminate", "solar",     "gather",   "P",         "N",
                          "I",          "Cs",        "Ci",       "Oi",        "L",
                          "Cl",         "s",         "t",        "u",         "v",
                          "a[3]",       "float a[]", "float[4]", "null",      "this",
                          "\"world\"",  "1e999",     "0x10",     "1e",        "16384"})
        words.push_back(w);
    return words;
}

Seeds examplesOfShadeops() {
    Seeds all;
    for (const shadeops::Shadeop& s : shadeops::allShadeops())
        for (const shadeops::Example& e : s.examples)
            if (e.setup.empty()) all.push_back(e.expression);
    return all;
}

Seeds linesOf(const std::string& file) {
    Seeds lines;
    const Bytes text = contentsOf(source(file));
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find('\n', at), text.size());
        if (end > at && text[at] != '#') lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

Seeds shaders() {
    Seeds all = filesOf(source("shaders"), {".sl"});
    for (const Bytes& b : filesOf(source("examples/shaders"), {".sl"})) all.push_back(b);
    return all;
}

/// Every request with the arguments that the table says are right, a few in a scene.
Seeds scenes() {
    Seeds all = filesOf(source("examples"), {".rib"});
    Bytes text;
    int n = 0;
    for (const ri::Request& r : ri::requestTable()) {
        text += std::string(r.name) + " " + std::string(r.sample) + "\n";
        if (++n % 6 == 0)
            all.push_back("Projection \"perspective\"\nTranslate 0 0 5\nWorldBegin\n" + text + "Sphere 1 -1 1 360\nWorldEnd\n"),
                text.clear();
    }
    return all;
}

// Making inputs.

using Input = std::function<Bytes(Random&, const Seeds&)>;

Input text(std::vector<std::string> (*words)()) {
    return [words](Random& r, const Seeds& seeds) {
        static thread_local std::vector<std::string> list;
        static thread_local std::vector<std::string> (*of)() = nullptr;
        if (of != words) list = words(), of = words;
        return r.once(8) ? mutateBytes(r, r.of(seeds), seeds) : mutateText(r, r.of(seeds), seeds, list);
    };
}

Bytes anyBytes(Random& r, const Seeds& seeds) { return mutateBytes(r, r.of(seeds), seeds); }
Bytes mendedBytes(Random& r, const Seeds& seeds) {
    Bytes b = anyBytes(r, seeds);
    return r.once(5) ? b : repaired(std::move(b));
}

Bytes summedBytes(Random& r, const Seeds& seeds) {
    Bytes b = anyBytes(r, seeds);
    return r.once(5) ? b : summed(std::move(b));
}
Seeds mapsOf(void (*make)(), const std::vector<std::string>& extensions) { return madeInChild(make, extensions); }

/// A small model of each form, and what may stand in their texts.
Seeds models() {
    Bytes vertices;
    for (const float f : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
        vertices.append(reinterpret_cast<const char*>(&f), 4);
    const Bytes header = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                         "property list uchar int vertex_indices\nend_header\n";
    const char face[] = {4, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0};
    return {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
            "red\nproperty uchar green\n"
            "property uchar blue\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float "
            "t\nelement face 1\n"
            "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n0 0 0 255 0 0 0 0 1 0 0\n1 "
            "0 0 0 9 0 0 0 1 1 0\n"
            "0 1 0 1 2 3 0 0 1 0 1\n3 0 1 2 6 0 0 1 0 0 1\n",
            "ply\nformat binary_little_endian 1.0\n" + header + vertices + Bytes(face, sizeof face),
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n"
            "property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2 -1\n",
            "mtllib m.mtl\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\ns 1\nusemtl a b\nf 1/1/1 2/2/1 "
            "3/1/1\ns off\nusemtl c\n"
            "f -1//-1 -2 \\\n -3/2\nnewmtl c\nKd 1 0 0\nd .5\nmap_Kd a.tx\n"};
}

std::vector<std::string> modelWords() {
    return {"ply",
            "format",
            "ascii",
            "binary_big_endian",
            "binary_little_endian",
            "1.0",
            "element",
            "vertex",
            "face",
            "tristrips",
            "property",
            "list",
            "uchar",
            "int",
            "float",
            "double",
            "int64",
            "x",
            "y",
            "z",
            "nx",
            "red",
            "alpha",
            "s",
            "t",
            "radius",
            "vertex_indices",
            "texcoord",
            "end_header",
            "comment",
            "1000000000",
            "999999999999999",
            "-1",
            "nan",
            "inf",
            "1e39",
            "0",
            "4",
            "v",
            "vt",
            "vn",
            "f",
            "usemtl",
            "mtllib",
            "m.mtl",
            "s",
            "off",
            "g",
            "o",
            "-9",
            "2147483648",
            "1/1/1",
            "1//1",
            "/",
            "newmtl",
            "Kd",
            "d",
            "Tr",
            "map_Kd",
            "\n",
            "\\\n",
            "#",
            "p",
            "l",
            "curv"};
}

Bytes anyBinaryRib(Random& r, const Seeds& seeds) {
    const Bytes b = binaryRib(r, r.once(2) ? generateRib(r) : r.of(seeds));
    return r.once(4) ? b : mutateBytes(r, b, {b});
}

Bytes anyGzip(Random& r, const Seeds& seeds) {
    if (r.once(3)) return gzipped(mutateBytes(r, r.of(seeds), seeds));
    const Bytes b = gzipped(r.of(seeds));
    return mutateBytes(r, b, {b});
}

Bytes anySession(Random& r, const Seeds& seeds) {
    if (r.once(5)) return anyBytes(r, seeds);
    static const std::vector<std::string> words{"{",
                                                "}",
                                                "[",
                                                "]",
                                                ":",
                                                ",",
                                                "null",
                                                "true",
                                                "-1",
                                                "1e99",
                                                "\"\"",
                                                "\"id\"",
                                                "\"method\"",
                                                "\"params\"",
                                                "\"textDocument\"",
                                                "\"position\"",
                                                "\"uri\"",
                                                "\"text\"",
                                                "\"range\"",
                                                "\"line\"",
                                                "\"character\"",
                                                "\"contentChanges\"",
                                                "\"exit\"",
                                                "\"shutdown\"",
                                                "\"textDocument/didChange\"",
                                                "\"textDocument/completion\"",
                                                "\"textDocument/hover\"",
                                                "\"textDocument/definition\"",
                                                "\"textDocument/codeAction\"",
                                                "\"textDocument/signatureHelp\"",
                                                "4294967296",
                                                "\\u0000",
                                                "\\ud800",
                                                "\"$/cancelRequest\""};
    std::vector<std::string> m = messagesOf(r.of(seeds));
    for (size_t i = 0, n = 1 + r.below(4); i < n && !m.empty(); ++i) {
        const size_t at = r.below(m.size());
        if (r.once(6)) m.erase(m.begin() + std::ptrdiff_t(at));
        else if (r.once(6)) m.insert(m.begin() + std::ptrdiff_t(r.below(m.size())), m[at]);
        else m[at] = mutateText(r, m[at], {m[at]}, words);
    }
    return framed(m);
}

namespace {

/// Words of command lines: commands, options and their values.
constexpr const char* kOptionWords[] = {"render",
                                        "eval",
                                        "shade",
                                        "compile",
                                        "info",
                                        "probe",
                                        "maketx",
                                        "diff",
                                        "merge",
                                        "-o",
                                        "--format",
                                        "--crop",
                                        "--hider",
                                        "path",
                                        "hidden",
                                        "--spp",
                                        "--noise",
                                        "--samples",
                                        "0:2",
                                        "--seed",
                                        "--max-depth",
                                        "--sample-clamp",
                                        "--threads",
                                        "--lanes",
                                        "--resolution-factor",
                                        "--gamma",
                                        "--frames",
                                        "1,4-6",
                                        "--pixel",
                                        "2,1",
                                        "--rib",
                                        "--display",
                                        "png:view.png",
                                        "--stats",
                                        "o.json",
                                        "--checkpoint",
                                        "c.part",
                                        "--resume",
                                        "--preset",
                                        "slproject",
                                        "--progress",
                                        "none",
                                        "-q",
                                        "-v",
                                        "--param",
                                        "Kd=0.5",
                                        "--output",
                                        "Ci",
                                        "--json",
                                        "-W",
                                        "--dump-ir",
                                        "--path",
                                        "--mixed",
                                        "--suspend",
                                        "--shadeops",
                                        "noise",
                                        "--markdown",
                                        "-mode",
                                        "clamp",
                                        "--width",
                                        "--fov",
                                        "-envlatl",
                                        "--shadow",
                                        "--tolerance",
                                        "p.rib",
                                        "z.sl",
                                        "a.tx",
                                        "o.exr",
                                        "o.png",
                                        "8x6",
                                        "0,1,0,1",
                                        "1",
                                        "0",
                                        "-1",
                                        "1e9",
                                        "",
                                        "nan",
                                        "-",
                                        "--",
                                        "=",
                                        "--help",
                                        "--version",
                                        "--dialect",
                                        "prman",
                                        "-D",
                                        "A=1",
                                        "--kind",
                                        "surface",
                                        "--iterations",
                                        "4",
                                        "--setup",
                                        "float"};

} // namespace

std::vector<std::string> optionWords() { return {std::begin(kOptionWords), std::end(kOptionWords)}; }

} // namespace

std::vector<Target> allTargets() {
    const auto none = [] { return Seeds(); };
    const auto pictures = [] {
        Seeds s = filesOf(source("tests/fuzz/corpus/images"), {});
        for (Bytes& b : madeInChild(makePictures, {".tif", ".exr", ".png", ".tx", ".shd"})) s.push_back(std::move(b));
        return s;
    };
    const Input sl = text(slWords), rib = text(ribWords);
    return {
        {"rib-ascii", "the RIB reader: text", ".rib", 1, false, scenes, rib, readRib},
        {"rib-binary", "the RIB reader: the binary encoding", ".rib", 1, false, scenes, anyBinaryRib, readRib},
        {"rib-gzip", "the RIB reader: compressed streams", ".rib", 1, false, scenes, anyGzip, readRib},
        {"rib-generated", "the RIB reader: random requests", ".rib", 1, false, scenes,
         [](Random& r, const Seeds&) { return generateRib(r); }, readRib},
        {"models", "the readers of .ply and .obj", ".ply", 1, false, models, text(modelWords), readModelFile},
        {"rib-render", "tiny renders of damaged scenes", ".rib", 4, true, scenes, rib, renderRib, true},
        {"rib-requests", "tiny renders of random requests", ".rib", 4, true, none,
         [](Random& r, const Seeds&) { return generateRib(r); }, renderRib, true},
        {"sl-preprocess", "the preprocessor", ".sl", 1, false, none, sl, checkShader},
        {"sl-check", "parser and checker", ".sl", 1, false, shaders, sl, checkShader},
        {"sl-shade", "damaged shaders, compiled and run", ".sl", 20, true, shaders, sl, shadeShader},
        {"sl-generated", "made shaders at three widths of the machine code", ".sl", 40, true, none,
         [](Random& r, const Seeds&) { return generateShader(r); }, shadeInWidths},
        {"sl-render", "damaged shaders in a scene", ".sl", 25, true, shaders, sl, renderShader},
        {"eval", "damaged and made expressions at two widths", ".txt", 20, true,
         [] {
             Seeds s = linesOf("tests/fuzz/corpus/expressions.txt");
             for (const Bytes& e : examplesOfShadeops()) s.push_back(e);
             return s;
         },
         [sl](Random& r, const Seeds& seeds) {
             static const char* const types[] = {"float", "color", "point", "vector", "string", "matrix"};
             return r.once(2) ? generateExpression(r, r.of(types), 3) : sl(r, seeds);
         },
         evaluate},
        {"pictures", "all decoders; maps and lookups", ".tx", 1, false, pictures, mendedBytes, decodePicture},
        {"picture-files", "diff, maketx and scenes with damaged pictures", ".tx", 2, false, pictures, mendedBytes, usePicture,
         true},
        {"clouds", "point clouds, of ours and PLY; lookups", ".ptc", 1, false,
         [] { return mapsOf(makeClouds, {".ptc", ".ply"}); }, summedBytes, readCloud},
        {"bricks", "brick maps and lookups", ".bkm", 1, false, [] { return mapsOf(makeClouds, {".bkm"}); }, summedBytes,
         readCloud},
        {"baked", "what bake() writes", ".bake", 1, false, [] { return mapsOf(makeClouds, {".bake"}); }, summedBytes, readBaked},
        {"photon-maps", "photon maps in files", ".photons", 1, false, [] { return mapsOf(makeClouds, {".photons"}); },
         summedBytes, readPhotons},
        {"ptex", "Ptex files and lookups", ".ptx", 1, false, [] { return mapsOf(makePtexFiles, {".ptx"}); }, anyBytes, readPtex},
        {"deep-maps", "deep shadow maps", ".dsm", 1, false, [] { return mapsOf(makeDeepMaps, {".dsm"}); }, mendedBytes,
         decodePicture},
        {"parts", "merge and --resume with damaged part files", ".part", 4, false,
         [] { return madeInChild(makeParts, {".part"}); }, mendedBytes, usePart, true},
        {"lsp", "sessions of the language server", ".lsp", 2, false,
         [] {
             Seeds s;
             for (const Bytes& b : filesOf(source("tests/fuzz/corpus/sessions"), {".jsonl"})) {
                 std::vector<std::string> lines;
                 for (size_t at = 0; at < b.size();) {
                     const size_t end = std::min(b.find('\n', at), b.size());
                     lines.push_back(b.substr(at, end - at));
                     at = end + 1;
                 }
                 s.push_back(framed(lines));
             }
             return s;
         },
         anySession, serveEditor},
        {"command-line", "arguments", ".txt", 4, true, [] { return linesOf("tests/fuzz/corpus/commands.txt"); },
         text(optionWords), commandLine, true}};
}

Seeds seedsOf(const Target& t) {
    Seeds all = filesOf(source("tests/fuzz/corpus/" + t.name), {});
    for (Bytes& b : t.seeds()) all.push_back(std::move(b));
    return all;
}

Bytes contentsOf(const std::string& path) {
    std::ifstream f(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(f), {}};
}

Seeds filesOf(const std::string& folder, const std::vector<std::string>& extensions, size_t most) {
    std::vector<std::string> names;
    std::error_code e;
    for (const auto& f : fs::recursive_directory_iterator(folder, e))
        if (f.is_regular_file() && f.file_size() <= most &&
            (extensions.empty() || std::find(extensions.begin(), extensions.end(), f.path().extension()) != extensions.end()))
            names.push_back(f.path().string());
    std::sort(names.begin(), names.end());
    Seeds all;
    for (const std::string& n : names) all.push_back(contentsOf(n));
    return all;
}

std::string source(const std::string& relative) { return std::string(ALPENGLOW_SOURCE_DIR) + "/" + relative; }

} // namespace alpenglow::fuzz
