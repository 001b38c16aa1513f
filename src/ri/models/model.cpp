#include "ri/models/model.h"
#include "base/limits.h"
#include "base/srgb.h"
#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace alpenglow::ri {

ModelLog::~ModelLog() {
    if (reported_ > size_t(limits::kModelMessages))
        sink_(Severity::Warning, Rie::Limit, {last_.file, 0, 0},
              fmt::format("{} more faults of this file", reported_ - size_t(limits::kModelMessages)));
}

void ModelLog::say(Severity s, Rie code, const SourcePlace& place, std::string message) {
    last_ = place;
    if (++reported_ <= size_t(limits::kModelMessages)) sink_(s, code, place, std::move(message));
}

scene::Param variable(const char* name, scene::Class cls, scene::Type type, std::vector<float> numbers) {
    scene::Param p;
    p.name = name;
    p.cls = cls;
    p.type = type;
    p.numbers = std::move(numbers);
    return p;
}

float storedColor(double c) { return srgbDecode(float(std::clamp(c, 0.0, 1.0))); }

static std::string ending(const std::string& path) {
    const size_t dot = path.rfind('.');
    std::string e = dot == path.npos ? "" : path.substr(dot);
    for (char& c : e) c = char(std::tolower(static_cast<unsigned char>(c)));
    return e;
}

bool namedAsModel(const std::string& path) { return ending(path) == ".ply" || ending(path) == ".obj"; }

std::vector<scene::Primitive> readModel(const std::string& path, std::string_view bytes, const ReadLibrary& library,
                                        ModelLog& log) {
    return ending(path) == ".obj" ? readObj(path, bytes, library, log) : readPly(path, bytes, log);
}

} // namespace alpenglow::ri
