// Files of polygons: what is in them is drawn, and what is wrong with them is reported and costs no more than the file.
#include "base/limits.h"
#include "base/srgb.h"
#include "collect.h"
#include "ri/models/model.h"
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

namespace model_test {

using namespace alpenglow;
using namespace alpenglow::ri;
using scene::Class;

namespace {

struct Said {
    int errors = 0, warnings = 0;
    std::string text;
    ModelLog::Sink sink() {
        return [this](Severity s, Rie, const SourcePlace& p, const std::string& m) {
            ++(s >= Severity::Error ? errors : warnings);
            text += p.file + ":" + std::to_string(p.line) + ": " + m + "\n";
        };
    }
};

std::vector<scene::Primitive> ply(std::string_view text, Said& said) {
    ModelLog log(said.sink());
    return readPly("m.ply", text, log);
}
std::vector<scene::Primitive> obj(std::string_view text, Said& said, const std::string& mtl = "") {
    ModelLog log(said.sink());
    return readObj(
        "m.obj", text, [&](const std::string& name) { return name == "m.mtl" ? std::optional(mtl) : std::nullopt; }, log);
}
const scene::Param& var(const scene::Primitive& p, const std::string& name) {
    static const scene::Param none;
    for (const scene::Param& v : p.params)
        if (v.name == name) return v;
    ADD_FAILURE() << "no " << name;
    return none;
}
bool has(const scene::Primitive& p, const std::string& name) {
    return std::any_of(p.params.begin(), p.params.end(), [&](const scene::Param& v) { return v.name == name; });
}

/// Four corners, a quad and a triangle; properties in an order of their own, with lists and types between that nobody needs.
struct Sample {
    double v[4][9] = { // red, junk list 0..2 values below, z, y, x, nx, ny, nz, quality, t
        {255, 3, 2, 1, 0, 0, 1, .5, 0},
        {0, 3, 2, 4, 0, 0, 1, .25, 1},
        {128, 3, 5, 4, 0, 0, 1, 0, 1},
        {51, 3, 5, 1, 0, 0, 1, 1, 0}};
    std::vector<std::vector<int>> faces{{0, 1, 2, 3}, {0, 2, 3}};
    static std::string header(const std::string& format) {
        return "ply\nformat " + format +
               " 1.0\ncomment made by hand\nelement vertex 4\nproperty uchar red\nproperty list uchar short junk\n"
               "property float z\nproperty double y\nproperty float x\nproperty float nx\nproperty float ny\nproperty float nz\n"
               "property uchar green\nproperty uint8 blue\nproperty float quality\nproperty float s\nproperty float t\n"
               "element face 2\nproperty uchar kind\nproperty list uchar int vertex_indices\nelement rest 2\nproperty list "
               "ushort int8 x\nend_header\n";
    }
    std::string ascii() const {
        std::string s = header("ascii");
        for (int i = 0; i < 4; ++i) {
            s += std::to_string(int(v[i][0])) + " " + std::to_string(i % 3);
            for (int k = 0; k < i % 3; ++k) s += " -7";
            for (int k = 1; k < 7; ++k) s += " " + std::to_string(v[i][k]);
            s += " 255 0 " + std::to_string(v[i][7]) + " " + std::to_string(v[i][8]) + " .25\n";
        }
        for (auto& f : faces) {
            s += "9 " + std::to_string(f.size());
            for (int k : f) s += " " + std::to_string(k);
            s += "\n";
        }
        return s + "3 1 2 3\n0\n";
    }
    std::string binary(bool big) const {
        std::string s = header(big ? "binary_big_endian" : "binary_little_endian");
        auto put = [&](auto x) {
            char b[sizeof x];
            std::memcpy(b, &x, sizeof x);
            if (big) std::reverse(b, b + sizeof x);
            s.append(b, sizeof x);
        };
        for (int i = 0; i < 4; ++i) {
            put(uint8_t(v[i][0]));
            put(uint8_t(i % 3));
            for (int k = 0; k < i % 3; ++k) put(int16_t(-7));
            put(float(v[i][1])), put(double(v[i][2])), put(float(v[i][3]));
            for (int k = 4; k < 7; ++k) put(float(v[i][k]));
            put(uint8_t(255)), put(uint8_t(0)), put(float(v[i][7])), put(float(v[i][8])), put(.25f);
        }
        for (auto& f : faces) {
            put(uint8_t(9)), put(uint8_t(f.size()));
            for (int k : f) put(int32_t(k));
        }
        put(uint16_t(3)), put(int8_t(1)), put(int8_t(2)), put(int8_t(3)), put(uint16_t(0));
        return s;
    }
};

void expectSample(const std::vector<scene::Primitive>& parts) {
    ASSERT_EQ(parts.size(), 1u);
    const scene::Primitive& p = parts[0];
    EXPECT_EQ(p.kind, "PointsPolygons");
    EXPECT_EQ(p.ints, (std::vector<int>{4, 3}));
    EXPECT_EQ(p.ints2, (std::vector<int>{0, 1, 2, 3, 0, 2, 3}));
    EXPECT_EQ(var(p, "P").numbers, (std::vector<float>{1, 2, 3, 4, 2, 3, 4, 5, 3, 1, 5, 3}));
    EXPECT_EQ(var(p, "N").numbers, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
    const auto& Cs = var(p, "Cs");
    EXPECT_EQ(Cs.cls, Class::Vertex);
    EXPECT_FLOAT_EQ(Cs.numbers[0], 1);
    EXPECT_FLOAT_EQ(Cs.numbers[6], srgbDecode(128 / 255.f));
    EXPECT_FLOAT_EQ(Cs.numbers[9], 0.033104762f); // .2 of sRGB as light
    EXPECT_FLOAT_EQ(Cs.numbers[10], 1);
    EXPECT_EQ(var(p, "quality").numbers, (std::vector<float>{.5, .25, 0, 1}));
    EXPECT_EQ(var(p, "kind").numbers, (std::vector<float>{9, 9}));
    EXPECT_EQ(var(p, "kind").cls, Class::Uniform);
    EXPECT_EQ(var(p, "st").arrayLength, 2);
    EXPECT_EQ(var(p, "st").numbers, (std::vector<float>{0, .75, 1, .75, 1, .75, 0, .75}));
    EXPECT_FALSE(has(p, "junk"));
}

} // namespace

TEST(Ply, TextAndBothBinariesSayTheSame) {
    for (const std::string& text : {Sample().ascii(), Sample().binary(false), Sample().binary(true)}) {
        Said said;
        expectSample(ply(text, said));
        EXPECT_EQ(said.text, "");
    }
}

TEST(Ply, AnyEndIsToldAndWhatWasThereIsDrawn) {
    for (const std::string& text : {Sample().ascii(), Sample().binary(false), Sample().binary(true)})
        for (size_t n = 0; n + 3 < text.size(); ++n) {
            Said said;
            auto parts = ply(text.substr(0, n), said);
            EXPECT_GT(said.errors, 0) << n;
            for (auto& p : parts)
                for (int i : p.ints2) EXPECT_LT(size_t(i), var(p, "P").numbers.size() / 3);
        }
    Said said; // cut within the list nobody needs: all faces are there
    const std::string whole = Sample().binary(false);
    expectSample(ply(whole.substr(0, whole.size() - 4), said));
    EXPECT_EQ(said.errors, 2);
    EXPECT_NE(said.text.find("at byte " + std::to_string(whole.size() - 5)), std::string::npos) << said.text;
}

TEST(Ply, CountsOfABillionCostNothing) {
    for (const char* format : {"ascii", "binary_little_endian"})
        for (const char* count : {"1000000000", "999999999999999"}) {
            Said said;
            auto parts = ply(std::string("ply\nformat ") + format + " 1.0\nelement vertex " + count +
                                 "\nproperty float x\nproperty float y\nproperty float z\nelement face " + count +
                                 "\nproperty list int int vertex_index\nelement empty " + count + "\nend_header\n1 2 3 \n",
                             said);
            EXPECT_GT(said.errors, 0);
        }
    Said said; // and a list as long as it likes
    ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list int int vertex_index\nend_header\n1 2 3\n2000000000 1 2 3\n",
        said);
    EXPECT_NE(said.text.find("m.ply:11"), std::string::npos) << said.text;
    EXPECT_NE(said.text.find("longer than the file"), std::string::npos) << said.text;
}

TEST(Ply, FaultsHaveTheirLine) {
    const auto first = [](const std::string& text) {
        Said said;
        ply(text, said);
        EXPECT_GT(said.errors, 0) << text;
        return said.text.substr(0, said.text.find('\n'));
    };
    EXPECT_EQ(first("polygons\n"), "m.ply:1: the file is no PLY: it does not begin with \"ply\"");
    EXPECT_EQ(first("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n"), "m.ply:3: \"-1\" is no count of elements");
    EXPECT_EQ(first("ply\nformat morse 1.0\n"), "m.ply:2: format \"morse\" is not known");
    EXPECT_EQ(first("ply\nelement v 1\nproperty quad x\nend_header\n"), "m.ply:3: the type of property \"x\" is not known");
    EXPECT_EQ(first("ply\nproperty float x\n"), "m.ply:2: a property without an element");
    EXPECT_EQ(first("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
                    "z\nend_header\n1 2 3\n4 five 6\n"),
              "m.ply:9: \"five\" is no number");
}

TEST(Ply, BadVerticesTakeTheirFacesWithThem) {
    Said said;
    auto parts =
        ply("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 5\n"
            "property list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\nnan 1 0\n0 1 0\n3 0 1 3\n3 0 1 2\n3 0 1 4\n3 0 -1 "
            "1\n2 0 1\n",
            said);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].ints, std::vector<int>{3});
    EXPECT_EQ(said.errors, 2) << said.text;
    EXPECT_EQ(said.warnings, 1);
    EXPECT_NE(said.text.find("3 faces"), std::string::npos) << said.text;
}

