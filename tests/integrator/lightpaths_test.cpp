// Outputs by light path: their parts are Ci's own light, separated by what happened to it.
#include "integrator/box.h"
#include "integrator/floorscene.h"
#include "scene/lightpaths.h"
#include <cstring>

namespace lightpaths_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

struct ShaderValue {
    std::vector<SampleResult> samples;
    std::shared_ptr<const scene::LightPaths> paths;
    Color beauty(size_t i) const { return samples[i].color; }
    Color output(size_t i, size_t k) const {
        Color c(0);
        for (int part : paths->partsOf(k)) c += samples[i].parts[size_t(part)];
        return c;
    }
    double mean(size_t k, int component = 0) const {
        double s = 0;
        for (size_t i = 0; i < samples.size(); ++i) s += output(i, k)[component];
        return s / double(samples.size());
    }
    double meanBeauty(int component = 0) const {
        double s = 0;
        for (const SampleResult& r : samples) s += r.color[component];
        return s / double(samples.size());
    }
};

ShaderValue tell(const std::string& rib, const std::vector<CameraRay>& rays, const std::vector<std::string>& expressions,
                 int lanes = 16) {
    std::vector<scene::LightPaths::Source> sources;
    for (const std::string& e : expressions) sources.push_back({scene::lightPathOfWord(e).value_or(e), {}});
    Diagnostics d;
    ShaderValue t;
    t.paths = std::make_shared<scene::LightPaths>(sources, d);
    EXPECT_EQ(d.all().size(), 0u);
    Settings set = withShaders(Hider::Path);
    set.lightPaths = t.paths;
    set.firstSeen = true;
    set.lanes = lanes;
    Scene s(rib, set);
    t.samples = s.trace(rays);
    return t;
}

/// Ci is what it is without the outputs, and every sample's outputs are it, up to rounding; where only one part has light,
/// exactly.
void expectWhole(const std::string& rib, const std::vector<CameraRay>& rays, const std::vector<std::string>& disjoint) {
    const ShaderValue t = tell(rib, rays, disjoint);
    Scene plain(rib, withShaders(Hider::Path));
    const std::vector<SampleResult> alone = plain.trace(rays);
    int differ = 0;
    double worst = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        differ += std::memcmp(&alone[i].color, &t.samples[i].color, sizeof(Color)) != 0;
        Color sum(0);
        int lit = 0;
        for (const Color& part : t.samples[i].parts) {
            sum += part;
            lit += part != Color(0);
        }
        if (lit == 1) { EXPECT_EQ(sum, alone[i].color); }
        for (int k = 0; k < 3; ++k)
            worst = std::max(worst, std::fabs(double(sum[k]) - alone[i].color[k]) / (1e-6 + alone[i].color[k]));
    }
    EXPECT_EQ(differ, 0);
    EXPECT_LT(worst, 4e-7 * double(t.paths->parts())); // a rounding a part
    double outputs = 0;
    for (size_t k = 0; k < disjoint.size(); ++k) outputs += t.mean(k);
    EXPECT_NEAR(outputs, t.meanBeauty(), 1e-6 * t.meanBeauty());
}

std::vector<CameraRay> many(CameraRay ray, int n) {
    std::vector<CameraRay> rays;
    for (int i = 0; i < n; ++i) {
        ray.px = i;
        rays.push_back(ray);
    }
    return rays;
}

const char* const kTwoLights =
    "Attribute \"light\" \"string group\" \"warm\"\nLightSource \"pointlight\" \"key\" \"from\" [0 2 0] \"intensity\" 4\n"
    "Attribute \"light\" \"string group\" \"cold\"\n"
    "AttributeBegin\nAreaLightSource \"slrect\" \"panel\" \"intensity\" 3\nSurface \"constant\"\nColor 0 0 "
    "0\nReverseOrientation\n"
    "Polygon \"P\" [-1 3 -1  -1 3 1  1 3 1  1 3 -1]\nAttributeEnd\nIlluminate \"panel\" 1\n";

TEST(LightPathOutputs, TheBoxIsTheSumOfItsPaths) {
    const auto rays = boxRays(nightly() ? 3000 : 800, 5); // each is compared to the bit
    expectWhole(boxRib(true), rays, {"direct", "indirect", "other"});
    expectWhole(boxRib(true), rays, {"C<RD>L", "C<RD>[DGS]+L", "C<.S>.*L", "CL", "other"});
}

