// libalpenglow_pictures.so: reads picture formats through OpenImageIO that the program does not read itself. A child process
// loads it for the first such file (display/foreign.h); nothing else links OpenImageIO.
#include "display/foreign.h"
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/typedesc.h>
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using alpenglow::display::ForeignLimits;
using alpenglow::display::ForeignPicture;
using alpenglow::display::kForeignName;
using alpenglow::display::sendForeign;

/// Why a picture of this size is not read; "": it is.
std::string tooLarge(const OIIO::ImageSpec& s, const ForeignLimits& l, uint64_t fileBytes) {
    if (s.width <= 0 || s.height <= 0 || s.nchannels <= 0) return "it has no pixels";
    if (uint64_t(s.width) > l.side || uint64_t(s.height) > l.side)
        return "a side is longer than " + std::to_string(l.side) + " pixels";
    if (uint64_t(s.nchannels) > l.channels) return "it has more than " + std::to_string(l.channels) + " channels";
    const uint64_t bytes = uint64_t(s.width) * uint64_t(s.height) * uint64_t(s.nchannels) * sizeof(float);
    if (bytes > l.bytes) return "its pixels would take more than " + std::to_string(l.bytes >> 30) + " GiB";
    if (bytes > l.smallBytes && bytes / l.expansion > fileBytes) return "it is too short for its stated size";
    return {};
}

/// Names as our codecs have them.
std::string channelName(const OIIO::ImageSpec& s, int c) {
    std::string n = size_t(c) < s.channelnames.size() ? s.channelnames[size_t(c)] : "channel" + std::to_string(c);
    if (n == "R" || n == "G" || n == "B" || n == "A" || n == "Y" || n == "Z") n[0] = char(n[0] - 'A' + 'a');
    if (n == "I" && s.nchannels <= 2) n = "y";
    return n.substr(0, kForeignName - 1);
}

std::string readTo(const char* path, int to, const ForeignLimits& limits) {
    std::error_code e;
    const uint64_t fileBytes = std::filesystem::file_size(path, e);
    OIIO::attribute("threads", 1);
    auto in = OIIO::ImageInput::open(path);
    if (!in) {
        const std::string why = OIIO::geterror();
        return why.empty() ? "it is not a picture in a known format" : why;
    }
    const OIIO::ImageSpec& s = in->spec();
    if (const std::string why = tooLarge(s, limits, fileBytes); !why.empty()) return why;
    ForeignPicture p{};
    p.stamp = alpenglow::display::kForeignStamp;
    p.width = s.width;
    p.height = s.height;
    p.channels = s.nchannels;
    p.bits = int(s.format.size()) * 8;
    p.floating = s.format.is_floating_point();
    const std::string space = s.get_string_attribute("oiio:ColorSpace");
    const float gamma = s.get_float_attribute("oiio:Gamma", 0);
    // "gamma: file value = light ^ gamma": OpenImageIO has its inverse. That a format is sRGB by custom is no declaration.
    if (gamma > 1) std::strncpy(p.colourSpace, std::to_string(1 / gamma).c_str(), kForeignName - 1);
    else if (space == "Linear" && !p.floating) std::strncpy(p.colourSpace, "1", kForeignName - 1);
    std::vector<float> pixels(size_t(p.width) * size_t(p.height) * size_t(p.channels));
    if (!in->read_image(0, 0, 0, s.nchannels, OIIO::TypeDesc::FLOAT, pixels.data())) {
        const std::string why = in->geterror();
        return why.empty() ? "it is damaged" : why;
    }
    bool good = sendForeign(to, &p, sizeof p);
    for (int c = 0; c < p.channels && good; ++c) {
        char name[kForeignName] = "";
        std::strncpy(name, channelName(s, c).c_str(), kForeignName - 1);
        good = sendForeign(to, name, kForeignName);
    }
    good = good && sendForeign(to, pixels.data(), pixels.size() * sizeof(float));
    return good ? "" : "out of memory";
}

} // namespace

extern "C" int alpenglow_read_picture(const char* path, int to, const ForeignLimits* limits, char* why, int whySize) {
    std::string text;
    try {
        text = readTo(path, to, *limits);
    } catch (const std::exception& e) { text = e.what(); }
    std::strncpy(why, text.c_str(), size_t(whySize) - 1);
    return text.empty() ? 0 : 1;
}
