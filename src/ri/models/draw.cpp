// Geometry "model.ply": the polygons of a file under the attributes of the request.
#include "base/file.h"
#include "base/limits.h"
#include "ri/interpreter.h"
#include "ri/models/model.h"
#include <filesystem>
#include <fmt/format.h>

namespace alpenglow::ri {

namespace fs = std::filesystem;

namespace {

/// Files that an .obj names are in its folder or below.
std::string inFolderOf(const std::string& model, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.empty() || name.find('\0') != name.npos) return {};
    const fs::path folder = fs::path(model).parent_path();
    std::error_code ec;
    for (const std::string& n : {name, fs::path(name).filename().string()}) {
        const fs::path p = folder / n;
        if (liesBelow(p.string(), {folder.empty() ? "." : folder.string()}) && fs::is_regular_file(p, ec)) return p.string();
    }
    return {};
}

/// Null when it cannot be read; the message went to the sink.
std::optional<std::string> textOf(const std::string& path, const ModelLog::Sink& sink) {
    Diagnostics own;
    const auto bytes = readWholeFile(path, limits::kModelBytes, own, {path, 0, 0});
    for (const Diagnostic& d : own.all()) sink(d.severity, d.code, d.place, d.message);
    if (!bytes) return {};
    return std::string(bytes->begin(), bytes->end());
}

} // namespace

std::vector<scene::Primitive> readModelFile(const std::string& file, const ModelLog::Sink& sink,
                                            const std::shared_ptr<ReadLog>& reads) {
    ModelLog reported(sink);
    const auto text = textOf(file, sink);
    if (!text) return {};
    const ReadLibrary library = [&](const std::string& name) -> std::optional<std::string> {
        const std::string path = inFolderOf(file, name);
        if (path.empty()) return {};
        if (reads) reads->add(path);
        return textOf(path, sink);
    };
    std::vector<scene::Primitive> parts = readModel(file, *text, library, reported);
    for (scene::Primitive& p : parts)
        for (scene::Param& v : p.params)
            if (v.name == "texturename" && !v.strings.empty())
                if (const std::string path = inFolderOf(file, v.strings[0]); !path.empty()) v.strings[0] = path;
    return parts;
}

void Interpreter::drawModel(const std::string& name, const Call& call, const scene::ParamList& constants) {
    if (++archiveReads_ > limits::kArchiveReads) {
        reporter.once("ri:archivereads", Severity::Error, Rie::Limit, call.place,
                      fmt::format("more than {} archives are read", limits::kArchiveReads));
        return;
    }
    consumer.beforeRead(name);
    const std::string file = locate("model", name, call.place, namedAsModel);
    if (file.empty()) return;
    if (!lastModel_ || lastModel_->file != file) {
        lastModel_.reset();
        auto reported = [&](Severity s, Rie code, const SourcePlace& place, std::string message) {
            reporter.report(s, code, place, std::move(message));
        };
        auto model = std::make_shared<Model>(Model{file, readModelFile(file, reported, settings.reads)});
        lastModel_ = std::move(model);
    }
    const auto model = lastModel_; // kept while it is drawn, and for the next request of the same name
    if (model->parts.size() != 1 && gatheringMotion()) {
        incapable(call, fmt::format("a model of {} parts cannot move by deformation", model->parts.size()));
        return;
    }
    for (const scene::Primitive& part : model->parts) {
        scene::Primitive p = part;
        for (scene::Param& v : p.params) v.place = call.place;
        for (const scene::Param& c : constants) { // the request overrides the file
            std::erase_if(p.params, [&](const scene::Param& v) { return v.name == c.name; });
            p.params.push_back(c);
        }
        emit(std::move(p), call);
    }
}

} // namespace alpenglow::ri
