// alpenglow ptc: point clouds and brick maps. What is in them, several as one, thinned and smoothed, as PLY, as pictures.
#include "base/file.h"
#include "base/printable.h"
#include "base/processors.h"
#include "cli/command.h"
#include "cli/fileinfo.h"
#include "cli/jsonreport.h"
#include "cli/ranges.h"
#include "display/imageio.h"
#include "pointcloud/bounce.h"
#include "pointcloud/brickmap.h"
#include "pointcloud/brickstream.h"
#include "pointcloud/cloudfile.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

namespace alpenglow::cli {

namespace {

struct PtcArguments {
    std::string action, channel, view = "z";
    std::vector<std::string> files, channels;
    std::string box;
    std::vector<double> corners; ///< of box
    int depth = -1, size = 512, bounces = 1;
    std::string albedo = "0.5"; ///< a number, three, or a channel
    float solidAngle = .1f;
    float smooth = 0;
    bool json = false;
};

const OutputPolicy kAnywhere{".", true};

/// The channels that are named, and the points in the box; one point a cell; means within a radius.
pointcloud::PointCloud filtered(pointcloud::PointCloud from, const PtcArguments& a) {
    pointcloud::PointCloud to;
    std::vector<int> offsets;
    for (const pointcloud::Channel& c : from.channels) {
        if (!a.channels.empty() && std::find(a.channels.begin(), a.channels.end(), c.name) == a.channels.end()) continue;
        to.channels.push_back(c);
        for (int k = 0; k < sizeOf(c.type); ++k) offsets.push_back(from.offsetOf(c.name) + k);
    }
    std::vector<float> row(offsets.size());
    for (size_t i = 0; i < from.size(); ++i) {
        bool inside = true;
        for (int k = 0; k < 3 && !a.corners.empty(); ++k)
            inside &= double(from.P[i][k]) >= a.corners[size_t(k)] && double(from.P[i][k]) <= a.corners[size_t(k) + 3];
        if (!inside) continue;
        for (size_t k = 0; k < row.size(); ++k) row[k] = from.valuesOf(i)[size_t(offsets[k])];
        to.add(from.P[i], from.N[i], from.radius[i], row);
    }
    if (a.depth >= 0) {
        Vec3 corner;
        float side = 0;
        pointcloud::cubeAbout(to, &corner, &side);
        to = pointcloud::coarser(to, corner, side, a.depth);
    }
    if (a.smooth > 0) {
        const auto map = pointcloud::mapOf(to);
        for (size_t i = 0; i < to.size(); ++i)
            map->lookup({to.P[i], to.N[i], a.smooth, -1}, {to.values.data() + i * size_t(to.width()), size_t(to.width())});
    }
    return to;
}

/// Disks seen from far away along an axis, the nearest first; a channel, or how normals lie.
display::Image pictureOf(const pointcloud::PointCloud& cloud, const PtcArguments& a) {
    const bool back = a.view[0] == '-';
    const int axis = a.view.back() - 'x', right = axis == 0 ? 2 : 0, up = axis == 1 ? 2 : 1;
    Vec3 lo, hi;
    cloud.bounds(lo, hi);
    const float wide = std::max({hi[right] - lo[right], hi[up] - lo[up], 1e-30f}), scale = .96f * float(a.size) / wide;
    display::Image image = display::makeImage(a.size, a.size, display::defaultChannels(4));
    std::vector<float> nearest(size_t(a.size) * size_t(a.size), 1e38f);
    int at = cloud.offsetOf(a.channel), count = 0;
    for (const pointcloud::Channel& c : cloud.channels)
        if (c.name == a.channel) count = sizeOf(c.type);
    for (size_t i = 0; i < cloud.size(); ++i) {
        const float depth = back ? -cloud.P[i][axis] : cloud.P[i][axis];
        const float x = .5f * float(a.size) + (cloud.P[i][right] - (lo[right] + hi[right]) / 2) * scale * (back ? -1.f : 1.f);
        const float y = .5f * float(a.size) - (cloud.P[i][up] - (lo[up] + hi[up]) / 2) * scale;
        const float r = std::clamp(cloud.radius[i] * scale, .5f, float(a.size));
        float colour[3];
        for (int k = 0; k < 3; ++k)
            colour[k] = at >= 0 ? cloud.valuesOf(i)[size_t(at + (count >= 3 ? k : 0))] : .5f + .5f * cloud.N[i][k];
        for (int py = std::max(0, int(y - r)); py <= std::min(a.size - 1, int(y + r)); ++py)
            for (int px = std::max(0, int(x - r)); px <= std::min(a.size - 1, int(x + r)); ++px) {
                const float dx = float(px) + .5f - x, dy = float(py) + .5f - y;
                float& z = nearest[size_t(py) * size_t(a.size) + size_t(px)];
                if (dx * dx + dy * dy > r * r || depth >= z) continue;
                z = depth;
                float* to = image.pixel(px, py);
                for (int k = 0; k < 3; ++k) to[k] = colour[k];
                to[3] = 1;
            }
    }
    return image;
}

bool writePicture(const std::string& name, const pointcloud::PointCloud& cloud, const PtcArguments& a, Diagnostics& d) {
    display::WriteOptions o;
    o.policy = kAnywhere;
    const auto format = display::formatOfExtension(name);
    o.format = format.value_or(display::Format::Exr);
    if (o.format == display::Format::Exr) o.sample = display::Sample::Float;
    return display::writeImage(name, pictureOf(cloud, a), o, d);
}

/// Light after some bounces. "": done; else what is missing.
std::string bounced(pointcloud::PointCloud& cloud, const PtcArguments& a) {
    pointcloud::BounceOptions o;
    o.bounces = a.bounces;
    o.maxSolidAngle = a.solidAngle;
    o.threads = defaultThreads();
    if (const auto one = parseNumbers(a.albedo, 1)) o.albedo = Color(float((*one)[0]));
    else if (const auto three = parseNumbers(a.albedo, 3))
        o.albedo = Color(float((*three)[0]), float((*three)[1]), float((*three)[2]));
    else o.albedoChannel = a.albedo;
    return pointcloud::bounce(cloud, o);
}

/// What is in files, as `info` shows it.
int describe(const PtcArguments& a, Diagnostics& d, nlohmann::ordered_json& found) {
    bool all = true;
    found["files"] = nlohmann::ordered_json::array();
    for (const std::string& f : a.files) {
        auto facts = fileFacts(f, d);
        all &= facts.has_value();
        if (facts && !a.json) std::fputs(printable(factsText(*facts)).c_str(), stdout);
        if (facts) found["files"].push_back(std::move(*facts));
    }
    return all ? kDone : kNothingRendered;
}

/// 0: done; else why not. found: what --json prints.
int runPtc(const PtcArguments& a, Diagnostics& d, nlohmann::ordered_json& found) {
    if (a.action == "info") return describe(a, d, found);
    if (a.action == "brick") {
        if (pointcloud::brickMapOfFiles(std::span(a.files).first(a.files.size() - 1), a.files.back(), kAnywhere, d)) return kDone;
        const auto unwritten = [](const Diagnostic& m) { return m.code == Rie::System || m.code == Rie::DiskFull; };
        const std::vector<Diagnostic> reported = d.all();
        return std::any_of(reported.begin(), reported.end(), unwritten) ? kOutputFailed : kNothingRendered;
    }
    std::vector<pointcloud::PointCloud> from;
    for (size_t i = 0; i + 1 < a.files.size(); ++i) {
        auto cloud = pointcloud::loadCloud(a.files[i], d);
        if (!cloud) return kNothingRendered;
        from.push_back(std::move(*cloud));
    }
    pointcloud::PointCloud all;
    if (from.size() == 1) all = std::move(from[0]);
    else if (const std::string fault = pointcloud::merge(from, all); !fault.empty()) {
        d.report(Severity::Error, Rie::Consistency, {}, "these clouds cannot be merged: " + fault);
        return kNothingRendered;
    }
    const std::string& out = a.files.back();
    if (a.action == "filter") all = filtered(std::move(all), a);
    if (a.action == "bounce")
        if (const std::string fault = bounced(all, a); !fault.empty()) {
            d.report(Severity::Error, Rie::MissingData, {}, "\"" + a.files[0] + "\": " + fault,
                     "alpenglow ptc info shows what there is");
            return kNothingRendered;
        }
    if (a.action == "picture" && !a.channel.empty() && all.offsetOf(a.channel) < 0) {
        d.report(Severity::Error, Rie::MissingData, {}, "there is no channel \"" + a.channel + "\" in it",
                 "alpenglow ptc info shows what there is");
        return kNothingRendered;
    }
    const bool written = a.action == "picture" ? writePicture(out, all, a, d)
                         : a.action == "toply" ? pointcloud::savePly(out, all, kAnywhere, d, {})
                                               : pointcloud::saveCloud(out, all, kAnywhere, d);
    return written ? kDone : kOutputFailed;
}

} // namespace

void addPtc(CLI::App& app, int* status) {
    auto a = std::make_shared<PtcArguments>();
    CLI::App* c = app.add_subcommand("ptc", "Tell, merge, filter, convert and draw point clouds; make brick maps");
    c->add_option("action", a->action,
                  "info: describe files; merge: combine several; filter: extract parts; toply, fromply: convert to and from PLY; "
                  "brick: make a brick map; bounce: add light exchanged between points; picture: draw the points")
        ->required()
        ->check(CLI::IsMember({"info", "merge", "filter", "toply", "fromply", "brick", "bounce", "picture"}));
    c->add_option("files", a->files, "Files to read, then the file to write (none for info)")->type_name("FILE")->required();
    auto* filter = c->add_option_group("Of filter");
    filter->add_option("--channels", a->channels, "Channels to keep, separated by commas")->delimiter(',')->type_name("NAMES");
    filter->add_option("--box", a->box, "Corners of a box; points outside are removed")->type_name("X,Y,Z,X,Y,Z");
    filter
        ->add_option(
            "--depth", a->depth,
            "Keep one point for each cell of a cube with 2^DEPTH cells along each side, and for each side of the surface")
        ->check(between(0, 16))
        ->type_name("DEPTH");
    filter->add_option("--smooth", a->smooth, "Replace each value by the mean within this radius, as texture3d() computes it")
        ->check(positive())
        ->type_name("RADIUS");
    auto* bounce = c->add_option_group("Of bounce");
    bounce->add_option("--albedo", a->albedo, "Albedo of the points: a number, three numbers separated by commas, or a channel")
        ->type_name("NUMBER|R,G,B|NAME");
    bounce->add_option("--bounces", a->bounces, "Number of bounces between points")->check(between(1, 100))->type_name("N");
    bounce->add_option("--solid-angle", a->solidAngle, "Largest solid angle of a cluster; larger ones are split")
        ->check(positive())
        ->type_name("STERADIANS");
    auto* picture = c->add_option_group("Of picture");
    picture->add_option("--channel", a->channel, "Channel to draw; default: the normals")->type_name("NAME");
    picture->add_option("--view", a->view, "Direction of the view: x, y, z, -x, -y, -z")
        ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}))
        ->type_name("AXIS");
    picture->add_option("--size", a->size, "Size of the picture, in pixels")->check(between(1, 8192))->type_name("PIXELS");
    c->add_flag("--json", a->json, "As JSON: what info shows under \"files\", messages under \"diagnostics\"");
    c->footer("alpenglow ptc brick room.ptc room.bkm. docs/pointclouds.md describes the files.");
    c->callback([a, status] {
        nlohmann::ordered_json reported, found = nlohmann::ordered_json::object();
        Diagnostics diags(printerOr(a->json, reported));
        const size_t least = a->action == "info" ? 1 : 2;
        const bool several = a->action == "merge" || a->action == "brick";
        if (a->files.size() < least || (least == 2 && !several && a->files.size() != 2))
            throw CLI::ValidationError("files", a->action + (several      ? " takes clouds and the name of what they become"
                                                             : least == 1 ? " takes files"
                                                                          : " takes a file and the name of what is written"));
        if (least == 2) refuseOwnInput(a->files);
        if (!a->box.empty()) {
            const auto corners = parseNumbers(a->box, 6);
            if (!corners) throw CLI::ValidationError("--box", "takes six numbers, not " + a->box);
            a->corners = *corners;
        }
        *status = runPtc(*a, diags, found);
        if (*status == kDone && diags.errors()) *status = kDoneWithErrors;
        if (a->json) printReport(std::move(found), std::move(reported));
    });
}

} // namespace alpenglow::cli
