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
    std::string handle;                   ///< of ObjectBegin; "" for what instances share
    std::vector<PrimitiveRef> primitives; ///< in object space
};
/// ObjectInstance: an object at a place, with the attributes of the request.
struct Instance {
    int object = -1;
    Transform toWorld; ///< object space to world
    AttributesRef attributes;
    SourcePlace place;
};

/// Frozen at WorldBegin.
struct Options {
    int xres = 640, yres = 480;       ///< pixels
    float pixelAspect = 1;            ///< width divided by height of a pixel
    bool formatSet = false;           ///< Format was called
    std::optional<float> frameAspect; ///< width divided by height of the picture; nothing: FrameAspectRatio was not called
    std::optional<std::vector<float>> screenWindow;      ///< left right bottom top
    float crop[4] = {0, 1, 0, 1};                        ///< left right top bottom, fractions of the picture
    std::string projection = "orthographic";             ///< as in the request: "perspective", "orthographic"
    ParamList projectionParams;                          ///< of Projection
    float fov = 90;                                      ///< degrees, of the shorter side
    float clipNear = 1e-10f, clipFar = 1e38f;            ///< camera space, along z
    std::vector<std::pair<Vec3d, Vec3d>> clippingPlanes; ///< camera space point, normal; the side the normal points to is removed
    float fstop = 1e38f, focalLength = 0, focalDistance = 0; ///< fstop 1e38: a pinhole; lengths in camera space
    float shutterOpen = 0, shutterClose = 0;                 ///< in the units of motion blocks
    float pixelSamplesX = 2, pixelSamplesY = 2;              ///< samples along x and y
    bool pixelSamplesSet = false;                            ///< PixelSamples was called
    float pixelVariance = -1;                                ///< < 0: unset
    PixelFilter filter;                                      ///< of all displays without their own
    float gain = 1, gamma = 1;                               ///< of Exposure
    bool exposureSet = false;                                ///< Exposure was called, also with 1 1
    ShaderRef imager;                                        ///< null: none
    AttributesRef attributes; ///< those at WorldBegin: what the imager sees. Null where no stream was read
    Quantize quantizeRgba{255, 0, 255, 0.5f, false}, quantizeZ{0, 0, 0, 0, false}; ///< of Quantize
    std::vector<Display> displays;                                                 ///< empty: ri.pic
    std::map<std::string, Display> mattes;        ///< of SampleFilter "PxrCryptomatte", by handle: in addition to the displays
    std::map<std::string, Param> displayChannels; ///< by name: the declaration, no values
    std::map<std::string, ParamList> displayChannelParams; ///< by name: "quantize", "filter" etc. of that channel
    std::string hider = "hidden";                          ///< as in the request
    SourcePlace hiderPlace;                                ///< of the Hider request
    ParamList hiderParams;                                 ///< of the Hider request
    float relativeDetail = 1;                              ///< of RelativeDetail, >= 0
    int colorSamples = 3;                                  ///< numbers of a colour (ColorSamples)
    std::map<std::string, Param> values;                   ///< Option "class" "name", keyed "class:name"
    int frameNumber = 0;                                   ///< of FrameBegin; 0: none
    bool inFrame = false;                                  ///< between FrameBegin and FrameEnd
    bool abortsOnError = false; ///< ErrorHandler "abort": the first error of the frame ends it without a picture
    Transform worldToCamera;    ///< may move
    /// Named coordinate systems: name -> matrix from that space to camera.
    std::map<std::string, Transform> cameraSpaces;
};

/// One WorldBegin..WorldEnd, complete.
struct Frame {
    Options options; ///< of the frame
    /// Referred to by index: Attributes::lights, Instance::object.
    std::vector<Light> lights;
    std::vector<PrimitiveRef> primitives;
    std::vector<Object> objects;
    std::vector<Instance> instances;
    /// CoordinateSystem names, to world.
    std::map<std::string, Transform> coordinateSystems;
};

} // namespace alpenglow::scene
