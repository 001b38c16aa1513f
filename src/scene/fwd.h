// Names of what scene/scene.h defines, for headers that only pass them on.
#pragma once

namespace alpenglow::scene {

struct Frame;
struct Instance;
struct Object;
struct Options;
class FrameConsumer;

} // namespace alpenglow::scene
