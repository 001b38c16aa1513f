// The include table of docs/architecture.md, checked: nothing lower knows anything higher, and foreign headers stay behind one
// door.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace folders_test {

namespace fs = std::filesystem;

namespace {

// Folder -> folders it may include besides itself. "rsl" is one folder to the outside; inside it front < ir, passes < jit.
const std::map<std::string, std::set<std::string>> kAllowed = {
    {"base", {}},
    {"shadeops", {"base"}},
    {"rsl", {"base", "shadeops"}},
    {"scene", {"base"}},
    {"ri", {"base", "scene"}},
    {"geometry", {"base", "scene"}},
    {"accel", {"base", "scene", "geometry", "shadeops"}},
    {"texture", {"base", "display", "pointcloud"}},
    {"display", {"base", "scene"}},
    {"shading", {"base", "scene", "geometry", "accel", "rsl", "shadeops", "texture"}},
    {"bsdf", {"base", "shadeops"}},
    {"lanes", {"base", "shadeops", "bsdf"}},
    {"photonmap", {"base"}},
    {"ptex", {"base"}},
    {"pointcloud", {"base"}},
    {"models", {"base"}},
    {"world",
     {"base", "scene", "geometry", "accel", "rsl", "shadeops", "texture", "shading", "bsdf", "lanes", "pointcloud", "photonmap",
      "ptex"}},
    {"services",
     {"base", "scene", "geometry", "accel", "rsl", "shadeops", "texture", "shading", "bsdf", "lanes", "pointcloud", "photonmap",
      "ptex", "world"}},
    {"integrator",
     {"base", "scene", "geometry", "accel", "rsl", "shadeops", "texture", "shading", "bsdf", "lanes", "pointcloud", "photonmap",
      "ptex", "world", "services"}},
    {"render",
     {"base", "scene", "geometry", "accel", "rsl", "shadeops", "texture", "shading", "pointcloud", "photonmap", "world",
      "integrator", "display"}},
    {"cli",
     {"base",      "scene", "geometry", "accel",    "rsl",        "shadeops", "texture", "shading", "bsdf", "lanes", "pointcloud",
      "photonmap", "ptex",  "world",    "services", "integrator", "display",  "render",  "ri",      "view", "models"}},
    {"capi", {"base", "scene", "display", "integrator", "render", "ri", "cli"}},
    {"python", {"base", "scene", "rsl", "world", "services", "display", "render", "ri", "cli"}},
    {"view",
     {"base", "scene", "geometry", "accel", "rsl", "shadeops", "texture", "shading", "pointcloud", "photonmap", "world",
      "integrator", "display", "render", "ri"}},
};

// Header prefix -> the only folders that may include it.
const std::map<std::string, std::set<std::string>> kForeign = {
    {"llvm", {"rsl/jit"}},        {"llvm-c", {"rsl/jit"}},    {"embree3", {}},          {"OpenImageIO", {"texture"}},
    {"opensubdiv", {"geometry"}}, {"OpenEXR", {"display"}},   {"png.h", {"display"}},   {"tiffio.h", {"display"}},
    {"jpeglib.h", {"display"}},   {"CLI", {"cli", "python"}}, {"pybind11", {"python"}}, {"boost", {"view"}},
    {"xxhash.h", {"base"}},       {"Imath", {"base"}},        {"assimp", {"models"}},   {"draco", {}},
    {"tiny_gltf.h", {"models"}},
};

TEST(Folders, IncludeTable) {
    fs::path src = fs::path(ALPENGLOW_SOURCE_DIR) / "src";
    int files = 0;
    for (const auto& e : fs::recursive_directory_iterator(src)) {
        auto ext = e.path().extension();
        if (ext != ".cpp" && ext != ".h") continue;
        ++files;
        std::string relative = fs::relative(e.path(), src).string();
        std::string folder = relative.substr(0, relative.find('/'));
        ASSERT_TRUE(kAllowed.count(folder)) << relative << " is in no known folder";
        std::ifstream in(e.path());
        std::string line;
        for (int n = 1; std::getline(in, line); ++n) {
            if (line.rfind("#include ", 0) != 0) continue;
            char open = line.size() > 9 ? line[9] : 0;
            size_t close = line.find(open == '<' ? '>' : '"', 10);
            if (close == std::string::npos) continue;
            std::string header = line.substr(10, close - 10), first = header.substr(0, header.find('/'));
            if (open == '"' && header.find('/') != std::string::npos && kAllowed.count(first)) {
                EXPECT_TRUE(first == folder || kAllowed.at(folder).count(first))
                    << relative << ":" << n << " may not include " << header;
            }
            if (auto f = kForeign.find(first); open == '<' && f != kForeign.end()) {
                bool ok = false;
                for (const auto& user : f->second) ok |= relative.rfind(user + "/", 0) == 0;
                EXPECT_TRUE(ok) << relative << ":" << n << " may not include <" << header << ">";
            }
        }
    }
    EXPECT_GT(files, 8);
}

/// A line of a block that only declares names of another folder.
bool declaresNames(const std::string& line) {
    static const std::regex pattern("\\s*(//.*|((class|struct|enum class) \\w+( : \\w+)?;.*)|(using namespace .*))?");
    return std::regex_match(line, pattern);
}

// docs/architecture.md: the namespace of a folder is its name; that of base is alpenglow itself. Limits of every folder are in
// alpenglow::limits, so that a limit is found without knowing who reads it.
TEST(Folders, NamespaceIsFolder) {
    const fs::path src = fs::path(ALPENGLOW_SOURCE_DIR) / "src";
    const std::regex begins("namespace (alpenglow[\\w:]*) \\{");
    int blocks = 0;
    for (const auto& e : fs::recursive_directory_iterator(src)) {
        const std::string ext = e.path().extension().string();
        if (ext != ".cpp" && ext != ".h" && ext != ".inc") continue;
        const std::string relative = fs::relative(e.path(), src).string(), folder = relative.substr(0, relative.find('/'));
        const std::string own = folder == "base" ? "alpenglow" : "alpenglow::" + folder;
        std::ifstream in(e.path());
        std::string line, foreign; // the namespace of another folder that the line is in
        for (int n = 1; std::getline(in, line); ++n) {
            if (!foreign.empty()) {
                if (line.starts_with("}")) foreign.clear();
                else EXPECT_TRUE(declaresNames(line)) << relative << ":" << n << ": defined in " << foreign << ", not in " << own;
            }
            std::smatch m;
            if (!std::regex_match(line, m, begins)) continue;
            ++blocks;
            const std::string name = m[1];
            const bool limits = name == "alpenglow::limits" && e.path().filename() == "limits.h";
            const bool nested =
                name.starts_with(own + "::") && (folder != "base" || !fs::exists(src / name.substr(own.size() + 2)));
            if (name != own && !nested && !limits) foreign = name;
        }
    }
    EXPECT_GT(blocks, 900);
}

// A world is immutable once it is built: threads read it without locks. Only the folder that builds it can change one.
TEST(Folders, NobodyChangesABuiltWorld) {
    int files = 0;
    for (const char* folder :
         {"src/world", "src/services", "src/integrator", "tests/world", "tests/services", "tests/integrator"})
        for (const auto& e : fs::directory_iterator(fs::path(ALPENGLOW_SOURCE_DIR) / folder)) {
            ++files;
            std::ifstream in(e.path());
            std::string line;
            for (int n = 1; std::getline(in, line); ++n) {
                EXPECT_EQ(line.find("const_cast"), std::string::npos) << e.path() << ":" << n << " casts const away";
                if (std::string_view(folder) != "src/world")
                    EXPECT_FALSE(line.starts_with("#include \"world/mutableworld.h\"")) << e.path() << ":" << n;
            }
        }
    EXPECT_GT(files, 100);
}

// One header of at most 150 lines is all that others see of light transport.
TEST(Folders, TheIntegratorHasOneDoor) {
    const fs::path src = fs::path(ALPENGLOW_SOURCE_DIR) / "src";
    int users = 0;
    for (const auto& e : fs::recursive_directory_iterator(src)) {
        const std::string relative = fs::relative(e.path(), src).string();
        if (!e.is_regular_file() || relative.rfind("integrator/", 0) == 0) continue;
        std::ifstream in(e.path());
        std::string line;
        for (int n = 1; std::getline(in, line); ++n) {
            if (line.rfind("#include \"integrator/", 0) != 0) continue;
            EXPECT_EQ(line, "#include \"integrator/integrator.h\"") << relative << ":" << n;
            ++users;
        }
    }
    EXPECT_GT(users, 4);
}

// The integrator is read first: each stage has a header of its own that one page shows, and nobody reaches inside of another.
TEST(Folders, StagesOfTheIntegratorAreSmall) {
    int headers = 0;
    for (const auto& e : fs::directory_iterator(fs::path(ALPENGLOW_SOURCE_DIR) / "src/integrator")) {
        const bool header = e.path().extension() == ".h";
        headers += header;
        std::ifstream in(e.path());
        std::string line;
        int lines = 0;
        for (; std::getline(in, line); ++lines)
            EXPECT_EQ(line.find("friend "), std::string::npos) << e.path().filename() << ":" << lines + 1 << " has a friend";
        EXPECT_LE(lines, header ? 150 : 400) << e.path().filename();
    }
    EXPECT_GT(headers, 40);
}

} // namespace

} // namespace folders_test