TEST(Ply, StripsAndClouds) {
    Said said;
    auto parts =
        ply("ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n"
            "property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 4 -1\n",
            said);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].ints2, (std::vector<int>{0, 1, 2, 1, 3, 2, 2, 3, 4})); // all turn the same way
    parts = ply("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float "
                "radius\nend_header\n"
                "0 0 0 1\n1 0 0 2\n",
                said);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].kind, "Points");
    EXPECT_EQ(var(parts[0], "width").numbers, (std::vector<float>{2, 4}));
    EXPECT_EQ(said.text, "");
}

TEST(Obj, IndicesOfBothSignsAndAllForms) {
    Said said;
    auto parts = obj("# a square, four ways\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 .25\nvn 0 0 1\nf 1 2 3 4\nf -4/-2 "
                     "-3/-1 -2/1 -1/2\n"
                     "f 1//1 2//-1 \\\n 3//1\nf 1/1/1 2/2/1 3/1/1 4/2/1\ng a group\no thing\n",
                     said);
    EXPECT_EQ(said.text, "");
    ASSERT_EQ(parts.size(), 1u);
    const scene::Primitive& p = parts[0];
    EXPECT_EQ(p.ints, (std::vector<int>{4, 4, 3, 4}));
    EXPECT_EQ(p.ints2, (std::vector<int>{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 0, 1, 2, 3}));
    const auto& st = var(p, "st").numbers;
    ASSERT_EQ(st.size(), 30u);
    EXPECT_EQ((std::vector<float>(st.begin() + 8, st.begin() + 16)), (std::vector<float>{0, 1, 1, .75, 0, 1, 1, .75}));
    EXPECT_EQ(var(p, "N").numbers, ([] { // given, and that of the face where none is given
                  std::vector<float> n;
                  for (int i = 0; i < 15; ++i) n.insert(n.end(), {0, 0, 1});
                  return n;
              })());
}

