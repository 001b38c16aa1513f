// Design decision 4, row by row of docs/light.md: each light against its closed form, seen in each way a shader can look at light.
// A large white floor y = 0, a point of it at the origin, camera space = world space.
#include "transport/harness.h"

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

namespace {

void writeLooks() {
    writeShader("look_diffuse", "surface look_diffuse() { Oi = 1; Ci = diffuse(faceforward(normalize(N), I)); }\n");
    writeShader("look_loop", R"(surface look_loop() {
    normal Nf = faceforward(normalize(N), I);
    color sum = 0;
    illuminance(P, Nf, PI / 2) { sum += Cl * (normalize(L) . Nf); }
    Oi = 1;
    Ci = sum;
}
)");
    writeShader("look_trace", R"(surface look_trace() {
    normal Nf = faceforward(normalize(N), I);
    Oi = 1;
    Ci = trace(P, vector(Nf), "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1, "type", "diffuse");
}
)");
    writeShader("look_plain", R"(surface look_plain() {
    normal Nf = faceforward(normalize(N), I);
    Oi = 1;
    Ci = trace(P, vector(Nf), "distribution", "cosine", "samplecone", PI / 2, "type", "diffuse");
}
)");
    writeShader("look_specular", R"(surface look_specular(float roughness = 0.1; vector view = vector(0, 1, 0);) {
    Oi = 1;
    Ci = specularstd(normal(0, 1, 0), normalize(view), roughness);
}
)");
    writeShader("look_highlight", R"(surface look_highlight(float roughness = 0.1; vector view = vector(0, 1, 0);) {
    Oi = 1;
    Ci = specular(normal(0, 1, 0), normalize(view), roughness);
}
)");
    writeShader("look_phong", R"(surface look_phong(float size = 10; vector view = vector(0, 1, 0);) {
    Oi = 1;
    Ci = phong(normal(0, 1, 0), normalize(view), size);
}
)");
}

std::string floorScene(const std::string& lights, const std::string& look, const std::string& more = "") {
    return "WorldBegin\nSides 2\n" + lights + "AttributeBegin\nSurface " + look +
           "\nPolygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\nAttributeEnd\n" + more + "WorldEnd\n";
}
std::string areaLight(double radiance, const std::string& geometry) {
    return "AttributeBegin\nAreaLightSource \"arealight\" 7 \"float intensity\" [" + std::to_string(radiance) +
           "]\nSurface \"constant\"\nColor 0 0 0\n" + geometry + "\nAttributeEnd\nIlluminate 7 1\n";
}

// Irradiance at the origin of a plane with normal +y from a polygon of radiance 1 above it: Lambert's formula.
double lambert(const std::vector<Vec3d>& p) {
    double sum = 0;
    for (size_t i = 0; i < p.size(); ++i) {
        Vec3d a = p[i], b = p[(i + 1) % p.size()];
        Vec3d c = cross(a, b);
        double angle = std::atan2(length(c), dot(a, b));
        sum += angle * c.y / length(c);
    }
    return std::fabs(sum) / 2;
}

struct Row {
    const char* name;
    std::string lights;
    double want;       ///< diffuse(): irradiance / pi
    bool delta = true; ///< exact, no statistics
    bool area = false; ///< trace() sees it
    bool sky = false;  ///< escaping rays see it (path only)
    bool loop = true;  ///< illuminance loops visit it
};

