// alpenglow model.glb and alpenglow from: what small models look like, compared with closed forms.
#include "../models/gltfwriter.h"
#include "base/installation.h"
#include "command_folder.h"
#include "display/imageio.h"
#include <cmath>

namespace foreignmodels_test {

using gltf_test::GltfWriter;
using gltf_test::square;

namespace {

class ForeignModels : public alpenglow::cli::testing::CommandFolder {
protected:
    std::string err;
    void SetUp() override {
        CommandFolder::SetUp();
        namespace fs = std::filesystem;
        const fs::path bin = fs::path(ALPENGLOW_PROGRAM).parent_path();
        if (!fs::exists(bin / "libalpenglow_gltf.so")) GTEST_SKIP() << "built without tinygltf";
        if (!fs::exists(fs::path(ALPENGLOW_SOURCE_DIR) / "shaders/standard.sl")) GTEST_SKIP() << "there is no shader standard";
    }
    void call(const std::string& arguments) {
        run(arguments, "2>err");
        std::ifstream in(dir / "err");
        err.assign(std::istreambuf_iterator<char>(in), {});
    }
    /// The mean of a square in the middle of a picture.
    std::array<float, 3> middle(const std::string& picture, double atX = .5, double atY = .5) const {
        alpenglow::Diagnostics diag;
        const auto m = alpenglow::display::readImage((dir / picture).string(), diag);
        std::array<float, 3> sum{};
        EXPECT_TRUE(m) << picture;
        if (!m) return sum;
        const int cx = int(atX * m->width), cy = int(atY * m->height);
        for (int y = cy - 1; y <= cy; ++y)
            for (int x = cx - 1; x <= cx; ++x)
                for (size_t k = 0; k < 3; ++k)
                    sum[k] += m->data[(size_t(y) * size_t(m->width) + size_t(x)) * size_t(m->channelCount()) + k] / 4;
        return sum;
    }
    /// A square that a camera 2 before it sees whole, and a light.
    static GltfWriter seen(const std::string& material, const std::string& light = "") {
        GltfWriter w = square(material);
        w.scenes = R"([{"nodes":[0,1)" + std::string(light.empty() ? "" : ",2") + "]}]";
        w.nodes =
            R"([{"name":"it","mesh":0},{"camera":0,"translation":[0,0,2]})" +
            (light.empty() ? std::string() : R"(,{"translation":[0,0,3],"extensions":{"KHR_lights_punctual":{"light":0}}})") +
            "]";
        w.cameras = R"([{"type":"perspective","perspective":{"yfov":0.9272952180016122,"aspectRatio":1,"znear":0.01}}])";
        if (!light.empty()) w.extensions = R"({"KHR_lights_punctual":{"lights":[)" + light + "]}}";
        return w;
    }
    std::array<float, 3> draw(const GltfWriter& w, const std::string& more = "") {
        write("m.gltf", w.text());
        call("from m.gltf -o m.rib --no-lights " + more);
        EXPECT_EQ(status, 0) << err;
        call("--progress none --format 24x24 --spp 4 -o p.exr m.rib");
        EXPECT_EQ(status, 0) << err;
        return middle("p.exr");
    }
};

const char* const kMatte = R"({"extensions":{"KHR_materials_specular":{"specularFactor":0}},
    "pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0.125,1],"metallicFactor":0}})";
const double kPi = 3.14159265358979;

} // namespace

TEST_F(ForeignModels, EmissionIsRadiance) {
    const auto c = draw(seen(R"({"emissiveFactor":[1,0.5,0.25],"extensions":{"KHR_materials_specular":{"specularFactor":0},
        "KHR_materials_emissive_strength":{"emissiveStrength":2}},
        "pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1],"metallicFactor":0}})"));
    EXPECT_NEAR(c[0], 2, 1e-3);
    EXPECT_NEAR(c[1], 1, 1e-3);
    EXPECT_NEAR(c[2], .5, 1e-3);
}

// Lambert: albedo / pi times irradiance; lux of a sun, candela over the squared distance of a lamp.
TEST_F(ForeignModels, LightsHaveTheUnitsOfGltf) {
    auto c = draw(seen(kMatte, R"({"type":"directional","intensity":2})"));
    EXPECT_NEAR(c[0], .5 * 2 / kPi, 2e-3);
    EXPECT_NEAR(c[2], .125 * 2 / kPi, 1e-3);
    c = draw(seen(kMatte, R"({"type":"point","intensity":45,"color":[1,0.5,1]})"));
    EXPECT_NEAR(c[0], .5 / kPi * 45 / 9, .02);
    EXPECT_NEAR(c[1], .25 / kPi * 22.5 / 9, .01);
    c = draw(seen(kMatte, R"({"type":"spot","intensity":45,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.3}})"));
    EXPECT_NEAR(c[0], .5 / kPi * 45 / 9, .02); // within the inner cone as a point
    EXPECT_NEAR(middle("p.exr", .9, .9)[0], 0, 1e-6);
    c = draw(seen(kMatte, R"({"type":"directional","intensity":683})"), "--light-scale 0.00146413");
    EXPECT_NEAR(c[0], .5 / kPi, 2e-3);
}

