// ptexture(): lookups in files with a picture for each face.
#include "geometry/faceplace.h"
#include "ptex/filter.h"
#include "services/services.h"
#include "world/ptexstore.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::services {

namespace {

/// Argument rows, or -1.
struct PtexSite final : ServiceSite {
    bool computed = false; ///< file name computed for each point, in row 0; else SiteInfo::nameId
    int channel = -1, face = -1;
    std::vector<int> rows; ///< s, t and their differences (ds/dx, dt/dx, ds/dy, dt/dy); or eight numbers: four corners
    bool own = false;      ///< no coordinates given: uses those of the face, if any
    int count = 1;
    int fill = -1, width = -1, swidth = -1, twidth = -1, blur = -1, sblur = -1, tblur = -1;
    ptex::Kernel kernel = ptex::Kernel::Gaussian;
};

/// Finds the rows of a call's arguments.
void bindPtexture(SiteInfo& i, const rsl::CompiledKernel& k, const WorldImpl& world) {
    auto p = std::make_shared<PtexSite>();
    const rsl::ir::Site& s = *i.site;
    const auto row = [&](const char* name) {
        const auto f = i.named.find(name);
        return f == i.named.end() ? -1 : f->second;
    };
    p->computed = (s.strings.empty() || s.strings[0].empty()) && !s.argKinds.empty() && s.argKinds[0] == rsl::ir::Kind::String;
    std::vector<int> given(i.rows.begin() + (p->computed && !i.rows.empty()), i.rows.end());
    if (given.size() >= 2) {
        p->channel = given[0];
        p->face = given[1];
        p->rows.assign(given.begin() + 2, given.end());
    }
    p->own = p->rows.size() == 7; // build_service.cpp
    p->count = s.resultKinds.empty() ? 1 : std::min(rsl::ir::components(s.resultKinds[0]), 3);
    p->fill = row("fill");
    p->width = row("width");
    p->swidth = row("swidth");
    p->twidth = row("twidth");
    p->blur = row("blur");
    p->sblur = row("sblur");
    p->tblur = row("tblur");
    if (const auto f = i.text.find("filter"); f != i.text.end()) {
        const std::string& name = f->second;
        if (name == "box") p->kernel = ptex::Kernel::Box;
        else if (name == "triangle" || name == "bilinear") p->kernel = ptex::Kernel::Triangle;
        else if (name == "point") p->kernel = ptex::Kernel::Point;
        else if (name != "gaussian" && name != "default")
            world.diagnostics().reportOnce(
                "ptexture:" + name,
                {Severity::Warning,
                 Rie::Unimplement,
                 {s.place.file < int(k.files().size()) ? k.files()[size_t(s.place.file)] : "", s.place.line, s.place.column},
                 "ptexture(): there is no filter \"" + name + "\"; gaussian is used",
                 "filters are gaussian, triangle, box and point",
                 {}});
    }
    i.resolved = std::move(p);
}

/// Converts a step in space to u and v of a face.
Vec2 stepOnFace(const geometry::FacePlace& f, const Vec3& step) {
    const double a = dot(f.Pu, f.Pu), b = dot(f.Pu, f.Pv), c = dot(f.Pv, f.Pv), det = double(a) * c - double(b) * b;
    if (!(det > 1e-12 * double(a) * c)) return {0, 0};
    const double x = dot(f.Pu, step), y = dot(f.Pv, step);
    return {float((c * x - b * y) / det), float((a * y - b * x) / det)};
}

/// Position and width of the lookup: from the differences to the neighbouring points, at most half the sides of a box each.
void footprint(const PtexSite& s, const ServiceCall& call, int lane, const ShadePoint& p, ptex::Query& q) {
    const auto row = [&](size_t k) { return k < s.rows.size() ? call.at(s.rows[k], lane) : 0.f; };
    if (s.rows.size() >= 8) {
        float lo[2] = {row(0), row(1)}, hi[2] = {row(0), row(1)}, sum[2] = {};
        for (size_t k = 0; k < 8; ++k) {
            lo[k & 1] = std::min(lo[k & 1], row(k));
            hi[k & 1] = std::max(hi[k & 1], row(k));
            sum[k & 1] += row(k) / 4;
        }
        q.u = sum[0], q.v = sum[1];
        q.wu = hi[0] - lo[0], q.wv = hi[1] - lo[1];
        return;
    }
    const auto place = s.own && p.shape ? geometry::facePlace(*p.shape, p.surface) : std::nullopt;
    if (!place) {
        q.u = row(0), q.v = row(1);
        q.wu = std::fabs(row(2)) + std::fabs(row(4));
        q.wv = std::fabs(row(3)) + std::fabs(row(5));
        return;
    }
    q.u = place->u, q.v = place->v;
    const Vec2 a = stepOnFace(*place, p.surface.dPdu * p.du), b = stepOnFace(*place, p.surface.dPdv * p.dv);
    q.wu = std::fabs(a.x) + std::fabs(b.x);
    q.wv = std::fabs(a.y) + std::fabs(b.y);
}

} // namespace

const ptex::Texture* Services::ptexOf(int32_t id, const ServiceCall& call) {
    const auto [at, fresh] = ptex_.try_emplace(id, nullptr);
    if (fresh && id) at->second = world_->ptex().find(rsl::internedString(id), call.place());
    return at->second;
}

static void answerPtexture(Services& answers, const ServiceCall& call) {
    const auto& s = static_cast<const PtexSite&>(*call.s.resolved);
    const auto number = [&](int row, int lane, float fallback) { return row < 0 ? fallback : call.at(row, lane); };
    call.each([&](int lane, const ShadePoint& p) {
        const ptex::Texture* t = answers.ptexOf(s.computed ? std::bit_cast<int32_t>(call.at(0, lane)) : call.s.nameId, call);
        if (!t || s.face < 0) return;
        ptex::Query q;
        q.kernel = s.kernel;
        q.count = s.count;
        footprint(s, call, lane, p, q);
        const float width = number(s.width, lane, 1), blur = number(s.blur, lane, 0);
        q.wu = q.wu * number(s.swidth, lane, width) + number(s.sblur, lane, blur);
        q.wv = q.wv * number(s.twidth, lane, width) + number(s.tblur, lane, blur);
        const float channel = call.at(s.channel, lane), face = call.at(s.face, lane);
        q.channel = channel >= 0 && channel < 1e6f ? int(channel) : channel < 0 ? -1000 : 1 << 20;
        q.fill = number(s.fill, lane, 0);
        q.face = face >= 0 && face < 4e9f ? uint32_t(face + .5f) : ~0u;
        float out[3] = {};
        if (!ptex::lookup(*t, q, out))
            call.diagnostics.reportOnce("ptexture:face" + call.name(lane),
                                        {Severity::Warning,
                                         Rie::Range,
                                         call.place(),
                                         "ptexture(): \"" + call.name(lane) + "\" has " + std::to_string(t->head().faces.size()) +
                                             " faces, but the shader requests a face beyond them; the result is 0",
                                         "a shader parameter __faceindex receives the number of the face",
                                         {}});
        for (int k = 0; k < s.count; ++k) call.put(k, lane, out[k]);
    });
}

Service ptextureService() {
    return {"ptexture", SiteKind::Service, kSendsNothing | kReadsFacePlaces, answerPtexture, bindPtexture};
}

} // namespace alpenglow::services