std::vector<Row> rows() {
    std::vector<Row> r;
    auto row = [&](const char* name, std::string lights, double want) { return Row{name, std::move(lights), want}; };
    { // pointlight: I cos / d^2
        double x = .3, y = 2, z = .4, d2 = x * x + y * y + z * z;
        r.push_back(row("point", "LightSource \"pointlight\" 1 \"intensity\" 3 \"from\" [.3 2 .4]\n", 3 * y / std::sqrt(d2) / d2));
    }
    { // spotlight, on its axis and inside the inner cone: beamdistribution 2
        r.push_back(row("spot, axis", "LightSource \"spotlight\" 1 \"intensity\" 5 \"from\" [0 2 0] \"to\" [0 0 0] \"coneangle\" .5 \"conedeltaangle\" .05\n", 5 / 4.0));
        double d2 = 4 + .25, c = 2 / std::sqrt(d2);
        r.push_back(row("spot, inside", "LightSource \"spotlight\" 1 \"intensity\" 5 \"from\" [.5 2 0] \"to\" [.5 0 0] \"coneangle\" .6 \"conedeltaangle\" .1\n",
                        5 * c * c * c / d2));
        r.push_back(row("spot, outside", "LightSource \"spotlight\" 1 \"intensity\" 5 \"from\" [2 2 0] \"to\" [2 0 0] \"coneangle\" .6 \"conedeltaangle\" .1\n", 0));
    }
    r.push_back(row("distant", "LightSource \"distantlight\" 1 \"intensity\" 2 \"from\" [.6 .8 0] \"to\" [0 0 0]\n", 2 * .8));
    r.push_back(row("distant, below", "LightSource \"distantlight\" 1 \"intensity\" 2 \"from\" [.6 -.8 0] \"to\" [0 0 0]\n", 0));
    r.push_back(row("slpoint", "LightSource \"slpoint\" 1 \"intensity\" 3 \"from\" [0 2 0] \"kc\" 0 \"kq\" 1\n", 3 / kPi / 4));
    auto area = [&](const char* name, std::string lights, double want) {
        Row x = row(name, std::move(lights), want);
        x.delta = false;
        x.area = true;
        r.push_back(x);
    };
    area("rectangle", areaLight(4, "Polygon \"P\" [-.5 2 -.4  .5 2 -.4  .5 2 .6  -.5 2 .6]"),
         4 / kPi * lambert({{-.5, 2, -.4}, {.5, 2, -.4}, {.5, 2, .6}, {-.5, 2, .6}}));
    area("rectangle from behind", areaLight(4, "Polygon \"P\" [-.5 2 .6  .5 2 .6  .5 2 -.4  -.5 2 -.4]"), 0);
    area("tilted triangle", areaLight(4, "Polygon \"P\" [-1 3 .5  1 2 0  0 1 1]"), 4 / kPi * lambert({{0, 1, 1}, {1, 2, 0}, {-1, 3, .5}}));
    area("disk on the axis", areaLight(3, "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360"), 3 * .49 / (.49 + 4));
    area("sphere", areaLight(6, "Translate 1 2 0\nSphere .5 -.5 .5 360"), 6 * (.25 / 5) * 2 / std::sqrt(5.0));
    area("scaled sphere", areaLight(6, "Translate 1 2 0\nScale 1 1 1.0001\nSphere .5 -.5 .5 360"), 6 * (.25 / 5) * 2 / std::sqrt(5.0));
    {
        Row x = row("sky", "LightSource \"envlight\" 1 \"intensity\" .8\n", .8);
        x.sky = true;
        x.loop = false;
        r.push_back(x);
        x.name = "ambient";
        x.lights = "LightSource \"ambientlight\" 1 \"intensity\" .8\n";
        r.push_back(x);
    }
    return r;
}

// The eye stands between light and floor: nothing but the floor can be in its way.
const CameraRay kEye = rayTo({.4f, .8f, -.7f}, {0, 0, 0});

void look(const Row& row, const std::string& shader, Hider hider, double want) {
    Settings s;
    s.hider = hider;
    Scene scene(floorScene(row.lights, "\"" + shader + "\""), s);
    if (!scene.world) return;
    std::string what = std::string(row.name) + " by " + shader + (hider == Hider::Path ? ", path" : ", hidden");
    bool exact = row.delta;
    Moments m = scene.estimate(kEye, exact ? 4 : samples(std::string(row.name) == "scaled sphere" ? 160000 : 20000));
    // scaled sphere: 1e-4 off a sphere in one axis
    double slack = std::string(row.name) == "scaled sphere" ? 2e-4 * want : 2e-5 * want;
    EXPECT_LE(std::max(0.0, std::fabs(m.mean() - want) - slack), kZ * m.se() + 1e-9) << what << ": " << m.mean() << " +- " << m.se() << ", exact " << want;
    EXPECT_LE(m.se(), .006 * want + 1e-9) << what;
}

TEST(Units, DiffuseSeesEveryLight) {
    writeLooks();
    for (const Row& r : rows()) {
        look(r, "look_diffuse", Hider::Path, r.want);
        if (!r.sky) look(r, "look_diffuse", Hider::Hidden, r.want);
    }
}
TEST(Units, IlluminanceLoopSeesEveryLight) {
    writeLooks();
    for (const Row& r : rows()) {
        look(r, "look_loop", Hider::Path, r.loop ? r.want : 0);
        look(r, "look_loop", Hider::Hidden, r.loop ? r.want : 0);
    }
}
TEST(Units, TraceSeesWhatRaysCanMeet) {
    writeLooks();
    for (const Row& r : rows()) {
        look(r, "look_trace", Hider::Path, r.area || r.sky ? r.want : 0);
        if (r.area) look(r, "look_trace", Hider::Raytrace, r.want);
    }
}
// Without light samples the same value comes from the lobe's rays alone; far noisier, so one easy light.
TEST(Units, TraceWithoutLightSamples) {
    writeLooks();
    Settings s;
    s.hider = Hider::Path;
    Scene scene(floorScene(areaLight(1, "Translate 0 1 0\nRotate 90 1 0 0\nDisk 0 2 360"), "\"look_plain\""), s);
    expectMean(scene.estimate(kEye, samples(20000)), 4 / 5.0, .006, "disk by rays alone");
}

