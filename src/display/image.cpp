#include "display/image.h"

namespace alpenglow::display {

int Image::channel(std::string_view name) const {
    for (size_t i = 0; i < channels.size(); ++i)
        if (channels[i] == name) return int(i);
    return -1;
}

Matrix screenToNDC() { return scaleMatrix(0.5, -0.5, 1) * translateMatrix(0.5, 0.5, 0); }

Image makeImage(int width, int height, std::vector<std::string> channels) {
    Image m;
    m.width = width;
    m.height = height;
    m.channels = std::move(channels);
    m.data.assign(m.sampleCount(), 0.0f);
    return m;
}

std::vector<std::string> defaultChannels(int count) {
    if (count == 1) return {"y"};
    if (count == 2) return {"y", "a"};
    std::vector<std::string> names{"r", "g", "b", "a"};
    if (count == 3) names.pop_back();
    for (int i = 4; i < count; ++i) names.push_back("channel" + std::to_string(i));
    if (count <= 0) names.clear();
    return names;
}

Image selectChannels(const Image& from, const std::vector<std::string>& names) {
    std::vector<int> index;
    Image to = from;
    to.channels.clear();
    to.levels.clear();
    for (const std::string& n : names)
        if (int c = from.channel(n); c >= 0) {
            index.push_back(c);
            to.channels.push_back(n);
        }
    to.data.assign(to.sampleCount(), 0.0f);
    size_t pixels = size_t(from.width) * size_t(from.height), stride = from.channels.size();
    for (size_t p = 0; p < pixels; ++p)
        for (size_t i = 0; i < index.size(); ++i) to.data[p * index.size() + i] = from.data[p * stride + size_t(index[i])];
    return to;
}

} // namespace alpenglow::display
