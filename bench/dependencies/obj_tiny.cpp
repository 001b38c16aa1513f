// tinyobjloader as the reader of .obj beside ours (src/ri/models/obj.cpp).
//   obj_tiny                      what it makes of lines that our tests have
//   obj_tiny damaged SEED COUNT   of damaged files (build it with AddressSanitizer, too)
//   obj_tiny read FILE            time and memory of a large file; `ours` instead of `read`: of our reader
#include "ri/models/model.h"
#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <sys/resource.h>
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

namespace {

struct Materials : tinyobj::MaterialReader {
    explicit Materials(std::string t) : text(std::move(t)) {}
    bool operator()(const std::string&, std::vector<tinyobj::material_t>* materials, std::map<std::string, int>* names,
                    std::string* warning, std::string* error) override {
        std::istringstream in(text);
        tinyobj::LoadMtl(names, materials, &in, warning, error);
        return true;
    }
    std::string text;
};

struct Result {
    bool good = false;
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::string warning, error;
};

Result load(std::istream& in, const std::string& materials) {
    Result r;
    std::vector<tinyobj::material_t> all;
    Materials reader(materials);
    r.good = tinyobj::LoadObj(&r.attributes, &r.shapes, &all, &r.warning, &r.error, &in, &reader, false, true);
    return r;
}

void show(const char* what, const std::string& text, const std::string& materials = "") {
    std::istringstream in(text);
    const Result r = load(in, materials);
    size_t faces = 0, corners = 0, beyond = 0;
    for (const tinyobj::shape_t& s : r.shapes) {
        faces += s.mesh.num_face_vertices.size();
        for (unsigned n : s.mesh.num_face_vertices) corners += n;
        for (const tinyobj::index_t& i : s.mesh.indices)
            beyond += i.vertex_index < 0 || size_t(i.vertex_index) >= r.attributes.vertices.size() / 3;
    }
    std::string said = r.warning + r.error;
    for (char& c : said)
        if (c == '\n') c = ' ';
    std::printf("%-30s %s, %zu faces of %zu corners, %zu beyond the vertices  %s\n", what, r.good ? "read" : "refused", faces,
                corners, beyond, said.c_str());
}

void lines() {
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    show("a square", square + "f 1 2 3 4\n");
    show("indices from the end", square + "f -4 -3 -2 -1\n");
    show("an index of 0 in one face", square + "f 1 2 3\nf 1 2 0\nf 2 3 4\n");
    show("an index too large", square + "f 1 2 3\nf 1 2 9\n");
    show("an index before the first", square + "f 1 2 3\nf 1 2 -9\n");
    show("an index of twenty digits", square + "f 1 2 99999999999999999999\n");
    show("a coordinate \"x\"", square + "v 1 x 0\nf 1 2 5\n");
    show("a coordinate \"inf\"", square + "v inf 0 0\nf 1 2 5\n");
    show("a line continued by \\", square + "f 1 2 \\\n 3 4\n");
    show("a material with a blank", "mtllib m\n" + square + "usemtl red one\nf 1 2 3\n", "newmtl red one\nKd 1 0 0\n");
    std::string polygon, face = "f";
    for (int i = 1; i <= 300; ++i) polygon += "v " + std::to_string(i) + " 0 0\n", face += " " + std::to_string(i);
    show("a face of 300 corners", polygon + face + "\n");
}

void damaged(unsigned seed, int count) {
    std::mt19937 random(seed);
    const std::string whole = "mtllib m.mtl\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\ns 1\nusemtl a\n"
                              "f 1/1/1 2/1/1 3/1/1\nf -1 -2 -3\n";
    int read = 0, beyond = 0;
    for (int k = 0; k < count; ++k) {
        std::string text = whole;
        for (unsigned n = 1 + random() % 6; n > 0 && !text.empty(); --n) {
            const size_t at = random() % text.size();
            if (random() % 2) text[at] = "0123456789-./ \n"[random() % 15];
            else if (random() % 2) text[at] = char(random());
            else text.erase(at, 1 + random() % 8);
        }
        std::istringstream in(text);
        const Result r = load(in, text);
        read += r.good;
        bool bad = false;
        for (const tinyobj::shape_t& s : r.shapes)
            for (const tinyobj::index_t& i : s.mesh.indices)
                bad |= i.vertex_index < 0 || size_t(i.vertex_index) >= r.attributes.vertices.size() / 3;
        beyond += bad;
    }
    std::printf("%d damaged files: %d read, %d of these with faces beyond the vertices\n", count, read, beyond);
}

size_t facesOf(const std::string& file, bool ours) {
    if (ours) {
        using namespace alpenglow;
        const auto parts = ri::readModelFile(file, [](Severity, Rie, const SourcePlace&, std::string) {}, nullptr);
        return parts.empty() ? 0 : parts[0].ints.size();
    }
    std::ifstream in(file);
    const Result r = load(in, "");
    return r.shapes.empty() ? 0 : r.shapes[0].mesh.num_face_vertices.size();
}

} // namespace

int main(int argc, char** argv) {
    if (argc > 3 && !std::strcmp(argv[1], "damaged")) return damaged(unsigned(std::atoi(argv[2])), std::atoi(argv[3])), 0;
    if (argc < 3) return lines(), 0;
    const size_t faces = facesOf(argv[2], !std::strcmp(argv[1], "ours"));
    rusage r{};
    getrusage(RUSAGE_SELF, &r);
    std::printf("%-5s %zu faces: %.2f s of CPU, %ld MiB\n", argv[1], faces,
                double(r.ru_utime.tv_sec + r.ru_stime.tv_sec) + 1e-6 * double(r.ru_utime.tv_usec + r.ru_stime.tv_usec),
                r.ru_maxrss / 1024);
}
