#include "cli/fileinfo.h"
#include "base/limits.h"
#include "cli/scenefacts.h"
#include "display/imageio.h"
#include "geometry/bounds.h"
#include "photonmap/photonfile.h"
#include "pointcloud/brickmap.h"
#include "pointcloud/cloudfile.h"
#include "ptex/ptexfile.h"
#include "render/filmpicture.h"
#include "render/partfile.h"
#include "ri/models/model.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace alpenglow::cli {

using Facts = nlohmann::ordered_json;

namespace {

/// Six digits, as text has them.
double rounded(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    return std::atof(text);
}
Facts three(const Vec3& v) { return {rounded(double(v.x)), rounded(double(v.y)), rounded(double(v.z))}; }

/// Least, largest and mean value of a channel, of those that are finite.
Facts channelFacts(const display::Image& image, size_t channel) {
    const size_t width = image.channels.size();
    double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0;
    size_t finite = 0, other = 0;
    for (size_t i = channel; i < image.data.size(); i += width) {
        const double x = double(image.data[i]);
        if (!std::isfinite(x)) {
            ++other;
            continue;
        }
        ++finite;
        least = std::min(least, x);
        most = std::max(most, x);
        sum += x;
    }
    Facts f{{"name", image.channels[channel]}};
    if (finite) f["min"] = rounded(least), f["max"] = rounded(most), f["mean"] = rounded(sum / double(finite));
    if (other) f["notFinite"] = other;
    return f;
}

std::string numberFormat(const display::Image& i) {
    return i.floating ? i.bits == 16 ? "half" : "float" : "uint" + std::to_string(i.bits);
}

void addPicture(Facts& f, const display::Image& image) {
    const auto format = image.metadata.find("textureformat");
    std::string kind = "picture";
    if (format != image.metadata.end()) kind = "map, " + format->second;
    else if (image.worldToCamera && image.channel("z") >= 0) kind = "depth picture";
    if (image.deep) kind += ", deep";
    f["kind"] = kind;
    f["size"] = {image.width, image.height};
    if (image.fullWidth > 0) {
        f["origin"] = {image.originX, image.originY};
        f["fullSize"] = {image.fullWidth, image.fullHeight};
    }
    f["numbers"] = numberFormat(image);
    if (!image.levels.empty()) f["levels"] = image.levels.size() + 1;
    if (image.pixelAspect != 1) f["pixelAspect"] = rounded(double(image.pixelAspect));
    f["matrices"] = image.worldToCamera && image.worldToNDC ? "camera and projection" : image.worldToCamera ? "camera" : "none";
    for (size_t c = 0; c < image.channels.size(); ++c) f["channel"].push_back(channelFacts(image, c));
    for (const auto& [key, value] : image.metadata) f["metadata"][key] = value;
}

bool addCloud(Facts& f, const std::string& file, Diagnostics& d) {
    const auto cloud = pointcloud::loadCloud(file, d);
    if (!cloud) return false;
    Vec3 lo, hi;
    cloud->bounds(lo, hi);
    f["kind"] = "point cloud";
    f["points"] = cloud->size();
    f["from"] = three(lo);
    f["to"] = three(hi);
    if (cloud->size()) {
        const auto [least, most] = std::minmax_element(cloud->radius.begin(), cloud->radius.end());
        f["radius"] = {rounded(double(*least)), rounded(double(*most))};
    }
    f["channel"] = Facts::array();
    for (const pointcloud::Channel& c : cloud->channels) {
        const size_t at = size_t(cloud->offsetOf(c.name));
        Facts mean = Facts::array();
        for (size_t k = 0; k < size_t(sizeOf(c.type)); ++k) {
            double sum = 0;
            for (size_t i = 0; i < cloud->size(); ++i) sum += double(cloud->valuesOf(i)[at + k]);
            mean.push_back(cloud->size() ? rounded(sum / double(cloud->size())) : 0);
        }
        f["channel"].push_back({{"type", nameOf(c.type)}, {"name", c.name}, {"mean", std::move(mean)}});
    }
    return true;
}

bool addBricks(Facts& f, const std::string& file, Diagnostics& d) {
    const auto facts = pointcloud::brickFacts(file, d);
    if (!facts) return false;
    f["kind"] = "brick map";
    f["points"] = facts->points;
    f["levels"] = facts->levels;
    f["bricks"] = facts->bricks;
    f["from"] = three(facts->corner);
    f["to"] = three(facts->corner + Vec3(facts->side));
    f["channel"] = Facts::array();
    for (const pointcloud::Channel& c : facts->channels) f["channel"].push_back({{"type", nameOf(c.type)}, {"name", c.name}});
    return true;
}

bool addPhotons(Facts& f, const std::string& file, Diagnostics& d) {
    const auto map = photonmap::loadPhotons(file, Matrix(), d);
    if (!map) return false;
    f["kind"] = "photon map";
    f["photons"] = map->size();
    geometry::Bounds b;
    int bounces = 0;
    for (const photonmap::Photon& p : map->photons()) b.add(p.P), bounces = std::max(bounces, int(p.bounces));
    if (!b.empty()) f["from"] = three(b.lo), f["to"] = three(b.hi);
    f["bounces"] = bounces;
    f["power"] = three(map->power());
    return true;
}

bool addPart(Facts& f, const std::string& file, Diagnostics& d) {
    const auto film = render::loadPart(file, d);
    if (!film) return false;
    const render::FilmDescription& of = film->description();
    f["kind"] = "part of a render";
    f["size"] = {of.width, of.height};
    if (const render::Window& w = of.window; w.width() < of.width || w.height() < of.height)
        f["window"] = {w.x0, w.y0, w.x1, w.y1};
    for (const render::SampleRange& r : film->ranges()) f["samples"].push_back(render::rangeText(r));
    if (const auto whole = film->metadata.find(render::kWholeKey); whole != film->metadata.end()) f["of"] = whole->second;
    const render::Film::Samples samples = film->samples();
    f["samplesPerPixel"] = {{"mean", rounded(samples.mean)}, {"least", samples.least}, {"most", samples.most}};
    f["seed"] = of.seed;
    f["scene"] = of.scene;
    for (const render::Channel& c : of.channels) f["channel"].push_back(c.name);
    return true;
}

bool addPtex(Facts& f, const std::string& file, Diagnostics& d) {
    const auto texture = ptex::openTexture(file, ptex::makeCache(1 << 20), d);
    if (!texture) return false;
    static constexpr const char* kNumbers[] = {"uint8", "uint16", "half", "float"};
    const ptex::Head& head = texture->head();
    int u = 0, v = 0;
    uint64_t all = 0;
    for (const ptex::Face& face : head.faces) {
        u = std::max(u, 1 << face.ulog), v = std::max(v, 1 << face.vlog);
        all += uint64_t(1) << (face.ulog + face.vlog);
    }
    f["kind"] = "Ptex";
    f["faces"] = head.faces.size();
    f["mesh"] = head.mesh == ptex::Mesh::Quad ? "quadrilaterals" : "triangles";
    f["channels"] = head.channels;
    if (head.alpha >= 0) f["alpha"] = head.alpha;
    f["numbers"] = kNumbers[size_t(head.number)];
    f["largestFace"] = {u, v};
    f["pixels"] = all;
    return true;
}

bool addModel(Facts& f, const std::string& file, Diagnostics& d) {
    const int before = d.errors();
    const auto parts = ri::readModelFile(
        file,
        [&d](Severity s, Rie code, const SourcePlace& place, std::string message) {
            d.report(s, code, place, std::move(message));
        },
        nullptr);
    if (parts.empty()) {
        if (d.errors() == before)
            d.report(Severity::Error, Rie::MissingData, {}, "\"" + file + "\": there are no faces and no points in it");
        return false;
    }
    f["kind"] = "model";
    geometry::Bounds box;
    size_t faces = 0, points = 0;
    Facts list = Facts::array();
    for (const scene::Primitive& p : parts) {
        faces += p.ints.size();
        Facts variables = Facts::array();
        for (const scene::Param& v : p.params) {
            if (v.name == "P") {
                points += v.numbers.size() / 3;
                for (size_t i = 0; i + 2 < v.numbers.size(); i += 3)
                    box.add(Vec3(v.numbers[i], v.numbers[i + 1], v.numbers[i + 2]));
            }
            variables.push_back(v.name);
        }
        list.push_back({{"kind", p.kind}, {"variables", std::move(variables)}});
    }
    f["points"] = points;
    f["faces"] = faces;
    if (!box.empty()) f["from"] = three(box.lo), f["to"] = three(box.hi);
    f["part"] = std::move(list);
    return true;
}

std::string beginningOf(const std::string& file, size_t most) {
    std::string bytes(most, '\0');
    std::FILE* in = std::fopen(file.c_str(), "rb");
    if (!in) return "";
    bytes.resize(std::fread(bytes.data(), 1, most, in));
    std::fclose(in);
    return bytes;
}

/// A .ply with faces is a model, one without is a point cloud as well; that of a renderer has radii or channels.
bool isPlyModel(const std::string& beginning) {
    const size_t faces = beginning.find("element face ");
    return faces != std::string::npos && std::atoll(beginning.c_str() + faces + 13) > 0;
}

} // namespace