TEST(LightPathOutputs, GlassAndGroups) {
    const std::string rib =
        inWorld(std::string(kTwoLights) + "Surface \"slmaterial\" \"color diffusecolor\" [.6 .5 .4]\n" + kFloor +
                "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [.9 .9 .9] \"float kn\" 1.5\n"
                "Translate 0 1 0\nSphere .7 -.7 .7 360\n");
    const auto rays = many(rayTo({.3f, 1.5f, -3.f}, {0, .8f, 0}), 2000);
    expectWhole(rib, rays, {"C.*<L.'warm'>", "C.*<L.'cold'>", "C.*O", "other"});
    expectWhole(rib, rays, {"C.*<L.'key'>", "C<T[GS]>.*<L.'panel'>", "C<R.>.*<L.'panel'>", "other"});
    const ShaderValue t = tell(rib, rays, {"C.*<L.'warm'>", "C.*<L.'cold'>", "C.*<L.'nobody'>", "C<T[GS]><T[GS]>.*L"});
    EXPECT_GT(t.mean(0), 0);
    EXPECT_GT(t.mean(1), 0);
    EXPECT_EQ(t.mean(2), 0);
    EXPECT_GT(t.mean(3), 0);
}

/// A point light of intensity 4, 2 above a floor of albedo .5: 4 / 4 * .5 direct, and nothing else.
TEST(LightPathOutputs, ALitPlaneIsDirect) {
    const ShaderValue t = tell(inWorld(std::string("LightSource \"pointlight\" \"key\" \"from\" [0 2 0] \"intensity\" 4\n") +
                                       "Surface \"matte\" \"Ka\" 0 \"Kd\" .5\n" + kFloor),
                               {kView}, {"direct", "indirect", "C<RD'diffuse'><L.'key'>", "C<RG>L", "C<TD>L"});
    EXPECT_NEAR(t.output(0, 0).x, .5, 1e-6);
    EXPECT_EQ(t.output(0, 0), t.beauty(0));
    EXPECT_EQ(t.output(0, 2), t.beauty(0));
    for (size_t k : {1, 3, 4}) EXPECT_EQ(t.output(0, k), Color(0)) << k;
    EXPECT_EQ(t.samples[0].albedo, Color(.5f));
    EXPECT_NEAR(length(t.samples[0].normal), 1, 1e-6);
    EXPECT_NEAR(t.samples[0].normal.y, 1, 1e-6);
    const ShaderValue below =
        tell(inWorld(std::string("Surface \"matte\"\n") + kFloor), {rayTo({.3f, -.8f, -.4f}, {0, 0, 0})}, {"direct"});
    EXPECT_NEAR(below.samples[0].normal.y, -1, 1e-6); // the side that is seen
}

/// Under an even sky of 1 a surface shows its albedo. Seen straight on, glass of index 1.5 gives back ((1.5 - 1) / (1.5 + 1))^2,
/// a mirror of facets nearly all; a highlight its closed form 8 (1 - 2^(-(e + 2) / 2)) / (e + 2), of an exponent e.
TEST(LightPathOutputs, AlbedoIsWhatAnEvenSkyShows) {
    const auto facets = [](const char* name, const char* more) {
        return std::string("trace(P, n, \"distribution\", \"") + name + "\", \"roughness\", .1, \"wo\", -normalize(I)" + more +
               ")";
    };
    const struct {
        std::string what;
        double want, precision;
    } cases[] = {{facets("cook-torrance", ", \"eta\", 1.5"), .04, .02},
                 {facets("blinn", ", \"eta\", 1.5"), .04, .02},
                 {facets("ashikhmin-shirley", ", \"eta\", 1.5"), .04, .1},
                 {"specularstd(n, -normalize(I), .1)", 8 * (1 - std::exp2(-6)) / 12, .01},
                 {".5 * diffuse(n)", .5, 1e-6}};
    int number = 0;
    for (const auto& c : cases) {
        const std::string name = "albedoof" + std::to_string(++number);
        writeShader(name, "surface " + name + "() { normal n = faceforward(normalize(N), I); Oi = 1; Ci = " + c.what + "; }\n");
        const ShaderValue t = tell(inWorld("LightSource \"envlight\" 1 \"intensity\" 1\nSurface \"" + name + "\"\n" + kFloor),
                                   many(rayTo({.01f, 1, .01f}, {0, 0, 0}), 4000), {"direct"});
        double albedo = 0;
        for (const SampleResult& r : t.samples) albedo += r.albedo.x / double(t.samples.size());
        EXPECT_NEAR(albedo, c.want, c.precision * c.want) << c.what;
        EXPECT_NEAR(albedo, t.meanBeauty(), .05 * c.want) << c.what;
    }
}

