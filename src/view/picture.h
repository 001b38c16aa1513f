// The picture so far, as viewers get it.
#pragma once
#include "display/image.h"
#include "render/film.h"
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::view {

/// What is looked at under one name. Planes of one picture have the same size; floats, linear, channels interleaved.
struct Plane {
    std::string name; ///< "picture" (r g b a z), "noise", "light:HANDLE", or as a display's mode has it
    std::shared_ptr<const display::Image> image;
};

struct Figures {
    double seconds = 0, spp = 0, raysPerMS = 0;
    double noiseRSE = 0, noiseRSE999 = 0, efficiency = 0;
    double noise = 0, noiseAtMost = 0; ///< what render prints, and what --noise compares
};

struct Picture {
    int width = 0, height = 0; ///< of the whole picture
    render::Window window;     ///< that the planes cover, in their own pixels
    double stepX = 1,
           stepY = 1; ///< pixels of the whole picture that one of the planes is wide and high: more than 1 for a coarse one
    std::vector<Plane> planes; ///< "picture" first
    Figures figures;
    uint64_t number = 0; ///< of all pictures of a session: no two have the same
    const Plane* plane(const std::string& name) const;
};

/// The relative error of each pixel, as noiseRSE has it.
display::Image noisePlane(const render::Film&);

/// The pixels of `from` in `onto`, where planes of the same name are there.
void overlay(Picture& onto, const Picture& from);

/// The pixels of `from`, larger ones too, in `onto` where these are not there: `there` by pixel of its window, in reading order.
void fill(Picture& onto, const std::vector<uint8_t>& there, const Picture& from);

/// Four half floats a pixel, rows from the top, in the order of bytes of this machine: red, green, blue and alpha. A plane of one
/// channel is grey. `dim`: of the plane "picture", the light of each "light:HANDLE" times that.
std::string halves(const Picture&, const Plane&, const std::map<std::string, double>& dim);
/// Red, green and blue of "picture" with lights dimmed.
display::Image dimmed(const Picture&, const std::map<std::string, double>& dim);

} // namespace alpenglow::view
