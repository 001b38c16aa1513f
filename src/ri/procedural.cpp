// Procedurals: content from archives, programs and libraries, expanded where they stand, in the order of the file, or later
// (deferred.cpp).
#include "base/exact.h"
#include "base/limits.h"
#include "ri/deferred.h"
#include "ri/interpreter.h"
#include "ri/program.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace alpenglow::ri {

namespace fs = std::filesystem;

namespace {

/// The screen window, set or default, and the larger side of a pixel on it.
struct Screen {
    double left, right, bottom, top, pixel;
    explicit Screen(const scene::Options& o) {
        const double aspect = o.frameAspect ? double(*o.frameAspect) : double(o.xres) * o.pixelAspect / std::max(1, o.yres);
        right = std::max(1.0, aspect), top = right / aspect, left = -right, bottom = -top;
        if (o.screenWindow && o.screenWindow->size() == 4) {
            const auto& w = *o.screenWindow;
            left = std::min(w[0], w[1]), right = std::max(w[0], w[1]), bottom = std::min(w[2], w[3]), top = std::max(w[2], w[3]);
        }
        pixel = std::max((right - left) / std::max(1, o.xres), (top - bottom) / std::max(1, o.yres));
    }
};

double tangentOf(const scene::Options& o) {
    return o.projection == "perspective" ? exact::tan(std::clamp(double(o.fov), 1e-3, 179.9) * kPi / 360) : 1;
}

/// An attribute as a truth value: its first number is not 0. fallback: if the attribute is not set.
bool says(const scene::Attributes& a, const std::string& name, bool fallback) {
    const scene::Param* p = a.value(name);
    if (!p) return fallback;
    return p->strings.empty() ? !p->numbers.empty() && p->numbers[0] != 0 : p->strings[0] != "transparent";
}

/// Whether nothing but the camera may meet what is made here, or the scene asks that what the camera does not meet is left out.
bool forTheCameraOnly(const scene::Attributes& a) {
    if (a.value("cull:hidden")) return says(a, "cull:hidden", true);
    const bool traced = says(a, "visibility:trace", true);
    return !says(a, "visibility:diffuse", traced) && !says(a, "visibility:specular", traced) &&
           !says(a, "visibility:transmission", true) && !says(a, "visibility:photon", false);
}

/// Whether all corners lie beyond one side of the picture, a filter's width and more around it, or behind the eye.
bool outside(const scene::Options& o, std::span<const Vec3d> corners) {
    const Screen s(o);
    const double more = (std::max(o.filter.xwidth, o.filter.ywidth) + 2) * s.pixel, t = tangentOf(o);
    const bool perspective = o.projection == "perspective";
    const auto all = [&](const auto& beyond) { return std::all_of(corners.begin(), corners.end(), beyond); };
    const auto edge = [&](double at, const Vec3d& p) { return at * t * (perspective ? p.z : 1); };
    return all([](const Vec3d& p) { return p.z < 0; }) || all([&](const Vec3d& p) { return p.x < edge(s.left - more, p); }) ||
           all([&](const Vec3d& p) { return p.x > edge(s.right + more, p); }) ||
           all([&](const Vec3d& p) { return p.y < edge(s.bottom - more, p); }) ||
           all([&](const Vec3d& p) { return p.y > edge(s.top + more, p); });
}

bool affine(const Matrix& m) { return m.m[0][3] == 0 && m.m[1][3] == 0 && m.m[2][3] == 0; }

Vec3d corner(const std::vector<float>& bound, int k) {
    return {bound[k & 1 ? 1 : 0], bound[k & 2 ? 3 : 2], bound[k & 4 ? 5 : 4]};
}

/// The largest factor by which a matrix can make a vector longer, or more.
double growth(const Matrix& m) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += m.m[i][j] * m.m[i][j];
    return std::sqrt(sum);
}

/// How far displacement may move what is made with these attributes, object space. Negative: not known.
double reachOf(const scene::Attributes& a, const Matrix& toWorld) {
    const scene::Param* sphere = a.value("displacementbound:sphere");
    if (!sphere || sphere->numbers.empty()) return a.displacement ? -1 : 0;
    const scene::Param* space = a.value("displacementbound:coordinatesystem");
    const std::string in = space && !space->strings.empty() ? space->strings[0] : "object";
    const double r = std::fabs(double(sphere->numbers[0]));
    if (in == "object" || in == "shader") return r;
    return in == "world" || in == "camera" || in == "current" ? r * growth(inverse(toWorld)) : -1;
}

} // namespace

