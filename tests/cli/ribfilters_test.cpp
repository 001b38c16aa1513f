// alpenglow rib --filter: libraries in C++ and functions in Python.
#include "command_folder.h"
#include <cstdlib>

namespace ribfilters_test {

namespace {

using alpenglow::cli::testing::CommandFolder;

struct RibFilters : CommandFolder {
    std::string said; ///< on standard error by the last run
    void SetUp() override {
        CommandFolder::SetUp();
        write("in.rib", "Format 4 4 1\nWorldBegin\nLightSource \"pointlight\" \"key\" \"intensity\" [3]\nIlluminate \"key\" 1\n"
                        "Surface \"plastic\" \"Kd\" [.5]\nPolygon \"P\" [0 0 0 1 0 0 0 1 0]\nSphere 1 -1 1 360\nWorldEnd\n");
    }
    std::string read(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// The result, without indentation; empty where none was written.
    std::string filtered(const std::string& options, int wanted = 0) {
        std::filesystem::remove(dir / "out.rib");
        run("rib --indent 0 " + options + " in.rib -o out.rib", "2> said.txt");
        said = read("said.txt");
        EXPECT_EQ(status, wanted) << options << '\n' << said;
        return read("out.rib");
    }
    /// Compiles a filter. False: there is no compiler.
    bool library(const std::string& name, const std::string& members, const std::string& more = "") {
        write(name + ".cpp",
              "#include <RifPlugin.h>\n#include <cstdlib>\n#include <stdexcept>\nstruct F : RifPlugin {\n RifFilter f;\n float "
              "by = 2;\n"
              " F() {\n" +
                  members + "\n }\n RifFilter& GetFilter() override { return f; } };\n" + more +
                  "extern \"C\" RifPlugin* RifPluginManufacture(int argc, char** argv) { F* f = new F; if (argc) f->by = "
                  "float(std::atof(argv[0])); return f; }\n");
        const std::string command = "c++ -std=c++17 -shared -fPIC -I " + std::string(ALPENGLOW_SOURCE_DIR) + "/include " +
                                    (dir / (name + ".cpp")).string() + " -o " + (dir / (name + ".so")).string() + " 2> " +
                                    (dir / "said.txt").string();
        return std::system(command.c_str()) == 0;
    }
};

TEST_F(RibFilters, PythonChangesLeavesOutAndPutsIn) {
    write("f.py", "def filter(request, args, params):\n"
                  "    if request == 'Sphere': return [('Sphere', [2 * x for x in args[:3]] + args[3:], params)]\n"
                  "    if request == 'Format': return False\n"
                  "    if request == 'WorldBegin': return ['Sides 2', ('WorldBegin', [], {})]\n"
                  "    if request == 'Surface': return [(request, ['matte'], {'Ka': [.25], **params})]\n"
                  "def quiet(request, args, params):\n"
                  "    return True if request != 'Sides' else []\n");
    const std::string out = filtered("--filter f.py");
    EXPECT_EQ(out.find("Format"), out.npos);
    EXPECT_NE(out.find("Sides 2\nWorldBegin\n"), out.npos) << out;
    EXPECT_NE(out.find("Sphere 2 -2 2 360\n"), out.npos) << out;
    EXPECT_NE(out.find("Surface \"matte\" \"Ka\" [0.25] \"Kd\" [0.5]\n"), out.npos) << out;
    EXPECT_NE(out.find("Polygon \"P\" [0 0 0 1 0 0 0 1 0]\n"), out.npos) << out;
    EXPECT_EQ(filtered("--filter f.py --filter f.py:quiet").find("Sides"), std::string::npos);
    EXPECT_NE(filtered("--filter f.py --filter f.py").find("Sphere 4 -4 4 360\n"), std::string::npos); // one behind the other
}

TEST_F(RibFilters, PythonThatFails) {
    write("bad.py", "import os\n"
                    "def raises(request, args, params):\n    if request == 'Sphere': raise ValueError('no spheres')\n"
                    "def wrong(request, args, params):\n    if request == 'Sphere': return [('Ball', [], {})]\n"
                    "def less(request, args, params):\n    if request == 'Sphere': return [('Sphere', [1], {})]\n"
                    "def ends(request, args, params):\n    if request == 'Surface': os._exit(3)\n");
    for (const auto& [name, says] :
         {std::pair{"raises", "ValueError: no spheres"}, {"wrong", "\"Ball\" is no request"}, {"less", "Sphere"}}) {
        const std::string out = filtered(std::string("--filter bad.py:") + name, 1);
        EXPECT_NE(said.find(says), std::string::npos) << said;
        EXPECT_NE(said.find("in.rib:7"), std::string::npos) << said;
        EXPECT_NE(out.find("Polygon"), out.npos) << name;
        EXPECT_EQ(out.find("Sphere"), out.npos) << name;
    }
    EXPECT_NE(filtered("--filter bad.py:ends", 1).find("Sphere 1 -1 1 360"), std::string::npos);
    for (const char* spec : {"bad.py:nothing", "none.py", "python:nomodule.f", "none.so", "in.rib"})
        EXPECT_EQ(filtered(std::string("--filter ") + spec, 2), "") << spec;
}

TEST_F(RibFilters, LibrariesInC) {
    ASSERT_TRUE(library(
        "bigger",
        " f.SphereV = [](RtFloat r, RtFloat a, RtFloat b, RtFloat t, RtInt n, RtToken k[], RtPointer v[]) { const float "
        "by = static_cast<F*>(RifGetCurrentPlugin())->by; RiSphereV(by * r, by * a, by * b, t, n, k, v); };\n"
        " f.SurfaceV = [](RtString, RtInt n, RtToken k[], RtPointer v[]) { RtColor c = {.5f, 0, 0}; RiColor(c); "
        "RiSurfaceV(\"matte\", n, k, v); };\n f.Format = [](RtInt, RtInt, RtFloat) {};\n"
        " f.LightSourceV = [](RtString name, RtInt n, RtToken k[], RtPointer v[]) { return RiLightSourceV(name, n, k, v); };\n"
        " f.Illuminate = [](RtLightHandle h, RtBoolean on) { RiIlluminate(h, on); RiIlluminate(h, !on); };\n"
        " f.PolygonV = [](RtInt count, RtInt n, RtToken k[], RtPointer v[]) { RiPolygonV(count, n, k, v); };"))
        << read("said.txt");
    const std::string out = filtered("--filter './bigger.so 3'");
    EXPECT_EQ(out.find("Format"), out.npos);
    EXPECT_NE(out.find("Sphere 3 -3 3 360\n"), out.npos) << out;
    EXPECT_NE(out.find("Color [0.5 0 0]\nSurface \"matte\" \"Kd\" [0.5]\n"), out.npos) << out;
    EXPECT_NE(out.find("LightSource \"pointlight\" \"key\" \"intensity\" [3]\nIlluminate \"key\" 1\nIlluminate \"key\" 0\n"),
              out.npos)
        << out;
    EXPECT_NE(out.find("Polygon \"P\" [0 0 0 1 0 0 0 1 0]\n"), out.npos) << out;
    EXPECT_NE(filtered("-rif bigger -rif bigger -rifargs 5 -rifend").find("Sphere 10 -10 10 360\n"), std::string::npos);
}

TEST_F(RibFilters, LibrariesThatThrowOrTakeNothing) {
    ASSERT_TRUE(library(
        "throws", " f.Filtering = RifFilter::k_Terminate;\n f.SphereV = [](RtFloat, RtFloat, RtFloat, RtFloat, RtInt, RtToken[], "
                  "RtPointer[]) { throw std::runtime_error(\"no spheres\"); };\n f.WorldBegin = [] { RiWorldBegin(); };"))
        << read("said.txt");
    const std::string out = filtered("--filter throws", 1);
    EXPECT_NE(said.find("threw: no spheres"), said.npos) << said;
    EXPECT_NE(out.find("WorldBegin"), out.npos);
    EXPECT_EQ(out.find("Surface"), out.npos);
    EXPECT_EQ(out.find("WorldEnd"), out.npos);
}

} // namespace

// `render --filter`, and prman's -rif: requests of scenes and their archives pass it once, those in front of them not.
TEST_F(RibFilters, ScenesAreDrawnAsFiltered) {
    write("part.rib", "Color 0 1 0\nSphere 1 -1 1 360\n");
    write("scene.rib", "Format 8 8 1\nPixelSamples 1 1\nDisplay \"a.exr\" \"openexr\" \"rgb\"\nArchiveBegin \"x\"\nScale 2 2 2\n"
                       "ArchiveEnd\nWorldBegin\nSurface \"constant\"\nReadArchive \"x\"\nReadArchive \"part.rib\"\nWorldEnd\n");
    write(
        "f.py",
        "def filter(request, args, params):\n"
        "    if request == 'Color': return [('Color', [[args[0][1], args[0][2], args[0][0]]], {})] if isinstance(args[0], list) "
        "else [('Color', [args[1], args[2], args[0]], {})]\n"
        "    if request == 'Scale': return [('Scale', [.5 * x for x in args], {}), 'Translate 0 0 5']\n"
        "    if request == 'Format': return False\n");
    const std::string more = "--no-rc --rib 'Format 4 4 1' --pixel 2,2 ";
    EXPECT_EQ(run("render " + more + "--filter f.py scene.rib", "2> said.txt"), "1 0 0 1\n") << read("said.txt");
    EXPECT_EQ(run("render " + more + "-rif f.py scene.rib", "2> said.txt"), "1 0 0 1\n") << read("said.txt");
    EXPECT_EQ(run("render " + more + "--filter f.py --filter f.py scene.rib", "2> said.txt"), "0 0 1 1\n") << read("said.txt");
    run("render --filter none.py scene.rib", "2> said.txt");
    EXPECT_EQ(status, 2);
    EXPECT_NE(read("said.txt").find("none.py"), std::string::npos);
    run("render --filter f.py --frames-at-once 2 scene.rib", "2> said.txt");
    EXPECT_EQ(status, 2);
}

} // namespace ribfilters_test
