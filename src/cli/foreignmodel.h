// Models of other programs (models/modelfile.h) as scenes: their maps are in the folder of the RIB, or in a folder that lives as
// long as the run.
#pragma once
#include "base/diagnostics.h"
#include "models/rib.h"
#include <filesystem>
#include <map>
#include <string>
#include <tuple>

namespace alpenglow::cli {

/// Makes the maps of a model's materials (texture/maketexture.h), each once: pictures of colours as light, others as numbers,
/// with the wrap modes that they are used with.
class ModelMaps {
public:
    /// Maps go to `folder` as stem_NAME.tex; scenes name them with `before` in front. The model outlives this.
    ModelMaps(const models::Model&, std::filesystem::path folder, std::string stem, std::string before, Diagnostics&);
    ~ModelMaps();
    ModelMaps(const ModelMaps&) = delete;
    /// An empty name after an error, which was reported.
    models::MapFile operator()(const models::MapWish&);

private:
    using Key = std::tuple<int, bool, models::Wrap, models::Wrap>;
    std::string source(int image);
    std::string nameFor(const Key&);
    const models::Model& model_;
    std::filesystem::path folder_, own_; ///< own_: of pictures that came inside of the model; "": none yet
    std::string stem_, before_;
    Diagnostics& diags_;
    std::map<Key, models::MapFile> made_;
    std::map<std::string, int> names_;
};

/// The channels of a picture by its first bytes: PNG and JPEG; 3 for others.
int channelsOf(const std::vector<uint8_t>& picture);

/// Reads a model and gives the text of its scene piece by piece. False: an error was reported.
bool writeForeignScene(const std::string& file, const models::RibOptions&, const std::filesystem::path& mapFolder,
                       const std::string& stem, const std::string& before, const std::function<void(std::string_view)>& text,
                       Diagnostics&);

/// A folder for the maps of models that are rendered without a RIB; it is removed at the end.
class ModelFolder {
public:
    ModelFolder() = default;
    ModelFolder(const ModelFolder&) = delete;
    ~ModelFolder();
    /// Makes it, when there is a model among the scenes; "" when there is none, or it cannot be made.
    const std::string& pathFor(const std::vector<std::string>& scenes);
    /// A model's scene, whose maps lie in the folder. "": an error was reported.
    std::string scene(const std::string& file, double time, Diagnostics&);

private:
    std::string path_;
    int count_ = 0;
};

} // namespace alpenglow::cli