/// What the camera need not meet, and what emits no light, can wait.
bool Interpreter::waits(const std::string& kind, const std::vector<std::string>& arguments, const std::vector<float>& given,
                        const Call& call) {
    if (!settings.defers || !inWorld() || !frameWanted() || given.size() != 6) return false;
    if (motion_ || capture_ || !everywhere_.empty()) return false;
    if (innermost(BlockKind::Object) || innermost(BlockKind::Solid) || innermost(BlockKind::Edit)) return false;
    const scene::Attributes& a = *state.attributes;
    if (a.areaLight >= 0 || !a.solid.empty()) return false;
    std::vector<float> bound;
    const double reach = reachOf(a, state.ctm.first());
    for (size_t k = 0; k < 6; k += 2) {
        bound.push_back(float(double(std::min(given[k], given[k + 1])) - reach));
        bound.push_back(float(double(std::max(given[k], given[k + 1])) + reach));
    }
    if (!(reach >= 0) || !std::all_of(bound.begin(), bound.end(), [](float x) { return std::fabs(x) < 1e15f; })) return false;
    scene::Options o = options;
    if (settings.overrides) settings.overrides(o);
    std::vector<Vec3d> corners;
    for (const Matrix& key : state.ctm.keys) {
        const Matrix m = key * worldToCamera_.first();
        if (!affine(m)) return false;
        for (int k = 0; k < 8; ++k) corners.push_back(transformPoint(m, corner(bound, k)));
    }
    if (o.hider == "photon" || !outside(o, corners)) return false;
    putWaiting({kind, arguments, given, call, {}, {}, false, {}, {}}, std::move(bound));
    return true;
}

/// Area in pixels of the bound's rectangle in the picture, which programs get as their level of detail; infinite if it reaches
/// behind the eye. Negative: what is in it cannot change the picture, as only the camera may meet it and it lies outside: under
/// hidden, without a lens or movement, displacement, lights and solids.
double Interpreter::detailOf(const std::vector<float>& bound) const {
    if (bound.size() != 6 || !inWorld()) return INFINITY;
    scene::Options o = options;
    if (settings.overrides) settings.overrides(o);
    const Screen s(o);
    const bool perspective = o.projection == "perspective";
    const double scale = tangentOf(o);
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    const Matrix m = state.ctm.first() * worldToCamera_.first();
    Vec3d corners[8];
    bool behind = false;
    for (int k = 0; k < 8; ++k) {
        const Vec3d p = corners[k] = transformPoint(m, corner(bound, k));
        const double w = perspective ? p.z * scale : 1;
        behind |= !(w > 1e-9);
        const double at[2] = {p.x / w / (s.right - s.left) * o.xres, p.y / w / (s.top - s.bottom) * o.yres};
        for (int i = 0; i < 2; ++i) lo[i] = std::min(lo[i], at[i]), hi[i] = std::max(hi[i], at[i]);
    }
    const scene::Attributes& a = *state.attributes;
    const bool still = !state.ctm.moves() && !worldToCamera_.moves() && affine(m) && !(o.fstop > 0 && o.fstop < 1e30f);
    const bool plain =
        (perspective || o.projection == "orthographic" || o.projection.empty()) && !scene::find(o.projectionParams, "stereo");
    const bool placed = innermost(BlockKind::Object) == nullptr && innermost(BlockKind::Solid) == nullptr;
    if (o.hider == "hidden" && still && plain && placed && a.areaLight < 0 && !a.displacement && forTheCameraOnly(a) &&
        outside(o, corners))
        return -1;
    const double area = (hi[0] - lo[0]) * (hi[1] - lo[1]);
    return !behind && std::isfinite(area) ? area : INFINITY;
}

/// Not where the shell or the loader looks: whose files these are is to be seen in the scene.
std::string Interpreter::findForeign(const std::vector<std::string>& names, int access, std::string& looked) const {
    std::vector<std::string> folders;
    if (fs::path(names[0]).is_absolute()) folders.push_back("");
    else {
        if (auto o = options.values.find("searchpath:procedural"); o != options.values.end() && !o->second.strings.empty())
            for (const std::string& f : splitSearchPath(o->second.strings[0])) {
                if (f == "@" || f == "&") continue;
                folders.push_back(f);
                if (fs::path(f).is_relative() && !sceneFolder_.empty()) folders.push_back((fs::path(sceneFolder_) / f).string());
            }
        folders.insert(folders.end(), settings.searchPaths.begin(), settings.searchPaths.end());
        folders.push_back(sceneFolder_.empty() ? "." : sceneFolder_);
        folders.insert(folders.end(), settings.lastProceduralPaths.begin(), settings.lastProceduralPaths.end());
    }
    for (const std::string& f : folders) {
        for (const std::string& name : names) {
            const std::string path = f.empty() ? name : (fs::path(f) / name).string();
            std::error_code ec;
            if (fs::is_regular_file(path, ec) && ::access(path.c_str(), access) == 0) return fs::absolute(path, ec).string();
        }
        looked += (looked.empty() ? "" : ", ") + (f.empty() ? std::string("/") : f);
    }
    return {};
}