// A light in the mirror direction: every highlight is 1 there and gives Cl itself.
TEST(Units, HighlightsAtTheMirrorDirection) {
    writeLooks();
    for (const char* shader : {"look_specular", "look_highlight", "look_phong"})
        for (Hider h : {Hider::Hidden, Hider::Path}) {
            Settings s;
            s.hider = h;
            Scene point(floorScene("LightSource \"pointlight\" 1 \"intensity\" 3 \"from\" [.6 .8 0]\n", std::string("\"") + shader + "\" \"vector view\" [-.6 .8 0]"), s);
            EXPECT_NEAR(point.one(kEye).x, 3, 3e-4) << shader;
            Scene distant(floorScene("LightSource \"distantlight\" 1 \"intensity\" 2 \"from\" [.6 .8 0] \"to\" [0 0 0]\n", std::string("\"") + shader + "\" \"vector view\" [-.6 .8 0]"), s);
            EXPECT_NEAR(distant.one(kEye).x, 2, 2e-4) << shader;
        }
}
// Lobes seen straight on: integral of cos^e under a sky, and over a disk on the axis.
TEST(Units, HighlightsOfWideLights) {
    writeLooks();
    Settings s;
    s.hider = Hider::Path;
    const double e = 10;
    std::string sky = "LightSource \"envlight\" 1 \"intensity\" .8\n", disk = areaLight(3, "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360");
    double edge = 2 / std::sqrt(4.49), half = std::sqrt((1 + edge) / 2);
    Scene a(floorScene(sky, "\"look_phong\" \"size\" 10"), s);
    expectMean(a.estimate(kEye, samples(20000)), .8 * 2 / (e + 1), .006, "phong under a sky");
    Scene b(floorScene(disk, "\"look_phong\" \"size\" 10"), s);
    expectMean(b.estimate(kEye, samples(20000)), 3 * 2 * (1 - std::pow(edge, e + 1)) / (e + 1), .006, "phong under a disk");
    // Blinn seen straight on: N.H = cos(theta / 2), so 8 / (e + 2) (1 - cosHalf^(e + 2)).
    Scene c(floorScene(sky, "\"look_specular\" \"roughness\" .1"), s);
    expectMean(c.estimate(kEye, samples(20000)), .8 * 8 / (e + 2) * (1 - std::pow(.5, (e + 2) / 2)), .006, "specularstd under a sky");
    Scene d(floorScene(disk, "\"look_specular\" \"roughness\" .1"), s);
    expectMean(d.estimate(kEye, samples(20000)), 3 * 8 / (e + 2) * (1 - std::pow(half, e + 2)), .006, "specularstd under a disk");
}

// T5 c: a half-plane through the axis takes exactly half of a light that is symmetric about it.
TEST(Irradiance, HalfPlaneTakesHalf) {
    writeLooks();
    std::string blocker = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [0 1 -50  50 1 -50  50 1 50  0 1 50]\nAttributeEnd\n";
    CameraRay eye = rayTo({-.4f, .5f, -.3f}, {0, 0, 0});
    for (const char* geometry : {"Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360", "Translate 0 2 0\nSphere .5 -.5 .5 360"}) {
        Settings s;
        s.hider = Hider::Path;
        Scene open(floorScene(areaLight(5, geometry), "\"look_diffuse\""), s), blocked(floorScene(areaLight(5, geometry), "\"look_diffuse\"", blocker), s);
        Moments m = blocked.estimate(eye, samples(40000));
        double whole = std::string(geometry).find("Disk") != std::string::npos ? 5 * .49 / 4.49 : 5 * .25 / 4;
        expectMean(open.estimate(eye, samples(20000)), whole, .006, geometry);
        expectMean(m, whole / 2, .01, geometry);
    }
}

// Under "path" point lights cast shadows; what is half transparent takes half.
TEST(Irradiance, ShadowsOfPointLights) {
    writeLooks();
    auto blocker = [](const char* opacity) {
        return std::string("AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nOpacity ") + opacity + "\nPolygon \"P\" [-5 1 -5  5 1 -5  5 1 5  -5 1 5]\nAttributeEnd\n";
    };
    std::string light = "LightSource \"pointlight\" 1 \"intensity\" 4 \"from\" [0 2 0]\n";
    CameraRay eye = rayTo({.3f, .5f, -.3f}, {0, 0, 0});
    Settings s;
    s.hider = Hider::Path;
    s.indirect = false;
    EXPECT_EQ(Scene(floorScene(light, "\"look_diffuse\"", blocker("1 1 1")), s).one(eye).x, 0);
    Color half = Scene(floorScene(light, "\"look_diffuse\"", blocker(".5 .25 0")), s).one(eye);
    EXPECT_NEAR(half.x, .5, 1e-5);
    EXPECT_NEAR(half.y, .75, 1e-5);
    EXPECT_NEAR(half.z, 1, 1e-5);
    s.hider = Hider::Hidden; // as in 1990: no shadow unless somebody asks for one
    EXPECT_NEAR(Scene(floorScene(light, "\"look_diffuse\"", blocker("1 1 1")), s).one(eye).x, 1, 1e-5);
}

// A light that is off for a surface gives it nothing: neither samples nor rays that meet it by chance.
TEST(Irradiance, IlluminateOff) {
    writeLooks();
    for (const char* shader : {"look_diffuse", "look_loop", "look_trace"}) {
        Settings s;
        s.hider = Hider::Path;
        Scene scene(floorScene(areaLight(5, "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 1 360") + "Illuminate 7 0\n", std::string("\"") + shader + "\""), s);
        Moments m = scene.estimate(kEye, 2000);
        EXPECT_EQ(m.mean(), 0) << shader;
    }
}

} // namespace
