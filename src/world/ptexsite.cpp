#include "world/ptexsite.h"
#include "world/impl.h"
#include "world/ptexstore.h"

namespace alpenglow::world {

std::shared_ptr<const PtexSite> ptexSite(const SiteInfo& i, const rsl::CompiledKernel& k, WorldImpl& world) {
    auto p = std::make_shared<PtexSite>();
    const rsl::ir::Site& s = *i.site;
    if (!world.ptex_)
        world.ptex_ =
            std::make_shared<PtexStore>(MapFiles{world.settings_.texturePaths, world.settings_.read}, *world.diagnostics_);
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
            world.diagnostics_->reportOnce(
                "ptexture:" + name,
                {Severity::Warning,
                 Rie::Unimplement,
                 {s.place.file < int(k.files().size()) ? k.files()[size_t(s.place.file)] : "", s.place.line, s.place.column},
                 "ptexture(): there is no filter \"" + name + "\"; gaussian is used",
                 "filters are gaussian, triangle, box and point",
                 {}});
    }
    return p;
}

} // namespace alpenglow::world