/// The process of a command, started at its first request. Null if it cannot be started, which is reported once.
Program* Interpreter::programOf(const std::string& command, const SourcePlace& place) {
    const auto [slot, fresh] = programs_.try_emplace(command);
    if (!fresh) return slot->second.get();
    std::vector<std::string> words = commandWords(command);
    std::string looked, why;
    if (words.empty()) {
        reporter.error(Rie::MissingData, place, "RunProgram: the program has no name");
        return nullptr;
    }
    const std::string path = findForeign({words[0]}, X_OK, looked);
    if (path.empty()) {
        reporter.error(Rie::NoFile, place, fmt::format("program \"{}\" was not found", words[0]),
                       "looked in " + looked + "; Option \"searchpath\" \"procedural\" names folders");
        return nullptr;
    }
    words[0] = path;
    slot->second = Program::start(words, why);
    if (!slot->second) reporter.error(Rie::System, place, fmt::format("program \"{}\" cannot be started: {}", path, why));
    return slot->second.get();
}

void Interpreter::leavePrograms() {
    // A program that did not start or did not answer has failed before; it is not started again.
    std::erase_if(programs_, [](auto& p) {
        if (p.second) p.second->leave();
        return p.second != nullptr;
    });
}

void Interpreter::endPrograms() { programs_.clear(); }

bool Interpreter::mayMake(const Call& call) {
    if (++programCalls_ > limits::kProgramCalls) {
        reporter.once("ri:programcalls", Severity::Error, Rie::Limit, call.place,
                      fmt::format("more than {} procedurals are run", limits::kProgramCalls));
        return false;
    }
    if (openArchives_.size() >= size_t(limits::kArchiveDepth)) {
        reporter.once(
            "ri:archivedepth", Severity::Error, Rie::Limit, call.place,
            fmt::format("archives and procedurals are nested deeper than {}: deeper ones are left out", limits::kArchiveDepth));
        return false;
    }
    return frameWanted();
}

void Interpreter::runProgram(const std::string& command, const std::string& data, const std::vector<float>& bound,
                             const Call& call) {
    if (!mayMake(call)) return;
    Program* program = programOf(command, call.place);
    if (!program) return;
    const double detail = detailOf(bound);
    std::string answer, why;
    std::string line = std::isfinite(detail) ? fmt::format("{:.6g} ", detail) : "inf ";
    for (const char c : data) line += c == '\n' ? ' ' : c; // a line is a question
    const bool whole = program->ask(line + "\n", settings.programSeconds, settings.stop, answer, why);
    if (!whole) {
        programs_[command] = nullptr;
        reporter.error(Rie::System, call.place,
                       fmt::format("program \"{}\": {}; it is not asked again, and what it said is drawn", command, why),
                       why == kEndsAsText ? "write it as a byte; in Python: sys.stdout.buffer.write(b'\\xff')" : "");
    }
    if (!begin(BlockKind::Attribute, call)) return;
    readOpened(fmt::format("program:{}", ++programSerial_), "output of " + commandWords(command)[0], nullptr,
               memorySource(answer), call.place);
    end(BlockKind::Attribute, call);
}

void Interpreter::procedural(const std::string& kind, const std::vector<std::string>& arguments, const std::vector<float>& bound,
                             const Call& call) {
    const bool archive = kind == "DelayedReadArchive";
    if (!archive && !settings.allowExec)
        return reporter.once(
            "ri:foreign:" + kind, Severity::Error, Rie::Incapable, call.place,
            fmt::format("{} \"{}\" runs foreign code: it needs --allow-exec and is left out", call.request->name, kind));
    if (archive ? arguments.empty() : arguments.empty() || arguments[0].empty()) {
        const char* what = archive ? "archive" : kind == "DynamicLoad" ? "library" : "program";
        return reporter.error(Rie::MissingData, call.place, fmt::format("{}: the {} has no name", call.request->name, what));
    }
    const bool all = settings.executed != nullptr; // whatever the camera sees
    if (!all &&
        (detailOf(bound) < 0 || (archive && instanceOfArchive(arguments[0], call)) || waits(kind, arguments, bound, call)))
        return;
    makeNow(kind, arguments, bound, call);
}

void Interpreter::makeNow(const std::string& kind, const std::vector<std::string>& arguments, const std::vector<float>& bound,
                          const Call& call) {
    const std::string data = arguments.size() > 1 ? arguments[1] : "";
    if (kind == "DynamicLoad") return runLibrary(arguments[0], data, bound, call);
    if (kind == "RunProgram") return runProgram(arguments[0], data, bound, call);
    readDelayed(arguments[0], call);
}

} // namespace alpenglow::ri
