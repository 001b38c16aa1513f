#include "view/picture.h"
#include "base/half.h"
#include "render/noise.h"
#include <algorithm>
#include <bit>
#include <cstring>

namespace alpenglow::view {

const Plane* Picture::plane(const std::string& name) const {
    const auto i = std::find_if(planes.begin(), planes.end(), [&](const Plane& p) { return p.name == name; });
    return i == planes.end() ? nullptr : &*i;
}

display::Image noisePlane(const render::Film& film) {
    const render::Window& w = film.window();
    display::Image image = display::makeImage(w.width(), w.height(), {"noise"});
    float* to = image.data.data();
    for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) *to++ = float(render::relativeStandardError(film.moments(x, y)));
    return image;
}

void overlay(Picture& onto, const Picture& from) {
    const render::Window &a = onto.window, &b = from.window;
    if (onto.stepX != from.stepX || onto.width != from.width || onto.height != from.height) return;
    for (Plane& p : onto.planes) {
        const Plane* q = from.plane(p.name);
        if (!q || q->image->channels != p.image->channels) continue;
        auto copy = std::make_shared<display::Image>(*p.image);
        const size_t n = copy->channels.size();
        const int x0 = std::max(a.x0, b.x0), x1 = std::min(a.x1, b.x1);
        for (int y = std::max(a.y0, b.y0); y < std::min(a.y1, b.y1) && x0 < x1; ++y)
            std::memcpy(copy->pixel(x0 - a.x0, y - a.y0), q->image->pixel(x0 - b.x0, y - b.y0),
                        size_t(x1 - x0) * n * sizeof(float));
        p.image = std::move(copy);
    }
}

void fill(Picture& onto, const std::vector<uint8_t>& there, const Picture& from) {
    if (onto.width != from.width || onto.height != from.height) return;
    const auto under = [](int at, int first, double step, const Plane& q, bool along, int fromFirst, double fromStep) {
        const int i = int((at + first + .5) * step / fromStep) - fromFirst;
        return i >= 0 && i < (along ? q.image->width : q.image->height) ? i : -1;
    };
    for (Plane& p : onto.planes) {
        const Plane* q = from.plane(p.name);
        if (!q || q->image->channels != p.image->channels) continue;
        auto copy = std::make_shared<display::Image>(*p.image);
        const size_t n = copy->channels.size();
        for (int y = 0; y < copy->height; ++y)
            for (int x = 0; x < copy->width; ++x) {
                const size_t at = size_t(y) * size_t(copy->width) + size_t(x);
                if (at >= there.size() || there[at]) continue;
                const int i = under(x, onto.window.x0, onto.stepX, *q, true, from.window.x0, from.stepX);
                const int j = under(y, onto.window.y0, onto.stepY, *q, false, from.window.y0, from.stepY);
                if (i >= 0 && j >= 0) std::memcpy(copy->pixel(x, y), q->image->pixel(i, j), n * sizeof(float));
            }
        p.image = std::move(copy);
    }
}

display::Image dimmed(const Picture& picture, const std::map<std::string, double>& dim) {
    display::Image image = *picture.planes.front().image;
    const size_t n = image.channels.size(), pixels = size_t(image.width) * size_t(image.height);
    for (const auto& [handle, factor] : dim) {
        const Plane* light = factor == 1 ? nullptr : picture.plane("light:" + handle);
        if (!light || light->image->channels.size() != 3 || light->image->width != image.width ||
            light->image->height != image.height)
            continue;
        const float by = float(factor - 1);
        for (size_t i = 0; i < pixels; ++i)
            for (size_t k = 0; k < 3; ++k) image.data[i * n + k] += by * light->image->data[i * 3 + k];
    }
    return image;
}

std::string halves(const Picture& picture, const Plane& plane, const std::map<std::string, double>& dim) {
    const bool mix = &plane == &picture.planes.front() && std::any_of(dim.begin(), dim.end(), [&](const auto& d) {
        return d.second != 1 && picture.plane("light:" + d.first);
    });
    const display::Image mixed = mix ? dimmed(picture, dim) : display::Image{};
    const display::Image& image = mix ? mixed : *plane.image;
    const size_t n = image.channels.size(), pixels = size_t(image.width) * size_t(image.height);
    const bool alpha = &plane == &picture.planes.front() && n >= 4;
    std::string bytes(pixels * 8, '\0');
    const float* p = image.data.data();
    char* to = bytes.data();
    for (size_t i = 0; i < pixels; ++i, p += n, to += 8) {
        const uint16_t one[4] = {toHalf(p[0]), toHalf(n > 1 ? p[1] : p[0]),
                                 toHalf(n > 2   ? p[2]
                                        : n > 1 ? 0
                                                : p[0]),
                                 alpha ? toHalf(p[3]) : uint16_t(0x3c00)};
        std::memcpy(to, one, 8);
    }
    return bytes;
}

} // namespace alpenglow::view