std::optional<Facts> fileFacts(const std::string& file, Diagnostics& d) {
    const std::string head = beginningOf(file, 4096);
    Facts f{{"file", file}};
    const auto done = [&](bool fine) { return fine ? std::optional(std::move(f)) : std::nullopt; };
    if (head.starts_with("ALPGCLOU")) return done(addCloud(f, file, d));
    if (head.starts_with("ALPGBRIC")) return done(addBricks(f, file, d));
    if (head.starts_with("ALPGPHOT")) return done(addPhotons(f, file, d));
    if (head.starts_with("ALPGPART")) return done(addPart(f, file, d));
    if (head.starts_with("Ptex")) return done(addPtex(f, file, d));
    if (head.starts_with("ply")) return done(isPlyModel(head) ? addModel(f, file, d) : addCloud(f, file, d));
    if (ri::namedAsModel(file)) return done(addModel(f, file, d));
    if (namedAsScene(file)) return done(addScene(f, file, d));
    Diagnostics quiet;
    display::ReadOptions options;
    options.levels = true;
    if (const auto image = display::readImage(file, quiet, options)) {
        addPicture(f, *image);
        return f;
    }
    if (head.starts_with("##RenderMan")) return done(addScene(f, file, d));
    for (const Diagnostic& reported : quiet.all()) d.report(reported);
    return {};
}