TEST_F(ForeignModels, FactorsMultiplyTextures) {
    GltfWriter w = seen(R"({"extensions":{"KHR_materials_unlit":{}},"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,1],
        "baseColorTexture":{"index":0}}})");
    // A Targa file of 2 x 1: on the left code 188 in all channels, on the right black, but blue (B, G, R).
    const uint8_t targa[] = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 24, 0x20, 188, 188, 188, 255, 0, 0};
    const int v = w.view(targa, sizeof targa);
    w.images = R"([{"name":"two","mimeType":"image/png","bufferView":)" + std::to_string(v) + "}]";
    w.samplers = R"([{"wrapS":33071,"wrapT":33071}])";
    w.textures = R"([{"source":0,"sampler":0}])";
    draw(w);
    const auto left = middle("p.exr", .2, .5), right = middle("p.exr", .8, .5);
    const double light = std::pow((188 / 255. + .055) / 1.055, 2.4); // IEC 61966-2-1
    EXPECT_NEAR(left[0], .5 * light, .01);
    EXPECT_NEAR(left[1], light, .01);
    EXPECT_NEAR(right[0], 0, .01);
    EXPECT_NEAR(right[2], 1, .01);
    EXPECT_TRUE(std::filesystem::exists(dir / "m_two.tex"));
}

TEST_F(ForeignModels, AModelAtOnceIsTheSceneThatFromWrites) {
    write("m.glb", seen(kMatte, R"({"type":"directional","intensity":2})").binary());
    call("from m.glb");
    EXPECT_EQ(status, 0) << err;
    call("--progress none --format 24x24 --spp 4 -o a.exr m.rib");
    call("--progress none --format 24x24 --spp 4 -o b.exr m.glb");
    EXPECT_EQ(status, 0) << err;
    call("diff a.exr b.exr");
    EXPECT_EQ(status, 0) << err;
}

TEST_F(ForeignModels, ModelsWithoutLightAndCameraAreShown) {
    write("m.gltf", square(kMatte).text());
    call("--progress none --format 24x18 --spp 4 -o p.exr m.gltf");
    EXPECT_EQ(status, 0) << err;
    const auto c = middle("p.exr");
    EXPECT_GT(c[0], 1.3f * c[1]); // the square in the middle, lit, beside a sky that is blue
    EXPECT_GT(c[0], .1f);
    write("bad.glb", "glTF");
    call("--progress none -o p.exr bad.glb");
    EXPECT_EQ(status, 3);
    EXPECT_NE(err.find("bad.glb"), std::string::npos);
    EXPECT_NE(err.find("cannot be read"), std::string::npos);
}

TEST_F(ForeignModels, MaterialsOfMaterialXAreThoseOfStandard) {
    write("m.mtlx",
          R"(<materialx version="1.38"><multiply name="m" type="color3"><input name="in1" type="color3" value="1, 0.5, 0.25"/>
        <input name="in2" type="float" value="0.5"/></multiply><standard_surface name="s" type="surfaceshader">
        <input name="base_color" type="color3" nodename="m"/><input name="specular_roughness" type="float" value="0.6"/>
        <input name="coat" type="float" value="0.5"/></standard_surface></materialx>)");
    call("from m.mtlx -o mine.sl");
    EXPECT_EQ(status, 0) << err;
    const auto scene = [](const std::string& surface) {
        return "Projection \"perspective\" \"fov\" 40 Hider \"path\" Translate 0 0 3 WorldBegin LightSource \"envlight\" 1 " +
               surface + " Sphere 1 -1 1 360 WorldEnd\n";
    };
    write("a.rib", scene("Surface \"mine\""));
    write("b.rib",
          scene("Surface \"standard\" \"color base_color\" [.5 .25 .125] \"float specular_roughness\" .6 \"float coat\" .5"));
    for (const std::string s : {"a", "b"}) {
        call("--progress none --format 24x24 --spp 4 -o " + s + ".exr " + s + ".rib");
        EXPECT_EQ(status, 0) << err;
    }
    call("diff a.exr b.exr");
    EXPECT_EQ(status, 0) << err;
}

} // namespace foreignmodels_test
