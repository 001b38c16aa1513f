// occlusion(), indirectdiffuse() and subsurface() of point clouds, against rays and closed forms, through scenes.
#include "../nightly.h"
#include "cli/command_folder.h"
#include "display/imageio.h"
#include "pointcloud/make.h"

namespace pointbased_test {

namespace {

using namespace alpenglow;
using pointcloud::PointCloud;

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
    const int kSide = nightly() ? 32 : 20;
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
    /// The same with several surfaces, by one start of the program.
    std::vector<std::vector<float>> pictures(const std::string& geometry, const std::vector<std::string>& surfaces,
                                             const std::string& before = "") {
        std::string text;
        for (const std::string& s : surfaces) {
            const std::string n = std::to_string(&s - surfaces.data() + 1);
            text += "FrameBegin " + n + "\n" + header("a" + n + ".exr", kSide) + camera + "WorldBegin\n" + before + s + geometry +
                    "WorldEnd\nFrameEnd\n";
        }
        render(text);
        Diagnostics d;
        std::vector<std::vector<float>> all;
        for (size_t k = 1; k <= surfaces.size(); ++k)
            if (const auto image = display::readImage((dir / ("a" + std::to_string(k) + ".exr")).string(), d))
                all.push_back(image->data);
        return all;
    }
    std::vector<float> picture(const std::string& geometry, const std::string& surface, const std::string& before = "") {
        const auto one = pictures(geometry, {surface}, before);
        return one.empty() ? std::vector<float>{} : one[0];
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

// The proof of issue 15: twelve scenes (here every second) against rays, 400 of them for each pixel, whose own error is about
// .005.
TEST_F(PointScenes, OcclusionOfTwelveScenesIsThatOfRays) {
    shader("baker", "", "bake3d(\"o.ptc\", \"\", P, normalize(N), \"interpolate\", 1); Ci = 1;");
    shader("traced", "", "Ci = occlusion(P, n, 400);");
    shader("points", "float a = .1;",
           "Ci = occlusion(P, n, 1, \"pointbased\", 1, \"filename\", \"o.ptc\", \"maxsolidangle\", a);");
    shader("standard", "", "Ci = occlusion(P, n, 1, \"pointbased\", 1, \"filename\", \"o.ptc\");");
    double sums[3] = {};
    size_t turn = 0, count = 0;
    for (const auto& [name, geometry] : scenes()) {
        if (!chosen(turn++, 2)) continue;
        ++count;
        bake(geometry);
        const auto all = pictures(geometry, {"Surface \"traced\"\n", "Surface \"points\" \"a\" [.5]\n", "Surface \"standard\"\n",
                                             "Surface \"points\" \"a\" [.02]\n"});
        double e[3];
        ASSERT_EQ(all.size(), 4u);
        for (int k = 0; k < 3; ++k) sums[k] += e[k] = meanError(all[0], all[size_t(k) + 1]);
        std::printf("%-10s %.4f %.4f %.4f\n", name.c_str(), e[0], e[1], e[2]);
        EXPECT_LT(e[1], .03) << name;
    }
    std::printf("mean       %.4f %.4f %.4f\n", sums[0] / double(count), sums[1] / double(count), sums[2] / double(count));
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
        render(header("a.exr", nightly() ? 24 : 16) +
               "Projection \"perspective\" \"fov\" 90\nWorldBegin\nShadingRate 1\nSurface " + surface + "\n" + walls +
               "WorldEnd\n");
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
    const auto tool = pointcloud::loadCloud((dir / "b2t.ptc").string(), d),
               stream = pointcloud::loadCloud((dir / "b2.ptc").string(), d);
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
    bake(plane, "Surface \"lit\"\n");
    const auto points = picture(plane, "Surface \"below\"\n"),
               rays = picture(plane, "Surface \"rays\"\n", "LightSource \"left\" 1\n");
    EXPECT_LT(meanError(points, rays), .02);
}

TEST_F(PointScenes, WhatCannotBeReadIsSaidOnce) {
    shader("points", "string f = \"\";",
           "Ci = occlusion(P, n, 1, \"pointbased\", 1, \"filename\", f) + indirectdiffuse(P, n, 1, \"pointbased\", 1, "
           "\"filename\", f);");
    Diagnostics d;
    PointCloud none;
    none.channels = {{"_area", pointcloud::ChannelType::Float}};
    const OutputPolicy here{dir.string(), true, -1};
    pointcloud::saveCloud((dir / "none.ptc").string(), none, here, d);
    PointCloud flat = pointcloud::test::square(4);
    for (float& r : flat.radius) r = 0;
    pointcloud::saveCloud((dir / "flat.ptc").string(), flat, here, d);
    pointcloud::saveBrickMap((dir / "b.bkm").string(), pointcloud::test::square(4), here, d);
    write("bad.ptc", "this is no cloud");
    const std::pair<const char*, const char*> cases[] = {{"", "needs the name of a point cloud"},
                                                         {"missing.ptc", "there is no point cloud"},
                                                         {"none.ptc", "has no points"},
                                                         {"flat.ptc", "16 points without area"},
                                                         {"b.bkm", "is a brick map"},
                                                         {"bad.ptc", "it is no point cloud"}};
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

// A cloud that lies elsewhere gives 0: that is said once, but not where some point finds something, nor of a part of a picture.
TEST_F(PointScenes, NothingFoundIsSaidOnce) {
    Diagnostics d;
    pointcloud::saveCloud((dir / "flat.ptc").string(), pointcloud::test::square(4), {dir.string(), true, -1}, d);
    shader("looks", "float dz = 0;",
           "float a = 0; texture3d(\"flat.ptc\", P + vector(0, 0, dz), normal(0, 0, 0), \"x\", a); Ci = a + 1;");
    const auto said = [&](const std::string& dz, const std::string& format = "") {
        write("s.rib", header("a.exr", 8) + format + camera + "WorldBegin\nSides 2\nSurface \"looks\" \"dz\" " + dz +
                           "\nPolygon \"P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]\nWorldEnd\n");
        return run("render s.rib", "2>&1");
    };
    const std::string word = "has no point near any lookup position", far = said("1000"), line = "looks.sl:1:";
    EXPECT_NE(far.find(line), std::string::npos) << far;
    EXPECT_NE(far.find(word), std::string::npos) << far;
    EXPECT_EQ(far.find(word), far.rfind(word)) << far;
    EXPECT_EQ(said("0").find(word), std::string::npos);
    EXPECT_EQ(said("1000", "CropWindow 0 .5 0 1\n").find(word), std::string::npos);
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

// Angles are those of the scene, whatever space a file is in: one that leans, one that is stretched.
TEST_F(PointScenes, SpacesThatLeanOrStretch) {
    const std::string spaces = "TransformBegin Skew 50 0 1 0 1 0 0 CoordinateSystem \"leaning\" TransformEnd\n"
                               "TransformBegin Rotate 20 0 0 1 Scale 1 4 .5 CoordinateSystem \"stretched\" TransformEnd\n";
    const char* const names[] = {"world", "leaning", "stretched"};
    std::string bakes;
    for (const char* n : names)
        bakes += std::string("bake3d(\"") + n + ".ptc\", \"\", P, normalize(N), \"interpolate\", 1, \"coordsystem\", \"" + n +
                 "\", \"_radiosity\", color(1, .5, .25)); ";
    shader("baker", "", bakes + "Ci = 1;");
    shader(
        "points", "string space = \"world\"; string file = \"world.ptc\";",
        "Ci = color(0, 0, occlusion(P, n, 1, \"pointbased\", 1, \"filename\", file, \"coordsystem\", space)) + color(1, 1, 0) * "
        "indirectdiffuse(P, n, 1, \"pointbased\", 1, \"filename\", file, \"coordsystem\", space);");
    const std::string corner = scenes()[2].second;
    bake(corner, "Surface \"baker\"\n", spaces);
    std::vector<std::string> surfaces;
    for (const std::string n : names)
        surfaces.push_back("Surface \"points\" \"space\" \"" + n + "\" \"file\" \"" + n + ".ptc\"\n");
    const auto seen = pictures(corner, surfaces, spaces);
    ASSERT_EQ(seen.size(), 3u);
    EXPECT_LT(meanError(seen[0], seen[1]), .01);
    EXPECT_LT(meanError(seen[0], seen[2]), .01);
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
