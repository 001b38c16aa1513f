// Texture making (RISpec 3.2, 7.1): handed to the consumer in stream order, between frames.
#include "ri/interpreter.h"

namespace alpenglow::ri {
namespace {

/// Strings among the arguments go to `files` in order; numbers become parameters under the names of the signature.
void make(Interpreter& in, const Call& c) {
    std::vector<std::string> files;
    scene::ParamList params;
    for (size_t i = 0; i < c.arguments.size(); ++i) {
        const ArgSpec& a = c.request->args[i];
        if (!c.arguments[i].strings.empty()) {
            files.insert(files.end(), c.strings(i).begin(), c.strings(i).end());
            continue;
        }
        if (c.arguments[i].numbers.empty()) continue;
        scene::Param p;
        p.name = a.name;
        p.numbers = c.reals(i);
        p.place = c.place;
        params.push_back(std::move(p));
    }
    if (!in.frameWanted()) return in.consumer.passOverTexture(files);
    for (scene::Param& p : in.bind(c, Use::Other)) params.push_back(std::move(p));
    in.consumer.makeTexture(std::string(c.request->name), files, params, c.place);
}

void notMade(Interpreter& in, const Call& c) { in.incapable(c, std::string(c.request->name) + " is not done by this version"); }

} // namespace

std::vector<Request> textureRequests() {
    const Kind k = Kind::Texture;
    const unsigned s = kBase | kFrame; // published files make shadow maps after the world of each frame
    const char* flat =
        "string picture; string texture; string swrap; string twrap; string filter; number swidth; number twidth; ..";
    return {
        {"MakeTexture", flat, k, s, false, "Makes a texture of a picture.",
         "\"a.tif\" \"a.tx\" \"periodic\" \"clamp\" \"box\" 1 1", make},
        {"MakeBump", flat, k, s, false, "The same, for bump maps.", "\"a.tif\" \"a.tx\" \"black\" \"black\" \"gaussian\" 2 2",
         make},
        {"MakeLatLongEnvironment", "string picture; string texture; string filter; number swidth; number twidth; ..", k, s, false,
         "Makes a latitude-longitude environment map.", "\"a.tif\" \"a.env\" \"box\" 1 1", make},
        {"MakeCubeFaceEnvironment",
         "string px; string nx; string py; string ny; string pz; string nz; string texture; number fov; string filter; number "
         "swidth; number twidth; ..",
         k, s, false, "Makes an environment map of six pictures.", "\"a\" \"b\" \"c\" \"d\" \"e\" \"f\" \"g.env\" 90 \"box\" 1 1",
         make},
        {"MakeShadow", "string picture; string shadow; ..", k, s, false, "Makes a shadow map of a depth picture.",
         "\"a.z\" \"a.shd\"", make},
        {"MakeBrickMap", "string[] clouds; string brickmap; ..", k, s, false, "Makes a brick map of point clouds.",
         "[\"a.ptc\"] \"a.bkm\"", make},
        {"MakeOcclusion", "string[] pictures; string shadow; ..", k, s, false,
         "Makes an occlusion map of depth pictures: not done.", "[\"a.z\" \"b.z\"] \"a.shd\"", notMade},
    };
}

} // namespace alpenglow::ri
