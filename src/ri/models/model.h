// Files of polygons that Geometry draws: .ply (Turk 1994) and .obj (Wavefront 1995), to primitives of ours.
//
// What is read is never trusted: counts of a header reserve nothing, memory follows the bytes that are there, a fault is reported
// with its place and what is sound is kept.
#pragma once
#include "base/diagnostics.h"
#include "base/readlog.h"
#include "base/vec.h"
#include "scene/primitive.h"
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::ri {

/// The first faults of a file are reported one by one (limits::kModelMessages), the others are counted.
class ModelLog {
public:
    using Sink = std::function<void(Severity, Rie, const SourcePlace&, std::string)>; ///< receives each message
    /// s: called in the thread that reports.
    explicit ModelLog(Sink s) : sink_(std::move(s)) {}
    ~ModelLog();
    /// Report a fault of the file, or count it.
    void error(Rie code, const SourcePlace& place, std::string message) { say(Severity::Error, code, place, std::move(message)); }
    void warning(Rie code, const SourcePlace& place, std::string message) {
        say(Severity::Warning, code, place, std::move(message));
    }

private:
    void say(Severity, Rie, const SourcePlace&, std::string);
    Sink sink_;
    size_t reported_ = 0;
    SourcePlace last_;
};

/// Primitives without attributes and place, in the file's own space: "PointsPolygons", and "Points" for a .ply without faces.
/// Variables: P; N, Cs, Os, st (0, 0 is the upper left of a picture) where the file has them; numbers of other names by vertex
/// and face. Stored integers of colours are sRGB and become light.
std::vector<scene::Primitive> readPly(const std::string& path, std::string_view bytes, ModelLog&);

/// The text of a file that an .obj names, or nothing. `name` as the file has it.
using ReadLibrary = std::function<std::optional<std::string>(const std::string& name)>;
/// One primitive a material, in order of first use. Of a material: Cs (Kd), Os (d, Tr), the strings "material" and "texturename"
/// (map_Kd).
std::vector<scene::Primitive> readObj(const std::string& path, std::string_view bytes, const ReadLibrary&, ModelLog&);

/// Whether a name ends as those of such files do.
bool namedAsModel(const std::string& path);
/// By the name's end. Empty after an error.
std::vector<scene::Primitive> readModel(const std::string& path, std::string_view bytes, const ReadLibrary&, ModelLog&);

/// A whole file with what it names: libraries, and maps, whose names become paths if they are in the same folder. reads may be
/// null.
std::vector<scene::Primitive> readModelFile(const std::string& file, const ModelLog::Sink&,
                                            const std::shared_ptr<ReadLog>& reads);

/// A variable of a primitive.
scene::Param variable(const char* name, scene::Class, scene::Type, std::vector<float>);
/// A colour that was stored as a whole number, from 0 to 1, as light.
float storedColor(double);

} // namespace alpenglow::ri