TEST(Obj, MaterialsBecomeParts) {
    Said said;
    auto parts = obj("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red one\nf 1 2 3\nusemtl glass\nf 1 3 4\nusemtl "
                     "red one\nf 2 3 4\nusemtl none\nf 1 2 4\n",
                     said, "newmtl red one\nKd 1 .5 .25\nmap_Kd -s 1 1 1 a.png\nNs 10\nnewmtl glass\nd .25\nKd .5\n");
    EXPECT_EQ(said.text, "");
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].ints, (std::vector<int>{3, 3}));
    EXPECT_EQ(var(parts[0], "Cs").numbers, (std::vector<float>{1, .5, .25}));
    EXPECT_EQ(var(parts[0], "texturename").strings, std::vector<std::string>{"a.png"});
    EXPECT_EQ(var(parts[0], "material").strings, std::vector<std::string>{"red one"});
    EXPECT_EQ(var(parts[1], "Os").numbers, (std::vector<float>{.25, .25, .25}));
    EXPECT_EQ(var(parts[1], "P").numbers.size(), 9u); // its own points only
    EXPECT_EQ(var(parts[2], "material").strings, std::vector<std::string>{"none"});
}

TEST(Obj, MaterialsOfNumbersThatAreNoFloats) {
    Said said;
    const auto parts = obj("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n", said, "newmtl a\nKd 1e39 0 0\n");
    EXPECT_NE(said.text.find("Kd needs 3 numbers"), std::string::npos) << said.text;
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_FALSE(has(parts[0], "Cs"));
}

