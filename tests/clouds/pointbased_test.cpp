// occlusion(), indirectdiffuse() and subsurface() of point clouds, against rays and closed forms, through scenes.
#include "cli/command_folder.h"
#include "clouds/hemisphere.h"
#include "clouds/limits.h"
#include "clouds/make.h"
#include "display/imageio.h"
#include <random>

namespace pointbased_test {

namespace {

using namespace alpenglow;
using clouds::DiskSides;
using clouds::HemisphereQuery;
using clouds::PointCloud;
using clouds::PointOctree;

// ---- the octree and the hemisphere alone ----

/// Squares of a rectangle about a middle, with half sides a and b; light (r, g, b).
void addRectangle(PointCloud& c, const Vec3& middle, const Vec3& a, const Vec3& b, int n, const Color& light = Color(1)) {
    if (c.channels.empty()) c.channels = {{"_area", clouds::ChannelType::Float}, {"_radiosity", clouds::ChannelType::Color}};
    const Vec3 normal = normalize(cross(a, b));
    const float area = 4 * length(cross(a, b)) / float(n * n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Vec3 p = middle + a * (float(2 * i + 1) / float(n) - 1) + b * (float(2 * j + 1) / float(n) - 1);
            const float row[4] = {area, light.x, light.y, light.z};
            c.add(p, normal, std::sqrt(area / 2), row);
        }
}

struct Seen {
    float blocked;
    Color light;
};
Seen look(const PointCloud& c, HemisphereQuery q) {
    clouds::Hemisphere h;
    const PointOctree o(c, "_radiosity");
    h.begin(q);
    h.add(o);
    h.finish();
    return {h.blocked(), h.light()};
}

/// The form factor of a rectangle, from a point below one corner, at height h, sides a and b (Howell's catalogue, B-3).
double cornerFactor(double a, double b, double h) {
    const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

// A square straight above: four corners of a known factor. Clusters are squares of up to .1 steradian at the default, which do
// not fit together exactly: up to .03 is between them; a fifth of that angle has a third of it.
TEST(PointBased, ARectangleHasItsFormFactor) {
    for (const float height : {.3f, 1.f, 3.f}) {
        PointCloud c;
        addRectangle(c, {0, 0, height}, {1, 0, 0}, {0, -1, 0}, 40, Color(.2f, .4f, .8f));
        const double exact = 4 * cornerFactor(1, 1, height);
        for (const float solid : {.1f, .02f, .004f}) {
            HemisphereQuery q;
            q.N = {0, 0, 1};
            q.maxSolidAngle = solid;
            const Seen s = look(c, q);
            EXPECT_NEAR(s.blocked, exact, solid > .05f ? .03 : .012) << height << " " << solid;
            EXPECT_NEAR(s.light.y, .4 * s.blocked, .004);
        }
    }
}

// From inside of a closed ball nothing is open, but for what is between clusters (.05); and with sides the other way nothing
// blocks.
TEST(PointBased, AClosedBallClosesAll) {
    PointCloud c;
    c.channels = {{"_area", clouds::ChannelType::Float}, {"_radiosity", clouds::ChannelType::Color}};
    const int n = 10000;
    for (int i = 0; i < n; ++i) {
        const double z = 1 - (2 * i + 1) / double(n), t = i * 2.399963229728653, r = std::sqrt(1 - z * z);
        const Vec3 d(float(r * std::cos(t)), float(r * std::sin(t)), float(z));
        const float row[4] = {float(4 * kPi / n), 1, .5f, 0};
        c.add(d, d, .02f, row);
    }
    for (const Vec3& at : {Vec3(0, 0, 0), Vec3(.5f, .2f, -.3f), Vec3(0, 0, .95f)}) {
        HemisphereQuery q;
        q.P = at;
        q.N = normalize(Vec3(1, 2, 3));
        const Seen s = look(c, q);
        EXPECT_NEAR(s.blocked, 1, .05);
        EXPECT_NEAR(s.light.x, s.blocked, 1e-4);
        EXPECT_NEAR(s.light.y, .5 * s.blocked, 1e-4);
        q.sides = DiskSides::Back;
        EXPECT_NEAR(look(c, q).blocked, 1, .05) << "seen from behind";
        q.sides = DiskSides::Front;
        EXPECT_LT(look(c, q).blocked, .1) << "harmonics of two bands leave a little";
        q.sides = DiskSides::Both;
        q.maxDistance = .01f;
        EXPECT_LT(look(c, q).blocked, .01);
    }
}

// More parts of clusters than a sorted lookup keeps (limits::kCloudFragments): neighbours become one, and what is near still
// hides what is behind. The part that is hidden is the form factor of a square, two of which look alike large here.
TEST(PointBased, SortedLookupsOfManyPointsAreBounded) {
    constexpr int kSide = 800;
    static_assert(size_t(2 * kSide * kSide) > limits::kCloudFragments);
    PointCloud c;
    addRectangle(c, {0, 0, 1}, {8, 0, 0}, {0, -8, 0}, kSide, Color(1, 0, 0));
    addRectangle(c, {0, 0, 2}, {16, 0, 0}, {0, -16, 0}, kSide, Color(0, 1, 0));
    HemisphereQuery q;
    q.N = {0, 0, 1};
    q.sort = true;
    q.maxSolidAngle = 1e-6f;
    const Seen seen = look(c, q);
    const double x = 8 / std::sqrt(65.), part = 2 / 3.14159265 * 2 * x * std::atan(x);
    EXPECT_NEAR(seen.blocked, part, .01);
    EXPECT_NEAR(seen.light.x, part, .03) << "toward the horizon a pixel holds many points of both";
    EXPECT_NEAR(seen.light.y, 0, .03);
}

// The same with many layers, each of which hides what is behind it: what lies behind the first three is seen nowhere, however
// many.
TEST(PointBased, SortedLookupsOfManyLayersShowTheFirst) {
    const auto shells = [](int count) {
        PointCloud c;
        c.channels = {{"_area", clouds::ChannelType::Float}, {"_radiosity", clouds::ChannelType::Color}};
        const int n = 14000;
        for (int k = 0; k < count; ++k)
            for (int i = 0; i < n; ++i) {
                const double z = 1 - (i + .5) / n, t = i * 2.399963229728653 + k, s = std::sqrt(1 - z * z);
                const Vec3 d(float(s * std::cos(t)), float(s * std::sin(t)), float(z));
                const float r = 1 + .1f * float(k), area = float(2 * kPi / n) * r * r;
                const float row[4] = {area, k == 0 ? 1.f : 0.f, 0, k == 0 ? 0.f : 1.f};
                c.add(d * r, -d, std::sqrt(area / 2), row);
            }
        return c;
    };
    HemisphereQuery q;
    q.N = {0, 0, 1};
    q.sort = true;
    q.maxSolidAngle = 1e-6f;
    const Seen few = look(shells(3), q), many = look(shells(40), q);
    EXPECT_NEAR(few.blocked, 1, .01);
    EXPECT_GT(few.light.x, .8);
    EXPECT_NEAR(many.blocked, 1, .01);
    EXPECT_NEAR(many.light.x, few.light.x, .02);
    EXPECT_NEAR(many.light.z, few.light.z, .02);
}

TEST(PointBased, ParametersDoWhatTheySay) {
    PointCloud c;
    addRectangle(c, {0, 0, 1}, {8, 0, 0}, {0, -8, 0}, 160, Color(1, 0, 0));
    addRectangle(c, {0, 0, 2}, {16, 0, 0}, {0, -16, 0}, 160, Color(0, 1, 0));
    HemisphereQuery q;
    q.N = {0, 0, 1};
    q.cone = .5f;
    const Seen together = look(c, q);
    EXPECT_NEAR(together.blocked, 1, 1e-4);
    q.sort = true;
    const Seen sorted = look(c, q);
    EXPECT_NEAR(sorted.light.x, 1, .1) << "what is near hides what is behind";
    EXPECT_NEAR(sorted.light.y, 0, .1);
    q.sort = false;
    q.clamp = false;
    EXPECT_NEAR(look(c, q).blocked, 2, .15);
    q.clamp = true;
    q.maxDistance = 1.8f;
    EXPECT_NEAR(look(c, q).light.x, 1, .05);
    q.maxDistance = 1e38f;
    q.bias = 1.2f;
    EXPECT_NEAR(look(c, q).light.y, 1, .06);
    // exp(-d / 2) over the cone of half angle .5 by the cosine, d = 1 / cos.
    PointCloud one;
    addRectangle(one, {0, 0, 1}, {8, 0, 0}, {0, -8, 0}, 160);
    q.bias = 0;
    q.fall = .5f;
    double sum = 0, weight = 0;
    for (int i = 0; i < 1000; ++i) {
        const double t = .5 * (i + .5) / 1000, w = std::sin(t) * std::cos(t);
        sum += w * std::exp(-.5 / std::cos(t)), weight += w;
    }
    EXPECT_NEAR(look(one, q).blocked, sum / weight, .02);
    q.fall = 0;
    q.cone = 1.57079633f;
    q.axis = {1, 0, 0};
    EXPECT_NEAR(look(one, q).blocked, look(one, HemisphereQuery{.N = {0, 0, 1}}).blocked, .02)
        << "half of it, which is like the other";
}

TEST(PointBased, WhatIsNoPoint) {
    EXPECT_TRUE(PointOctree(PointCloud{}, "").nodes().empty());
    PointCloud c = clouds::test::square(4);
    for (float& r : c.radius) r = 0;
    const PointOctree none(c, "c");
    EXPECT_EQ(none.leftOut(), 16u);
    EXPECT_TRUE(none.nodes().empty());
    PointCloud same; // all in one place: a leaf
    for (int i = 0; i < 1000; ++i) same.add({1, 2, 3}, {0, 0, 1}, .1f, {});
    const PointOctree o(same, "");
    EXPECT_EQ(o.points().size(), 1000u);
    EXPECT_LT(o.nodes().size(), 30u);
    EXPECT_LT(o.bytes(), 1000u * 100);
    same.P[3].x = NAN;
    EXPECT_EQ(PointOctree(same, "").leftOut(), 1u);
    same.radius[5] = 1e25f; // its area has no float
    const PointOctree left(same, "");
    EXPECT_EQ(left.leftOut(), 2u);
    EXPECT_TRUE(std::isfinite(left.nodes()[0].centre.x) && std::isfinite(left.nodes()[0].area));
    for (const Vec3& far :
         {Vec3(1e25f, 1e25f, 1e25f), Vec3(0, 0, 3e38f), Vec3(1e19f, 0, 2e19f)}) { // as one point, and as one of many
        HemisphereQuery q;
        q.N = {0, 0, 1};
        PointCloud one;
        one.add(far, {0, 0, -1}, .1f, {});
        EXPECT_EQ(look(one, q).blocked, 0);
        for (int i = 0; i < 100; ++i) one.add(far, {0, 0, -1}, 1e18f, {});
        const Seen s = look(one, q);
        EXPECT_TRUE(s.blocked >= 0 && s.blocked <= 1);
    }
}

// ---- scenes ----

std::string quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    std::string s = "Polygon \"P\" [";
    for (const Vec3& p : {a, b, c, d}) s += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + " ";
    return s + "]\n";
}
std::string box(float x0, float y0, float z0, float x1, float y1, float z1) {
    const Vec3 p[] = {{x0, y0, z0}, {x1, y0, z0}, {x1, y1, z0}, {x0, y1, z0},
                      {x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1}};
    const int f[6][4] = {{0, 1, 2, 3}, {5, 4, 7, 6}, {4, 0, 3, 7}, {1, 5, 6, 2}, {3, 2, 6, 7}, {4, 5, 1, 0}};
    std::string s;
    for (const auto& q : f) s += quad(p[q[0]], p[q[1]], p[q[2]], p[q[3]]);
    return s;
}
std::string ball(float x, float y, float z, float r) {
    const std::string t = std::to_string(r);
    return "TransformBegin Translate " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " Sphere " + t +
           " -" + t + " " + t + " 360 TransformEnd\n";
}

std::vector<std::pair<std::string, std::string>> scenes() {
    const std::string floor = quad({-3, -1, -3}, {3, -1, -3}, {3, -1, 3}, {-3, -1, 3});
    std::string city = floor, stairs, pearls = floor;
    const float houses[7][3] = {{-1.5f, -1, 1},     {-.7f, .5f, 1.6f},   {.2f, -.8f, .7f}, {1.1f, .4f, 1.3f},
                                {1.7f, -1.2f, .5f}, {-1.9f, 1.2f, 1.9f}, {.3f, 1.5f, 2}};
    for (const auto& h : houses) city += box(h[0] - .25f, -1, h[1] - .25f, h[0] + .25f, -1 + h[2], h[1] + .25f);
    for (int i = 0; i < 5; ++i) stairs += box(-2, -1, float(i) * .5f - 1, 2, -1 + .3f * float(i + 1), float(i) * .5f - .5f);
    for (int x = -3; x < 4; ++x)
        for (int z = -3; z < 4; ++z) pearls += ball(float(x) * .6f, -.75f, float(z) * .6f, .25f);
    const std::string walls =
        quad({-2, -1, -2}, {2, -1, -2}, {2, -1, 2}, {-2, -1, 2}) + quad({-2, -1, 2}, {2, -1, 2}, {2, 2, 2}, {-2, 2, 2}) +
        quad({-2, -1, -2}, {-2, -1, 2}, {-2, 2, 2}, {-2, 2, -2}) + quad({2, -1, 2}, {2, -1, -2}, {2, 2, -2}, {2, 2, 2}) +
        quad({-2, 2, 2}, {2, 2, 2}, {2, 2, -2}, {-2, 2, -2});
    return {{"ball", floor + ball(0, 0, 0, 1)},
            {"two balls", ball(-1, 0, 0, 1) + ball(1, 0, 0, 1)},
            {"corner", floor + quad({-3, -1, 3}, {3, -1, 3}, {3, 4, 3}, {-3, 4, 3}) +
                           quad({-3, -1, -3}, {-3, -1, 3}, {-3, 4, 3}, {-3, 4, -3})},
            {"torus", floor + "TransformBegin Translate 0 -.6 0 Rotate 90 1 0 0 Torus 1.2 .4 0 360 360 TransformEnd\n"},
            {"planes", quad({-2, -.6f, -2}, {2, -.6f, -2}, {2, -.6f, 2}, {-2, -.6f, 2}) +
                           quad({-2, .2f, -2}, {2, .2f, -2}, {2, .2f, 2}, {-2, .2f, 2})},
            {"tube", "TransformBegin Rotate 50 0 1 0 Cylinder 1 -1.5 1.5 360 TransformEnd\n"},
            {"city", city},
            {"bowl", "TransformBegin Rotate -30 1 0 0 Sphere 1.5 0 1.5 360 TransformEnd\n"},
            {"cone", floor + "TransformBegin Translate 0 -1 0 Rotate -90 1 0 0 Cone 2 1 360 TransformEnd\nTransformBegin "
                             "Translate 1.5 -1 .5 Rotate -90 1 0 0 Cylinder .4 0 1.5 360 TransformEnd\n"},
            {"stairs", stairs},
            {"pearls", pearls},
            {"room", walls + ball(.6f, -.4f, .5f, .6f) + box(-1.3f, -1, -.2f, -.4f, .6f, .7f)}};
}

class PointScenes : public cli::testing::CommandFolder {
protected:
    static constexpr int kSide = 32;
    const std::string camera = "Projection \"perspective\" \"fov\" 40\nTranslate 0 -.1 6\nRotate -15 1 0 0\n";
    std::string header(const std::string& name, int side) const {
        const std::string n = std::to_string(side);
        return "Format " + n + " " + n +
               " 1\nPixelSamples 1 1\nPixelFilter \"box\" 1 1\nHider \"hidden\" \"jitter\" [0]\nDisplay \"" + name +
               "\" \"openexr\" \"rgba\"\n";
    }
    void shader(const std::string& name, const std::string& parameters, const std::string& body) const {
        write(name + ".sl",
              "surface " + name + "(" + parameters + ") { Oi = 1; normal n = faceforward(normalize(N), I); " + body + " }\n");
    }
    void render(const std::string& text) {
        write("s.rib", text);
        const std::string said = run("render s.rib", "2>&1");
        EXPECT_EQ(said.find("error: "), std::string::npos) << said;
        EXPECT_EQ(said.find("warning: "), std::string::npos) << said;
        EXPECT_EQ(status, 0) << said;
    }
    void bake(const std::string& geometry, const std::string& surface = "Surface \"baker\"\n", const std::string& before = "") {
        render(header("bake.exr", 120) + camera + "WorldBegin\n" + before + surface + geometry + "WorldEnd\n");
    }
    std::vector<float> picture(const std::string& geometry, const std::string& surface, const std::string& before = "") {
        render(header("a.exr", kSide) + camera + "WorldBegin\n" + before + surface + geometry + "WorldEnd\n");
        Diagnostics d;
        const auto image = display::readImage((dir / "a.exr").string(), d);
        return image ? image->data : std::vector<float>{};
    }
    /// The mean of what they differ by, over covered pixels and three channels.
    static double meanError(const std::vector<float>& a, const std::vector<float>& b) {
        EXPECT_EQ(a.size(), b.size());
        double sum = 0, count = 0;
        for (size_t i = 0; i + 3 < std::min(a.size(), b.size()); i += 4)
            if (a[i + 3] > 0)
                for (size_t k = 0; k < 3; ++k) sum += std::fabs(double(a[i + k]) - double(b[i + k])), ++count;
        EXPECT_GT(count, 300);
        return sum / count;
    }
};

// The proof of issue 15: twelve scenes against rays, 400 of them for each pixel, whose own error is about .005.
TEST_F(PointScenes, OcclusionOfTwelveScenesIsThatOfRays) {
    shader("baker", "", "bake3d(\"o.ptc\", \"\", P, normalize(N), \"interpolate\", 1); Ci = 1;");
    shader("traced", "", "Ci = occlusion(P, n, 400);");
    shader("points", "float a = .1;",
           "Ci = occlusion(P, n, 1, \"pointbased\", 1, \"filename\", \"o.ptc\", \"maxsolidangle\", a);");
    shader("standard", "", "Ci = occlusion(P, n, 1, \"pointbased\", 1, \"filename\", \"o.ptc\");");
    double sums[3] = {};
    for (const auto& [name, geometry] : scenes()) {
        bake(geometry);
        const auto rays = picture(geometry, "Surface \"traced\"\n");
        const char* calls[3] = {"Surface \"points\" \"a\" [.5]\n", "Surface \"standard\"\n", "Surface \"points\" \"a\" [.02]\n"};
        double e[3];
        for (int k = 0; k < 3; ++k) sums[k] += e[k] = meanError(rays, picture(geometry, calls[k]));
        std::printf("%-10s %.4f %.4f %.4f\n", name.c_str(), e[0], e[1], e[2]);
        EXPECT_LT(e[1], .03) << name;
    }
    std::printf("mean       %.4f %.4f %.4f\n", sums[0] / 12, sums[1] / 12, sums[2] / 12);
    EXPECT_LT(sums[1], sums[0]) << "smaller angles are truer";
    EXPECT_LT(sums[2], sums[1]);
}

// Light that a red wall sends to a white floor: by rays, and by points that hold what the wall sends.
TEST_F(PointScenes, ColoursBleedAsByRays) {
    const std::string wall = quad({-2, -1, 1.5f}, {2, -1, 1.5f}, {2, 2, 1.5f}, {-2, 2, 1.5f});
    const std::string floor = quad({-2, -1, -2}, {2, -1, -2}, {2, -1, 1.5f}, {-2, -1, 1.5f});
    const std::string ofWall = "Color [.9 .3 .1]\n" + wall + "Color [0 .5 .2]\n" + ball(-.8f, -.4f, .4f, .6f);
    shader("baker", "", "bake3d(\"o.ptc\", \"\", P, normalize(N), \"interpolate\", 1, \"_radiosity\", Cs); Ci = Cs;");
    shader("plain", "", "Ci = Cs;");
    shader("traced", "", "Ci = indirectdiffuse(P, n, 1024);");
    shader("points", "float on = 1; string f[] = {\"o.ptc\"};",
           "float o = 5; color e = 5; Ci = indirectdiffuse(P, n, 1, \"pointbased\", on, \"filenames\", f, \"occlusion\", o, "
           "\"environmentcolor\", e, \"sortbleeding\", 1); if (o > 1 || e != 0) Ci = 9;");
    bake(ofWall);
    const auto both = [&](const char* s) { return picture("Surface \"plain\"\n" + ofWall + "Surface \"" + s + floor, ""); };
    const auto rays = both("traced\"\n"), points = both("points\"\n"), off = both("points\" \"on\" 0\n");
    EXPECT_LT(meanError(rays, points), .02);
    EXPECT_GT(meanError(rays, off), meanError(rays, points)) << "one ray a point where it is switched off";
}

// PRMan 12 and Aqsis knew no "pointbased": a file and no samples meant it.
TEST_F(PointScenes, AFileAndNoSamplesMeanPoints) {
    const std::string floor = quad({-2, -1, -2}, {2, -1, -2}, {2, -1, 1.5f}, {-2, -1, 1.5f}),
                      ofBall = "Color [.9 .3 .1]\n" + ball(-.8f, -.4f, .4f, .6f);
    shader("baker", "", "bake3d(\"o.ptc\", \"\", P, normalize(N), \"interpolate\", 1, \"_radiosity\", Cs); Ci = Cs;");
    shader("points", "",
           "Ci = .1 + indirectdiffuse(P, n, 0, \"pointbased\", 1, \"filename\", \"o.ptc\") + occlusion(P, n, 0, \"pointbased\", "
           "1, \"filename\", \"o.ptc\");");
    shader("old", "",
           "Ci = .1 + indirectdiffuse(P, n, 0, \"filename\", \"o.ptc\") + occlusion(P, n, 0, \"filename\", \"o.ptc\");");
    shader("asked", "string f = \"o.ptc\"; float most = 0;",
           "Ci = .1 + indirectdiffuse(P, n, most, \"filename\", f) + occlusion(P, n, most, \"filename\", f);");
    bake(ofBall);
    const auto points = picture(floor, "Surface \"points\"\n");
    EXPECT_EQ(points, picture(floor, "Surface \"old\"\n"));
    EXPECT_EQ(points, picture(floor, "Surface \"asked\"\n"));
    EXPECT_NE(points, picture(floor, "Surface \"asked\" \"most\" 16\n")) << "rays: there is no ball in this world";
    EXPECT_NE(points, picture(floor, "Surface \"asked\" \"f\" [\"\"]\n"));
}

// A closed room whose walls have the albedo .6 and shine by 1: what arrives after n bounces is the sum of a geometric series.
TEST_F(PointScenes, BouncesAddUpAsTheSeriesSays) {
    const std::string walls = ball(0, 0, 0, 4); // the camera is inside
    write("begin.sl", "surface begin() { Oi = 1; Ci = 1; bake3d(\"b0.ptc\", \"\", P, -normalize(N), \"interpolate\", 1, "
                      "\"_radiosity\", color(1)); }\n");
    write("next.sl", "surface next(string from = \"\", to = \"\";) { Oi = 1; color e = indirectdiffuse(P, -normalize(N), 1, "
                     "\"pointbased\", 1, \"filename\", from, \"maxsolidangle\", .04); Ci = e;"
                     " bake3d(to, \"\", P, -normalize(N), \"interpolate\", 1, \"_radiosity\", 1 + .6 * e); }\n");
    const auto frame = [&](const std::string& surface) {
        render(header("a.exr", 24) + "Projection \"perspective\" \"fov\" 90\nWorldBegin\nShadingRate 1\nSurface " + surface +
               "\n" + walls + "WorldEnd\n");
    };
    frame("\"begin\"");
    double want = 1;
    for (int n = 1; n <= 2; ++n) {
        frame("\"next\" \"from\" \"b" + std::to_string(n - 1) + ".ptc\" \"to\" \"b" + std::to_string(n) + ".ptc\"");
        Diagnostics d;
        const auto image = display::readImage((dir / "a.exr").string(), d);
        ASSERT_TRUE(image);
        double mean = 0;
        for (size_t i = 0; i < image->data.size(); i += 4) mean += double(image->data[i]) * 4 / double(image->data.size());
        EXPECT_NEAR(mean, want, .045 * n * want)
            << n << ": up to .045 of the light is between clusters and long disks, each time";
        want = 1 + .6 * want;
    }
    run("ptc bounce --albedo .6 --bounces 2 --solid-angle .04 b0.ptc b2t.ptc", "2>&1");
    EXPECT_EQ(status, 0);
    Diagnostics d;
    const auto tool = clouds::loadCloud((dir / "b2t.ptc").string(), d), stream = clouds::loadCloud((dir / "b2.ptc").string(), d);
    ASSERT_TRUE(tool && stream);
    const auto mean = [](const PointCloud& c) {
        double s = 0;
        for (size_t i = 0; i < c.size(); ++i) s += double(c.valuesOf(i)[size_t(c.offsetOf("_radiosity"))]) / double(c.size());
        return s;
    };
    EXPECT_NEAR(mean(*tool), mean(*stream), .02 * mean(*stream)) << "the tool does what frames do";
}

// A large plane in even light: what leaves is what the diffusion model gives back of it, whatever the sizes of the disks.
TEST_F(PointScenes, SubsurfaceOfAPlaneInEvenLight) {
    shader("lit", "", "Ci = 1; bake3d(\"s.ptc\", \"\", P, normalize(N), \"interpolate\", 1, \"_radiosity\", color(1));");
    shader("below", "float path = .1; string f = \"s.ptc\", t = \"pointcloud\";",
           "Ci = subsurface(P, n, \"type\", t, \"filename\", f, \"reflectance\", color(.8, .5, .2), \"meanfreepath\", path, "
           "\"model\", \"jensen\", \"maxsolidangle\", .05);");
    const std::string plane = quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
    bake(plane, "Surface \"lit\"\n");
    for (const char* path : {".02", ".1", ".15"}) {
        const auto p = picture(plane, std::string("Surface \"below\" \"path\" ") + path + "\n");
        ASSERT_FALSE(p.empty());
        const float* middle = &p[size_t(kSide * kSide / 2 + kSide / 2) * 4];
        const double want[3] = {.8, .5, .2};
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(middle[k], want[k], .05 * want[k]) << path;
    }
}

// Half of a plane is lit: the profile behind the edge is the dipole's integral, and what rays find.
TEST_F(PointScenes, SubsurfaceSpreadsAsByRays) {
    shader("lit", "",
           "point p = transform(\"world\", P); color e = xcomp(p) < 0 ? color(1) : color(0); Ci = e; bake3d(\"s.ptc\", \"\", P, "
           "normalize(N), \"interpolate\", 1, \"_radiosity\", e);");
    const std::string call = "\"reflectance\", color(.8, .5, .2), \"meanfreepath\", .3, \"model\", \"jensen\"";
    shader("below", "", "Ci = subsurface(\"pointcloud\", P, n, \"filename\", \"s.ptc\", " + call + ");");
    shader("rays", "", "Ci = subsurface(P, n, \"samples\", 1024, " + call + ");");
    write("left.sl", "light left() { solar(vector \"world\" (0, 0, 1), 0) Cl = xcomp(transform(\"world\", Ps)) < 0 ? 1 : 0; }\n");
    const std::string plane = quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
    const std::string upright = "TransformBegin Rotate 15 1 0 0 LightSource \"left\" 1 TransformEnd\n";
    bake(plane, "Surface \"lit\"\n");
    const auto points = picture(plane, "Surface \"below\"\n"),
               rays = picture(plane, "Surface \"rays\"\n", "LightSource \"left\" 1\n");
    EXPECT_LT(meanError(points, rays), .02);
    (void)upright;
}

TEST_F(PointScenes, WhatCannotBeReadIsSaidOnce) {
    shader("points", "string f = \"\";",
           "Ci = occlusion(P, n, 1, \"pointbased\", 1, \"filename\", f) + indirectdiffuse(P, n, 1, \"pointbased\", 1, "
           "\"filename\", f);");
    Diagnostics d;
    PointCloud none;
    none.channels = {{"_area", clouds::ChannelType::Float}};
    const OutputPolicy here{dir.string(), true, -1};
    clouds::saveCloud((dir / "none.ptc").string(), none, here, d);
    PointCloud flat = clouds::test::square(4);
    for (float& r : flat.radius) r = 0;
    clouds::saveCloud((dir / "flat.ptc").string(), flat, here, d);
    clouds::saveBrickMap((dir / "b.bkm").string(), clouds::test::square(4), here, d);
    write("bad.ptc", "this is no cloud");
    const std::pair<const char*, const char*> cases[] = {
        {"", "names no point cloud"},  {"missing.ptc", "there is no point cloud"},
        {"none.ptc", "has no points"}, {"flat.ptc", "16 points without area"},
        {"b.bkm", "is a brick map"},   {"bad.ptc", "it is no point cloud"}};
    for (const auto& [file, word] : cases) {
        write("s.rib", header("a.exr", 8) + camera + "WorldBegin\nSurface \"points\" \"f\" \"" + file +
                           "\"\nSphere 1 -1 1 360\nWorldEnd\n");
        const std::string said = run("render s.rib", "2>&1");
        const size_t at = said.find(word);
        EXPECT_NE(at, std::string::npos) << file << said;
        size_t count = 0;
        for (size_t i = at; i != std::string::npos; i = said.find(word, i + 1)) ++count;
        EXPECT_LE(count, 2u) << "once for each shadeop at most: " << said;
        EXPECT_LT(status, 128);
    }
}

// Names of clouds in other ways, and in another space: the plane is the same wherever the file has it.
TEST_F(PointScenes, SpacesAndSeveralClouds) {
    write("lit.sl", "surface lit() { Oi = 1; Ci = 1; bake3d(\"w.ptc\", \"\", P, normalize(N), \"interpolate\", 1, "
                    "\"_radiosity\", color(1)); bake3d(\"c.ptc\", \"\", P, normalize(N), \"interpolate\", 1, \"coordsystem\", "
                    "\"camera\", \"_radiosity\", color(1)); }\n");
    write("asks.sl",
          "surface asks(string f[] = {\"w.ptc\"}; float which = 0;) { Oi = 1; color a = subsurface(P, N, \"type\", "
          "\"pointcloud\", \"filename\", \"w.ptc\", \"maxsolidangle\", .05, \"reflectance\", .5, \"meanfreepath\", .1);\n"
          " color b = subsurface(P, N, \"type\", \"pointcloud\", \"filenames\", f, \"coordsystem\", \"world\", "
          "\"maxsolidangle\", .05, \"reflectance\", .5, \"meanfreepath\", .1);\n"
          " color c = subsurface(P, N, \"type\", \"pointcloud\", \"filename\", \"c.ptc\", \"coordsystem\", \"camera\", "
          "\"maxsolidangle\", .05, \"reflectance\", .5, \"meanfreepath\", .1);\n"
          " Ci = which == 0 ? a : which == 1 ? b : c; }\n");
    const std::string plane = quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
    bake(plane, "Surface \"lit\"\n");
    const auto a = picture(plane, "Surface \"asks\" \"which\" 0\n"), b = picture(plane, "Surface \"asks\" \"which\" 1\n"),
               c = picture(plane, "Surface \"asks\" \"which\" 2\n");
    EXPECT_TRUE(a == b);
    EXPECT_LT(meanError(a, c), .01);
    EXPECT_NEAR(a[size_t(kSide * kSide / 2 + kSide / 2) * 4], .5, .025);
}

// Points do not see threads.
TEST_F(PointScenes, SameBitsForAllThreads) {
    shader("baker", "", "bake3d(\"o.ptc\", \"\", P, normalize(N), \"interpolate\", 1, \"_radiosity\", Cs); Ci = 1;");
    shader("points", "",
           "Ci = indirectdiffuse(P, n, 1, \"pointbased\", 1, \"filename\", \"o.ptc\") + occlusion(P, n, 1, \"pointbased\", 1, "
           "\"filename\", \"o.ptc\");");
    const std::string geometry = scenes()[8].second;
    bake(geometry);
    std::vector<float> first;
    for (const char* threads : {"1", "2", "8"}) {
        write("s.rib", header("a.exr", kSide) + camera + "WorldBegin\nSurface \"points\"\n" + geometry + "WorldEnd\n");
        run(std::string("render s.rib -t ") + threads, "2>&1");
        Diagnostics d;
        const auto image = display::readImage((dir / "a.exr").string(), d);
        ASSERT_TRUE(image);
        if (first.empty()) first = image->data;
        EXPECT_TRUE(first == image->data) << threads;
    }
}

} // namespace

} // namespace pointbased_test