/// Under an even sky all light of a plane is met by its first scattering; in a furnace, a ball of albedo a that shines 1, the
/// light of n scatterings is a^n.
TEST(LightPathOutputs, AFurnaceByTheNumberOfScatterings) {
    writeShader("glowing", "surface glowing(float a = .5) { Oi = Os; Ci = 1 + a * diffuse(faceforward(normalize(N), I)); }");
    const ShaderValue t =
        tell(inWorld("Surface \"glowing\"\nSphere 2 -2 2 360\n"), many(rayTo({.3f, .2f, -.4f}, {1.5f, .4f, .3f}), 4000),
             {"CO", "CDO", "CD{2}O", "CD{3,}O", "direct", "indirect", "other"});
    const double expected[] = {1, .5, .25, .25, 1.5, .5, 0};
    for (size_t k = 0; k < 7; ++k)
        EXPECT_NEAR(t.mean(k), expected[k], k < 2 || k == 4 ? 1e-5 : .03) << k; // late ones by roulette
    const ShaderValue sky =
        tell(inWorld(std::string("LightSource \"envlight\" 1 \"intensity\" 1\nSurface \"matte\" \"Ka\" 0 \"Kd\" .5\n") + kFloor),
             many(kView, 2000), {"direct", "indirect", "C<RD>B", "C<RD>L"});
    for (size_t k : {0, 2, 3}) EXPECT_NEAR(sky.mean(k), .5, 5e-3) << k;
    EXPECT_EQ(sky.mean(1), 0);
}

/// A pane before a light: only expressions that name s see it, however the light is found.
TEST(LightPathOutputs, StraightPassages) {
    const std::string rib =
        inWorld(std::string(kTwoLights) + "Surface \"matte\" \"Ka\" 0 \"Kd\" 1\n" + kFloor +
                "Surface \"constant\"\nColor 0 0 0\nOpacity .5 .5 .5\nPolygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9]\n");
    const ShaderValue t =
        tell(rib, many(rayTo({.3f, .5f, -.4f}, {0, 0, 0}), 2000), {"C<RD>L", "C<RD>sL", "C<RD>s{2}L", "C<RD>.L", "C<RD>[^s]*L"});
    EXPECT_GT(t.mean(0), 0);
    EXPECT_GE(t.mean(1), .999 * t.mean(0)); // the panel cannot be met by other ways than through the pane
    EXPECT_EQ(t.mean(2), 0);
}

/// What a kernel that waits makes of light is its own: O, and the sums stay whole.
TEST(LightPathOutputs, KernelsThatWait) {
    writeShader(
        "stepped",
        "surface stepped() { color c = trace(P, N, \"distribution\", \"cosine\", \"samplecone\", PI/2, \"samplearealights\", 1);"
        " Oi = 1; Ci = comp(c, 0) > .1 ? c : color(.2); }");
    const std::string rib = inWorld(std::string(kTwoLights) + "Surface \"stepped\"\n" + kFloor);
    const auto rays = many(kView, 500);
    expectWhole(rib, rays, {"direct", "indirect", "other"});
    const ShaderValue t = tell(rib, rays, {"CO"});
    EXPECT_NEAR(t.mean(0), t.meanBeauty(), 1e-6);
}

TEST(LightPathOutputs, HandWrittenLoopsHaveTheLabelsOfTheirLights) {
    writeShader("byhand", "surface byhand() { normal n = normalize(N); color c = 0; illuminance (P, n, PI/2) { c += Cl * "
                          "(normalize(L) . n); } Oi = 1; Ci = .5 * c; }");
    const ShaderValue t = tell(inWorld(std::string(kTwoLights) + "Surface \"byhand\"\n" + kFloor), many(kView, 200),
                               {"C<RD'illuminance'><L.'warm'>", "C<RD'illuminance'><L.'cold'>", "other"});
    EXPECT_NEAR(t.mean(0), .5, 1e-4); // 4 / 4 * .5
    EXPECT_GT(t.mean(1), 0);
    EXPECT_EQ(t.mean(2), 0);
}

TEST(LightPathOutputs, SameBitsInEveryWidth) {
    const auto rays = boxRays(500, 9);
    const ShaderValue a = tell(boxRib(true), rays, {"direct", "C<RS>.*L", "other"}, 4),
                      b = tell(boxRib(true), rays, {"direct", "C<RS>.*L", "other"}, 16);
    int differ = 0;
    for (size_t i = 0; i < rays.size(); ++i)
        for (size_t k = 0; k < a.samples[i].parts.size(); ++k)
            differ += std::memcmp(&a.samples[i].parts[k], &b.samples[i].parts[k], sizeof(Color)) != 0;
    EXPECT_EQ(differ, 0);
}

} // namespace

} // namespace lightpaths_test