TEST(Obj, SmoothingGroupsMakeNormals) {
    Said said; // two faces that meet at a right angle in one group, and the same in none
    const std::string roof = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 1 -1\nv 1 0 -1\n";
    auto parts = obj(roof + "s 1\nf 1 2 3 4\nf 2 6 5 3\n", said);
    const auto& n = var(parts[0], "N").numbers;
    const float h = float(std::sqrt(0.5));
    EXPECT_NEAR(n[3], h, 1e-6); // corner 2: between +z and +x
    EXPECT_NEAR(n[5], h, 1e-6);
    EXPECT_NEAR(n[2], 1, 1e-6); // corner 1: the face's own
    EXPECT_FALSE(has(obj(roof + "s off\nf 1 2 3 4\nf 2 6 5 3\n", said)[0], "N"));
}

TEST(Obj, FaultsHaveTheirLineAndTheRestIsDrawn) {
    Said said;
    auto parts = obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 x 0\nv inf 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 9\nf 1 2 0\nf 1 2 -9\nf 1 2\nvn "
                     "1\ncurv 0 1\nf 1 2 99999999999999999999\n",
                     said);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].ints, std::vector<int>{3});
    for (const char* line :
         {"m.obj:4: \"x\" is no number", "m.obj:5: a vertex is not finite", "m.obj:9: \"0\" is no index", "m.obj:10: index -9",
          "m.obj:12: vn needs 3", "m.obj:13: \"curv\"", "m.obj:14: ", "2 faces use vertices", "1 faces have fewer"})
        EXPECT_NE(said.text.find(line), std::string::npos) << line << "\n" << said.text;
    Said empty;
    EXPECT_TRUE(obj("", empty).empty());
    EXPECT_EQ(empty.errors, 1);
}

