// Options, attributes and display parameters that no other test is about, in whole runs.
#include "../sanitized.h"
#include "command_folder.h"
#include <fstream>
#include <nlohmann/json.hpp>

namespace optioneffects_test {

namespace {

class OptionEffects : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string run(const std::string& arguments) { return CommandFolder::run(arguments, "2>err"); }
    std::string text(const std::string& name) const {
        std::ifstream in(dir / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// The bytes of an attribute in the header of an OpenEXR file ("OpenEXR File Layout": name, type, size in four bytes, value).
    std::string exrAttribute(const std::string& file, const std::string& name, const std::string& type) const {
        const std::string bytes = text(file), key = name + '\0' + type + '\0';
        const size_t at = bytes.find(key);
        if (at == bytes.npos) return "";
        const auto byte = [&](size_t i) { return size_t(static_cast<unsigned char>(bytes[at + key.size() + i])); };
        return bytes.substr(at + key.size() + 4, byte(0) | byte(1) << 8);
    }
};

} // namespace

TEST_F(OptionEffects, CompressionAndTypeOfOpenExr) {
    const struct {
        const char* name;
        char code;
    } compressions[] = {{"none", 0}, {"rle", 1}, {"zips", 2}, {"zip", 3}, {"piz", 4}};
    const auto scene = [&](const std::string& parameter) {
        write("a.rib",
              "Format 4 4 1\nDisplay \"a.exr\" \"openexr\" \"rgb\" " + parameter + "\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
        run("render a.rib");
        EXPECT_EQ(status, 0) << text("err");
    };
    for (const auto& c : compressions) {
        scene(std::string("\"string exrcompression\" \"") + c.name + "\"");
        EXPECT_EQ(exrAttribute("a.exr", "compression", "compression"), std::string(1, c.code)) << c.name;
    }
    for (const auto& [name, code] : {std::pair{"half", 1}, {"float", 2}}) {
        scene(std::string("\"string exrpixeltype\" \"") + name + "\"");
        const std::string channels = exrAttribute("a.exr", "channels", "chlist"); // B: its name, then its type
        ASSERT_GE(channels.size(), 6u);
        EXPECT_EQ(channels.substr(0, 2), std::string("B\0", 2));
        EXPECT_EQ(int(channels[2]), code) << name;
    }
}

// A map of 1 MB does not fit into 64 kB: the rest lies in a scratch file. The picture is the same.
TEST_F(OptionEffects, MemoryForTextures) {
    write("map.rib", "Format 512 512 1\nDisplay \"map.tif\" \"tiff\" \"rgb\"\nPixelSamples 1 1\nWorldBegin\nWorldEnd\n"
                     "MakeTexture \"map.tif\" \"map.tx\" \"clamp\" \"clamp\" \"box\" 1 1\n");
    run("render map.rib");
    ASSERT_EQ(status, 0) << text("err");
    write("maps.sl", "surface maps() { Oi = 1; Ci = color(texture(\"map.tx\", s, t)); }\n");
    const auto scratch = [&](const std::string& option) {
        write("a.rib", option + "Format 64 64 1\nDisplay \"a.exr\" \"openexr\" \"rgb\"\nWorldBegin\nSurface \"maps\"\n"
                                "Polygon \"P\" [-1 -1 1 -1 1 1 1 1 1 1 -1 1] \"st\" [0 1 0 0 1 0 1 1]\nWorldEnd\n");
        run("render --stats s.json a.rib");
        EXPECT_EQ(status, 0) << text("err");
        const auto j = nlohmann::json::parse(text("s.json"), nullptr, false);
        uint64_t bytes = 0;
        for (const auto& frame : j.at("frames"))
            for (const auto& t : frame.at("textures")) bytes += t.at("scratchBytes").get<uint64_t>();
        return bytes;
    };
    EXPECT_EQ(scratch(""), 0u);
    const std::string roomy = text("a.exr");
    EXPECT_GT(scratch("Option \"limits\" \"int texturememory\" 64\n"), 0u);
    EXPECT_EQ(text("a.exr"), roomy);
}

// Rays meet a surface whose shader gives green, and whose Cs is red.
TEST_F(OptionEffects, HitModes) {
    write("green.sl", "surface green() { Oi = 1; Ci = color(0, 1, 0); }\n");
    write("asks.sl", "surface asks(string how = \"\";) {\n    vector up = vector \"world\" (0, 0, -1);\n    Oi = 1;\n"
                     "    if (how == \"diffuse\") Ci = indirectdiffuse(P, normal(up), 16);\n    else Ci = trace(P, up);\n}\n");
    for (const auto& [kind, attribute] : {std::pair{"diffuse", "diffusehitmode"}, {"specular", "specularhitmode"}})
        for (const auto& [mode, want] : {std::pair{"shader", "0 1 0 1\n"}, {"primitive", "1 0 0 1\n"}}) {
            const std::string k = kind;
            write("a.rib",
                  "Format 4 4 1\nPixelSamples 1 1\nHider \"raytrace\"\nWorldBegin\nSides 2\nAttribute \"visibility\" \"int " + k +
                      "\" 1 \"int camera\" 0\nAttribute \"shade\" \"string " + attribute + "\" \"" + mode +
                      "\"\nSurface \"green\"\nColor 1 0 0\nSphere 50 -50 50 360\nAttribute \"visibility\" \"int camera\" 1 "
                      "\"int diffuse\" 0 \"int specular\" 0\nSurface \"asks\" \"how\" \"" +
                      k + "\"\nPolygon \"P\" [-9 -9 5 -9 9 5 9 9 5 9 -9 5]\nWorldEnd\n");
            EXPECT_EQ(run("render --pixel 2,2 a.rib"), want) << kind << mode << text("err");
        }
}

// More samples than the memory has room for: the message names them.
TEST_F(OptionEffects, SamplesWithoutMemory) {
    if (alpenglow::kSanitized) GTEST_SKIP() << "AddressSanitizer ends the program where an allocation fails";
    write("a.rib", "Format 640 480 1\nPixelSamples 2000 2000\nHider \"hidden\"\nWorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    run("render --memory-limit 600M -o a.exr a.rib");
    const std::string said = text("err");
    EXPECT_NE(said.find("the 2000 x 2000 samples of each pixel (PixelSamples) take "), std::string::npos) << said;
    EXPECT_NE(said.find("the limit is 600 MiB; --memory-limit sets another"), std::string::npos) << said;
}

} // namespace optioneffects_test
