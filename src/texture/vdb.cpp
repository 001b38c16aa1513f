#include "texture/vdb.h"
#include "display/grids.h"

namespace alpenglow::texture {

std::optional<Volume> loadVdb(const std::string& path, Diagnostics& diags, const SourcePlace& place) {
    auto m = display::readGrids(path, diags, place);
    if (!m) return {};
    Volume v;
    v.width = m->width;
    v.depth = std::max(1, std::atoi(m->metadata["depth"].c_str()));
    v.height = m->height / v.depth;
    v.names = m->channels;
    v.values = std::move(m->data);
    return v;
}

} // namespace alpenglow::texture
