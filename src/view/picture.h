// The current picture for viewers.
#pragma once
#include "display/image.h"
#include "render/film.h"
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::view {

/// A named plane of the picture. Planes of one picture have the same size; linear floats, channels interleaved.
struct Plane {
    std::string name; ///< "picture" (r g b a z), "noise", "light:HANDLE", or as a display's mode has it
    std::shared_ptr<const display::Image> image; ///< null: there is no picture yet
};

/// Figures of a render, for the page.
struct Figures {
    double seconds = 0, spp = 0, raysPerMS = 0;           ///< since it began; samples a pixel; rays a millisecond
    double noiseRSE = 0, noiseRSE999 = 0, efficiency = 0; ///< of render/noise.h
    double noise = 0, noiseAtMost = 0;                    ///< as printed by render, and the bound compared with --noise
};

/// What is shown, complete and immutable.
struct Picture {
    int width = 0, height = 0; ///< of the complete picture
    render::Window window;     ///< that the planes cover, in their own pixels
    double stepX = 1,
           stepY = 1;          ///< pixels of the complete picture per pixel of the planes: more than 1 for a coarse one
    std::vector<Plane> planes; ///< "picture" first
    Figures figures;           ///< when it was taken
    uint64_t number = 0;       ///< of all pictures of a session: no two have the same
    /// By name; null: there is no such plane.
    const Plane* plane(const std::string& name) const;
};

/// The relative error of each pixel, as noiseRSE has it.
display::Image noisePlane(const render::Film&);

/// Copies the pixels of `from` into the planes of `onto` with the same names.
void overlay(Picture& onto, const Picture& from);

/// The pixels of `from`, larger ones too, in `onto` where these are not there: `there` by pixel of its window, in reading order.
void fill(Picture& onto, const std::vector<uint8_t>& there, const Picture& from);

/// Four half floats a pixel, rows from the top, in the order of bytes of this machine: red, green, blue and alpha. A plane of one
/// channel is grey. `dim`: of the plane "picture", the light of each "light:HANDLE" times that.
std::string halves(const Picture&, const Plane&, const std::map<std::string, double>& dim);
/// Red, green and blue of "picture" with lights dimmed.
display::Image dimmed(const Picture&, const std::map<std::string, double>& dim);

} // namespace alpenglow::view