namespace {

std::string textOfValue(const Facts& v) {
    if (v.is_string()) return v.get<std::string>();
    if (v.is_number_float()) {
        char text[32];
        std::snprintf(text, sizeof text, "%.6g", v.get<double>());
        return text;
    }
    if (!v.is_structured()) return v.dump();
    std::string all;
    for (const auto& [key, value] : v.items()) {
        if (!all.empty()) all += v.is_object() ? ", " : " ";
        // What an element is called comes first, without the word for it.
        const bool named = v.is_array() || key == "type" || key == "name" || key == "kind";
        if (v.is_object() && key == "name" && !all.empty()) all.replace(all.size() - 2, 2, " ");
        all += (named ? "" : key + " ") + textOfValue(value);
    }
    return all;
}

void addLines(std::string& text, const std::string& key, const Facts& value, const std::string& indent) {
    if (value.empty() && !value.is_string()) return; // a list of nothing
    const auto deep = [](const Facts& v) {
        return v.is_object() && std::any_of(v.begin(), v.end(), [](const Facts& of) { return of.is_object(); });
    };
    if (value.is_array() && value[0].is_object()) {
        for (const Facts& one : value) addLines(text, key, one, indent);
    } else if (deep(value) || (value.is_object() && key == "metadata")) {
        text += indent + key + "\n";
        for (const auto& [name, of] : value.items()) addLines(text, name, of, indent + "  ");
    } else {
        text += indent + key + " " + textOfValue(value) + "\n";
    }
}

} // namespace

std::string factsText(const Facts& facts) {
    std::string text = textOfValue(facts["file"]) + "\n";
    for (const auto& [key, value] : facts.items())
        if (key != "file") addLines(text, key, value, "  ");
    return text;
}

} // namespace alpenglow::cli
