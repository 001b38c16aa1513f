// Point clouds, brick maps, baked values, Ptex files, photon maps and deep shadow maps: seeds, check sums, and what reads them.
#include "base/file.h"
#include "display/imageio.h"
#include "mutate.h"
#include "photonmap/photonfile.h"
#include "pointcloud/bakefile.h"
#include "pointcloud/brickmap.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/hemisphere.h"
#include "ptex/filter.h"
#include "targets.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <zlib.h>

namespace alpenglow::fuzz {
namespace {

const OutputPolicy kHere{".", true};

pointcloud::PointCloud someCloud(int n) {
    pointcloud::PointCloud c;
    c.channels = {{"_area", pointcloud::ChannelType::Float},
                  {"_radiosity", pointcloud::ChannelType::Color},
                  {"m", pointcloud::ChannelType::Matrix}};
    for (int i = 0; i < n; ++i) {
        std::vector<float> v(20, float(i));
        v[0] = .01f;
        c.add({float(i % 7), float(i / 7), float(i % 3)}, {0, 0, i % 4 ? 1.f : 0.f}, .1f, v);
    }
    return c;
}

uint32_t u32(const Bytes& b, size_t at) {
    uint32_t v = 0;
    if (at + 4 <= b.size()) std::memcpy(&v, &b[at], 4);
    return v;
}
void sum(Bytes& b, size_t from, size_t to, size_t at) {
    if (from > to || to > b.size() || at + 4 > b.size()) return;
    const uint32_t crc = uint32_t(crc32(0, reinterpret_cast<const Bytef*>(&b[from]), uInt(to - from)));
    std::memcpy(&b[at], &crc, 4);
}

} // namespace

void makeClouds() {
    Diagnostics d;
    for (int n : {0, 1, 40}) {
        pointcloud::saveCloud(std::to_string(n) + ".ptc", someCloud(n), kHere, d);
        pointcloud::savePly(std::to_string(n) + ".ply", someCloud(n), kHere, d, {});
        pointcloud::saveBrickMap(std::to_string(n) + ".bkm", someCloud(n), kHere, d);
    }
    pointcloud::Baked baked;
    baked.type = pointcloud::ChannelType::Color;
    for (int i = 0; i < 100; ++i) baked.rows.push_back(float(i % 10) / 10);
    pointcloud::saveBaked("t.bake", baked, kHere, d);
    pointcloud::saveBaked("b.bake&binary", baked, kHere, d);
    std::vector<photonmap::Photon> some(20);
    photonmap::savePhotons("a.photons", some, 100, Matrix(), kHere, d);
}

void makePtexFiles() {
    Diagnostics d;
    for (const ptex::Number number : {ptex::Number::Byte, ptex::Number::Half, ptex::Number::Float})
        for (const ptex::Mesh mesh : {ptex::Mesh::Quad, ptex::Mesh::Triangle}) {
            ptex::Head head;
            head.mesh = mesh;
            head.number = number;
            head.faces.resize(6);
            head.metas = {{"text", 0, {'a', 0}}, {"large", 0, std::vector<uint8_t>(1500, 'b')}};
            std::vector<ptex::Image> images;
            for (int f = 0; f < 6; ++f) {
                ptex::Face& face = head.faces[size_t(f)];
                face.ulog = face.vlog = uint8_t(f);
                face.adjacent = {(f + 1) % 6, (f + 5) % 6, -1, f};
                face.edge = {1, 0, 2, 3};
                face.subface = mesh == ptex::Mesh::Quad && f == 4;
                ptex::Image m{1 << f, 1 << f, {}};
                for (int i = 0; i < m.u * m.v * 3; ++i) m.values.push_back(float(i * 37 % 256) / 255);
                images.push_back(std::move(m));
            }
            ptex::writeTexture(std::to_string(int(number)) + std::to_string(int(mesh)) + ".ptx", head, images, kHere, d);
        }
}

/// Right check sums of point clouds, brick maps' headers, baked values and photon maps.
Bytes summed(Bytes b) {
    if (b.compare(0, 8, "ALPGCLOU") == 0 || b.compare(0, 8, "ALPGBRIC") == 0) {
        const bool cloud = b[4] == 'C';
        const size_t h = u32(b, cloud ? 24 : 40);
        if (h < 4 || h > b.size()) return b;
        sum(b, 0, h - 4, h - 4);
        if (cloud && b.size() >= h + 4) sum(b, h, b.size() - 4, b.size() - 4);
    } else if (b.compare(0, 8, "ALPGBAKE") == 0 && b.size() > 12) {
        sum(b, 0, b.size() - 4, b.size() - 4);
    } else if (b.compare(0, 8, "ALPGPHOT") == 0 && b.size() > 40) {
        sum(b, 0, 32, 32);
        sum(b, 36, b.size() - 4, b.size() - 4);
    }
    return b;
}

Outcome readCloud(const Bytes& b) {
    putFile("in.map", b);
    Diagnostics d;
    const auto map = pointcloud::openMap("in.map", d);
    if (!map) return d.errors() ? Outcome::Refused : Outcome::Mute;
    std::vector<float> out(static_cast<size_t>(map->width()));
    for (const float x : {0.f, 2.f, -1e30f})
        for (const float radius : {0.f, .5f, 1e18f}) map->lookup({{x, 1, 0}, {0, 0, 1}, radius, -1}, out);
    if (pointcloud::isBrickMap("in.map")) return Outcome::Ok;
    const auto cloud = pointcloud::loadCloud("in.map", d);
    if (!cloud || cloud->size() > 10000) return Outcome::Ok;
    const pointcloud::PointOctree octree(*cloud, "_radiosity");
    pointcloud::Hemisphere h;
    pointcloud::HemisphereQuery q;
    q.N = {0, 0, 1};
    h.begin(q);
    h.add(octree);
    h.finish();
    return Outcome::Ok;
}

Outcome readBaked(const Bytes& b) {
    putFile("in.bake", b);
    Diagnostics d;
    const auto baked = pointcloud::loadBaked("in.bake", d);
    if (!baked) return d.errors() ? Outcome::Refused : Outcome::Mute;
    if (baked->size() < 10000) pointcloud::pictureOf(*baked);
    return Outcome::Ok;
}

Outcome readPtex(const Bytes& b) {
    putFile("in.ptx", b);
    Diagnostics d;
    const auto t = ptex::openTexture("in.ptx", ptex::makeCache(1 << 20), d);
    if (!t) return d.errors() ? Outcome::Refused : Outcome::Mute;
    for (uint32_t f = 0; f < std::min<size_t>(t->head().faces.size(), 32); ++f)
        for (const float w : {0.f, .2f, 2.f}) {
            float out[3];
            ptex::lookup(*t, {f, w, .99f, w, w}, out);
            for (const float v : out)
                if (!std::isfinite(v)) return Outcome::Status;
        }
    return Outcome::Ok;
}

Outcome readPhotons(const Bytes& b) {
    putFile("in.photons", b);
    Diagnostics d;
    return photonmap::loadPhotons("in.photons", Matrix(), d) ? Outcome::Ok : d.errors() ? Outcome::Refused : Outcome::Mute;
}

void makeDeepMaps() {
    display::Image m = display::makeImage(9, 5, {"z"});
    auto deep = std::make_shared<display::DeepSamples>();
    for (int i = 0; i < 45; ++i) {
        deep->first.push_back(deep->steps.size());
        for (int k = 0; k < i % 4; ++k) deep->steps.push_back({float(k + 1), {.5f / float(k + 1), .4f / float(k + 1), 0}});
    }
    deep->first.push_back(deep->steps.size());
    m.deep = deep;
    m.metadata["textureformat"] = "Shadow";
    Diagnostics d;
    display::WriteOptions o;
    o.policy = kHere;
    display::writeImage("map.dsm", m, o, d);
}

} // namespace alpenglow::fuzz
