// What ri/ writes and everyone else reads: a frame's options, lights, primitives. Append-only once rendering has begun.
#pragma once
#include "scene/display.h"
#include "scene/primitive.h"
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::scene {

/// ObjectBegin..ObjectEnd, or what an instance shares.
struct Object {
    std::string handle;
    std::vector<PrimitiveRef> primitives;
};
/// ObjectInstance: an object at a place, with the attributes of the request.
struct Instance {
    int object = -1;
    Transform toWorld;
    AttributesRef attributes;
    SourcePlace place;
};

/// Frozen at WorldBegin.
struct Options {
    int xres = 640, yres = 480;
    float pixelAspect = 1;
    bool formatSet = false;
    std::optional<float> frameAspect;
    std::optional<std::vector<float>> screenWindow; ///< left right bottom top
    float crop[4] = {0, 1, 0, 1};
    std::string projection = "orthographic";
    ParamList projectionParams;
    float fov = 90;
    float clipNear = 1e-10f, clipFar = 1e38f;
    std::vector<std::pair<Vec3d, Vec3d>> clippingPlanes; ///< camera space point, normal; the side the normal points to is removed
    float fstop = 1e38f, focalLength = 0, focalDistance = 0;
    float shutterOpen = 0, shutterClose = 0;
    float pixelSamplesX = 2, pixelSamplesY = 2;
    bool pixelSamplesSet = false;
    float pixelVariance = -1; ///< < 0: unset
    PixelFilter filter;
    float gain = 1, gamma = 1;
    bool exposureSet = false; ///< Exposure was called, also with 1 1
    ShaderRef imager;
    AttributesRef attributes; ///< those at WorldBegin: what the imager sees. Null where no stream was read
    Quantize quantizeRgba{255, 0, 255, 0.5f, false}, quantizeZ{0, 0, 0, 0, false};
    std::vector<Display> displays;                ///< empty: ri.pic
    std::map<std::string, Display> mattes;        ///< of SampleFilter "PxrCryptomatte", by handle: in addition to the displays
    std::map<std::string, Param> displayChannels; ///< by name: the declaration, no values
    std::map<std::string, ParamList> displayChannelParams; ///< by name: "quantize", "filter" etc. of that channel
    std::string hider = "hidden";
    SourcePlace hiderPlace;
    ParamList hiderParams;
    float relativeDetail = 1;
    int colorSamples = 3;
    std::map<std::string, Param> values; ///< Option "class" "name", keyed "class:name"
    int frameNumber = 0;
    bool inFrame = false;       ///< between FrameBegin and FrameEnd
    bool abortsOnError = false; ///< ErrorHandler "abort": the first error of the frame ends it without a picture
    Transform worldToCamera;
    /// Named coordinate systems: name -> matrix from that space to camera.
    std::map<std::string, Transform> cameraSpaces;
};

/// One WorldBegin..WorldEnd, complete.
struct Frame {
    Options options;
    std::vector<Light> lights;
    std::vector<PrimitiveRef> primitives;
    std::vector<Object> objects;
    std::vector<Instance> instances;
    /// CoordinateSystem names, to world.
    std::map<std::string, Transform> coordinateSystems;
};

} // namespace alpenglow::scene