TEST(Model, DamagedFilesNeitherCrashNorGrow) {
    std::mt19937 rng(1);
    const std::string seeds[] = {
        Sample().ascii(), Sample().binary(false), Sample().binary(true),
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\ns 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1\nf -1 -2 -3\n"};
    for (int k = 0; k < 4000; ++k) {
        std::string text = seeds[rng() % 4];
        for (int i = 0, n = 1 + int(rng() % 6); i < n; ++i) {
            const size_t at = rng() % text.size();
            switch (rng() % 4) {
            case 0:
                text[at] = char(rng());
                break;
            case 1:
                text.erase(at, 1 + rng() % 8);
                break;
            case 2:
                text.insert(at, text.substr(rng() % text.size(), rng() % 20));
                break;
            default:
                text[at] = "0123456789-./ \n"[rng() % 15];
            }
            if (text.empty()) text = " ";
        }
        Said said;
        ModelLog log(said.sink());
        for (auto& p : readModel(k % 2 ? "m.ply" : "m.obj", text, [&](const std::string&) { return std::optional(text); }, log)) {
            const size_t points = var(p, "P").numbers.size() / 3;
            size_t corners = 0;
            for (int n : p.ints) corners += size_t(n);
            EXPECT_EQ(corners, p.ints2.size());
            for (int i : p.ints2) EXPECT_LT(size_t(i), points);
            for (auto& v : p.params)
                for (float f : v.numbers) EXPECT_TRUE(std::isfinite(f));
        }
    }
}

class ModelFiles : public ::testing::Test {
protected:
    void SetUp() override {
        dir = std::filesystem::temp_directory_path() / ("alpenglow_models_" + std::to_string(::getpid()));
        std::filesystem::create_directories(dir / "things");
        write("things/m.ply", Sample().ascii());
        write("things/m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n");
        write("things/m.mtl", "newmtl a\nKd 1 0 0\nmap_Kd a.png\nnewmtl b\nmap_Kd ../../secret.png\n");
        write("things/a.png", "no picture");
    }
    void TearDown() override { std::filesystem::remove_all(dir); }
    void write(const std::string& name, const std::string& text) { std::ofstream(dir / name, std::ios::binary) << text; }
    std::unique_ptr<Collected> readHere(const std::string& text, const std::string& before = "") {
        write("main.rib", before + "WorldBegin\n" + text + "\nWorldEnd\n");
        auto c = std::make_unique<Collected>();
        RibReader reader({}, *c, c->diagnostics);
        c->ok = reader.readFile((dir / "main.rib").string());
        return c;
    }
    std::filesystem::path dir;
};

TEST_F(ModelFiles, AreDrawnByGeometry) {
    auto c = readHere("Geometry \"things/m.ply\"");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(c->primitive().kind, "PointsPolygons");
    c = readHere("Geometry \"ply\" \"string filename\" \"things/m.ply\" \"constant color Cs\" [1 0 0]");
    EXPECT_EQ(c->messages(), "");
    EXPECT_EQ(var(c->primitive(), "Cs").numbers, (std::vector<float>{1, 0, 0})); // the request's word counts
    c = readHere("Geometry \"m.obj\" Geometry \"m.obj\"", "Option \"searchpath\" \"archive\" \"things\"\n");
    EXPECT_EQ(c->messages(), "");
    ASSERT_EQ(c->frame().primitives.size(), 4u);
    EXPECT_EQ(var(c->primitive(), "texturename").strings[0], (dir / "things/a.png").string());
    EXPECT_EQ(var(c->primitive(1), "texturename").strings[0], "../../secret.png"); // as it was: the map's own rules hold
    EXPECT_EQ(readHere("Geometry \"none.ply\"")->only().code, Rie::NoFile);
    EXPECT_EQ(readHere("Geometry \"obj\"")->only().code, Rie::MissingData);
}

TEST(Model, FilesHaveTheirLimits) {
    Said said;
    std::string header = "ply\nformat ascii 1.0\nelement vertex 1\n";
    for (int i = 0; i <= limits::kModelProperties; ++i) header += "property float p" + std::to_string(i) + "\n";
    EXPECT_TRUE(ply(header + "end_header\n0\n", said).empty());
    EXPECT_EQ(said.errors, 1) << said.text;

    Said many;
    std::string faulty = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < limits::kModelMessages + 5; ++i) faulty += "f 1 a 3\n";
    obj(faulty, many);
    EXPECT_EQ(many.errors + many.warnings, limits::kModelMessages + 1) << many.text; // the last counts the others
    EXPECT_NE(many.text.find("5 more faults"), std::string::npos) << many.text;
}

TEST_F(ModelFiles, AreSoLargeAtMost) {
    const std::string path = (dir / "large.ply").string();
    std::ofstream(path) << "ply\n";
    std::error_code full;
    std::filesystem::resize_file(path, limits::kModelBytes + 1, full); // a hole
    if (full) GTEST_SKIP() << "this file system has no files of 16 GiB, not even with a hole";
    Said said;
    EXPECT_TRUE(readModelFile(path, said.sink(), nullptr).empty());
    EXPECT_EQ(said.errors, 1) << said.text;
}

} // namespace model_test
