// What Geometry knows. "teapot": the teapot that Martin Newell measured on his table in 1975, standing on z = 0 about the z axis,
// spout to +x, its largest radius 2 (F. Crow, "The Origins of the Teapot", IEEE CG&A 7(1), 1987). Body and lid are their measured
// profiles turned round the axis; handle and spout are their measured sections.
#include "ri/teapot.h"
#include <fmt/format.h>
#include <span>

namespace alpenglow::ri {
namespace {

struct ProfilePoint {
    double r, z;
};
// Bezier pieces that share their ends: foot, belly, shoulder, rim.
constexpr ProfilePoint kBody[] = {{1.5, 0},      {1.5, .075}, {2, .3},           {2, .75},          {2, 1.2},
                                  {1.75, 1.725}, {1.5, 2.25}, {1.4375, 2.38125}, {1.3375, 2.38125}, {1.4, 2.25}};
constexpr ProfilePoint kLid[] = {{1.3, 2.25}, {1.3, 2.4}, {.4, 2.4}, {.2, 2.55}, {0, 2.7}, {.8, 3}, {0, 3}};

/// A section of handle or spout: two points in the plane y = 0, joined by half rounds of this half width.
struct Section {
    double x0, z0, x1, z1, half;
};
constexpr Section kHandle[] = {{-1.6, 1.875, -1.5, 2.1, .3}, {-2.3, 1.875, -2.5, 2.1, .3}, {-2.7, 1.875, -3, 2.1, .3},
                               {-2.7, 1.65, -3, 1.65, .3},   {-2.7, 1.425, -3, 1.2, .3},   {-2.5, .975, -2.65, .7875, .3},
                               {-2, .75, -1.9, .45, .3}};
constexpr Section kSpout[] = {{1.7, 1.275, 1.7, .45, .66}, {2.6, 1.275, 3.1, .675, .66},      {2.3, 1.95, 2.4, 1.875, .25},
                              {2.7, 2.25, 3.3, 2.25, .25}, {2.8, 2.325, 3.525, 2.34375, .25}, {2.9, 2.325, 3.45, 2.3625, .15},
                              {2.8, 2.25, 3.2, 2.25, .15}};

void mesh(std::string& out, int nu, size_t nv, const std::string& points) {
    out += fmt::format("PatchMesh \"bicubic\" {} \"nonperiodic\" {} \"nonperiodic\" \"vertex point P\" [{}]\n", nu, nv, points);
}

void turned(std::string& out, std::span<const ProfilePoint> profile) {
    constexpr double k = 0.5522847498307936; // 4/3 (sqrt 2 - 1): a quarter of a circle as a cubic
    constexpr double round[13][2] = {{1, 0},   {1, k},   {k, 1},  {0, 1},  {-k, 1}, {-1, k}, {-1, 0},
                                     {-1, -k}, {-k, -1}, {0, -1}, {k, -1}, {1, -k}, {1, 0}};
    std::string points;
    for (const ProfilePoint& p : profile)
        for (auto& c : round) points += fmt::format("{} {} {} ", p.r * c[0], p.r * c[1], p.z);
    mesh(out, 13, profile.size(), points);
}

void swept(std::string& out, std::span<const Section> sections) {
    std::string points;
    for (const Section& s : sections) {
        double y = -s.half; // this orientation has normals that point out of the tube
        points += fmt::format("{0} 0 {1} {0} {4} {1} {2} {4} {3} {2} 0 {3} {2} {5} {3} {0} {5} {1} {0} 0 {1} ", s.x0, s.z0, s.x1,
                              s.z1, y, -y);
    }
    mesh(out, 7, sections.size(), points);
}

std::string text() {
    std::string s = "AttributeBegin\nBasis \"bezier\" 3 \"bezier\" 3\n";
    turned(s, kBody);
    turned(s, kLid);
    swept(s, kHandle);
    swept(s, kSpout);
    return s + "AttributeEnd\n";
}

/// Six bilinear patches, each with dP/du x dP/dv to the outside.
std::string cube() {
    std::string s = "AttributeBegin\n";
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-.5, .5}) {
            const int u = (axis + (side > 0 ? 1 : 2)) % 3, v = (axis + (side > 0 ? 2 : 1)) % 3;
            s += "Patch \"bilinear\" \"P\" [";
            for (int corner = 0; corner < 4; ++corner) {
                double at[3];
                at[axis] = side;
                at[u] = corner & 1 ? .5 : -.5;
                at[v] = corner & 2 ? .5 : -.5;
                s += fmt::format("{} {} {} ", at[0], at[1], at[2]);
            }
            s += "]\n";
        }
    return s + "AttributeEnd\n";
}

} // namespace

const std::string& cubeRequests() {
    static const std::string requests = cube();
    return requests;
}

const std::string& sphereRequests() {
    static const std::string requests = "AttributeBegin\nSphere 1 -1 1 360\nAttributeEnd\n";
    return requests;
}

const std::string& teapotRequests() {
    static const std::string requests = text();
    return requests;
}

} // namespace alpenglow::ri
