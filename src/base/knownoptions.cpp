// Options, and the parameters of Hider and Display. Attributes have a file of their own.
#include "base/knownoptions.h"
#include "base/knownwords.h"
#include <algorithm>
#include <array>
#include <cstdlib>

namespace alpenglow::known {
namespace {

constexpr std::string_view kOrigin = "PRMan; rays are traced in camera space";
constexpr std::string_view kMemory = "several renderers; --memory-limit is for the whole program here";

constexpr OptionDescription kOptions[] = {
    {"Hider:depthfilter", "", "", "", Ignored, "Aqsis; Hider \"hidden\" \"depthfilter\" is the way here"},
    {"Render:multipass", "", "", "", Ignored, "Aqsis; a frame is drawn in one pass"},
    {"Ri:Clipping", "float[2]", "", "", Computed,
     "Of the request of this name, as all of \"Ri\"; they are also found without it."},
    {"Ri:CropWindow", "float[4]", "", "", Computed, "Of the request of this name."},
    {"Ri:DepthOfField", "float[3]", "", "", Computed, "Of the request of this name."},
    {"Ri:Display", "string", "", "", Computed, "The name of the first Display."},
    {"Ri:Format", "float[3]", "", "", Computed, "Of the request of this name."},
    {"Ri:Frame", "float", "", "", Computed, "The number of FrameBegin."},
    {"Ri:FrameAspectRatio", "float", "", "", Computed, "Of the request of this name, or what follows from Format."},
    {"Ri:Hider", "string", "", "", Computed, "The hider that draws."},
    {"Ri:PixelSamples", "float[2]", "", "", Computed, "Of the request of this name."},
    {"Ri:PixelVariance", "float", "", "", Computed, "Of the request of this name."},
    {"Ri:ScreenWindow", "float[4]", "", "", Computed, "Of the request of this name, or what follows from the frame."},
    {"Ri:Shutter", "float[2]", "", "", Computed, "Of the request of this name."},
    {"bake:maxrecords", "", "", "", Ignored, "PRMan; baked points are written when the frame ends"},
    {"bucket:order", "", "", "", Ignored, "PRMan; the picture does not depend on the order of its tiles"},
    {"caustic:maxpixeldist", "", "", "", Ignored, "BMRT; the hider path finds caustics by photons (Hider parameter caustics)"},
    {"checkpoint:interval", "", "", "", Ignored, "PRMan; --checkpoint is the way here"},
    {"curve:minwidth", "", "", "", Ignored, "PRMan; curves are as wide as they are"},
    {"dice:maxhairlength", "", "", "", Ignored, "PRMan; curves are not diced"},
    {"hidden:shading", "string", "\"micropolygon\"", "\"sample\"", Used,
     "The same as the hider's parameter shading, which has precedence.", "\"micropolygon\""},
    {"hider:aperture", "float[4]", "[0 0 0 0]", "[6 15 0.2 0]", Used,
     "The same as the hider's parameter aperture, which has precedence.", "[0 0 0 0]"},
    {"hider:depthfilter", "string", "\"min\"", "\"midpoint\"", Used,
     "The same as the hider's parameter depthfilter, which has precedence.", "\"min\""},
    {"hider:jitter", "int", "1", "0", Used, "The same as the hider's parameter jitter, which has precedence.", "1"},
    {"indirect:savefile", "", "", "", Ignored, "BMRT; irradiance is not kept between frames; the hider path is the way here"},
    {"indirect:seedfile", "", "", "", Ignored, "BMRT; irradiance is not kept between frames; the hider path is the way here"},
    {"licenseserver:holdlicense", "", "", "", Ignored, "3Delight; there is no license server"},
    {"limits:brickmemory", "int", "", "", Ignored, kMemory},
    {"limits:bucketsize", "int[2]", "", "", Ignored, "several renderers; the picture does not depend on the size of its tiles"},
    {"limits:deepshadowerror", "float", "0.01", "0.002", Used,
     "Deep shadow maps: how far, as a part of the light, a pixel may lie from the mean of its samples. 0: nowhere.", "0.01"},
    {"limits:derivmemory", "", "", "", Ignored, "BMRT; nothing is kept of derivatives"},
    {"limits:extremedisplacement", "", "", "", Ignored, "PRMan; displacement beyond its bound is drawn, with a warning"},
    {"limits:eyesplits", "int", "", "", Ignored, "several renderers; nothing is split at the eye here"},
    {"limits:geocachememory", "", "", "", Ignored, kMemory},
    {"limits:gridsize", "int", "", "", Ignored, "several renderers; the picture does not depend on the size of grids"},
    {"limits:hemispheresamplememory", "", "", "", Ignored, kMemory},
    {"limits:numthreads", "int", "", "", Ignored, "several renderers; --threads is the way here"},
    {"limits:octreememory", "", "", "", Ignored, kMemory},
    {"limits:opacitycachememory", "", "", "", Ignored, kMemory},
    {"limits:othreshold", "color", "", "", Ignored, "several renderers; samples go on until nothing shines through"},
    {"limits:proceduralmemory", "", "", "", Ignored, kMemory},
    {"limits:ptexturememory", "", "", "", Ignored, kMemory},
    {"limits:radiositycachememory", "", "", "", Ignored, kMemory},
    {"limits:rendermemory", "", "", "", Ignored, kMemory},
    {"limits:shadermemory", "", "", "", Ignored, kMemory},
    {"limits:texturememory", "int", "a quarter of the machine's", "2000000", Used,
     "Memory for maps, in kB. What is more lies in scratch files (in TMPDIR, else /var/tmp), of which no more is kept in memory "
     "(maps.md)."},
    {"limits:texturesample", "int", "", "", Ignored,
     "several renderers; lookups are filtered over their footprint; \"samples\" of a call is their number"},
    {"limits:threads", "", "", "", Ignored, "PRMan; --threads is the way here"},
    {"limits:vprelativeshadingrate", "", "", "", Ignored, "PRMan; volumes are sampled along rays, not on grids"},
    {"limits:zthreshold", "color", "", "", Ignored,
     "several renderers; the depth of a pixel is that of the first surface that its samples meet, whatever its opacity"},
    {"messages:filter", "", "", "", Ignored, "3Delight; -q and -v choose what is printed"},
    {"netcache:directory", "string", "", "", Ignored, "3Delight; files are read where they lie"},
    {"netcache:size", "int", "", "", Ignored, "3Delight; files are read where they lie"},
    {"photon:emit", "int", "200000", "1000000", Used, "Photons that are emitted for the photon maps of a frame.", "200000"},
    {"photon:lifetime", "", "", "", Ignored, "PRMan; photon maps live as long as their frame, or in files"},
    {"radiosity:maxlevel", "", "", "", Ignored, "BMRT; the hider path is the way here"},
    {"radiosity:minpatchsamples", "", "", "", Ignored, "BMRT; the hider path is the way here"},
    {"radiosity:steps", "", "", "", Ignored, "BMRT; the hider path is the way here"},
    {"render:bucketorder", "string", "", "", Ignored, "3Delight; the picture does not depend on the order of its tiles"},
    {"render:max_raylevel", "", "", "", Ignored, "BMRT; Option \"trace\" \"maxdepth\" is the way here"},
    {"render:maxsamples", "", "", "", Ignored, "BMRT; PixelSamples or --spp says it"},
    {"render:minsamples", "", "", "", Ignored, "BMRT; PixelSamples or --spp says it"},
    {"render:minshadowbias", "", "", "", Ignored,
     "BMRT; rays begin beyond the error bound of each hit; Attribute \"trace\" \"bias\" sets a distance"},
    {"render:nthreads", "int", "", "", Ignored, "3Delight; --threads is the way here"},
    {"render:prmanspecular", "", "", "", Ignored, "BMRT; Option \"shade\" \"specular\" is the way here"},
    {"render:rerenderbake", "", "", "", Ignored, "PRMan; every frame is drawn anew"},
    {"render:standardatmosphere", "", "", "", Ignored, "3Delight; an atmosphere is on everything that it is an attribute of"},
    {"render:useprmandspy", "", "", "", Ignored, "BMRT; there are no display plug-ins here"},
    {"rib:asciistyle", "", "", "", Ignored, "PRMan; alpenglow rib writes RIB, by its own flags"},
    {"rib:compression", "", "", "", Ignored,
     "PRMan; alpenglow rib writes RIB, by its own flags; of the C binding this option counts"},
    {"rib:format", "", "", "", Ignored, "PRMan; alpenglow rib writes RIB, by its own flags; of the C binding this option counts"},
    {"rib:indentation", "", "", "", Ignored, "PRMan; alpenglow rib writes RIB, by its own flags"},
    {"rib:precision", "", "", "", Ignored, "PRMan; numbers are written so that they read back the same"},
    {"rib:varsubst", "string", "\"\"", "\"$\"", Used,
     "ricpp's name for Option \"ribparse\" \"varsubst\": it is the same option."},
    {"ribparse:varsubst", "string", "\"\"", "\"$\"", Used,
     "The character that begins variables in the texts that follow: ${name} and $name stand for what IfBegin has under that "
     "name. What is not set stays as it is."},
    {"runtime:verbosity", "", "", "", Ignored, "BMRT; -q and -v choose what is printed"},
    {"searchpath:archive", "string", "\"\"", "\"archives:&\"", Used,
     "Folders for ReadArchive, separated by ':'. & is the path so far, @ what is searched without it, ~ and $NAME as a shell has "
     "them.",
     "\"\""},
    {"searchpath:dirmap", "", "", "", Ignored,
     "PRMan; names of files are those of this machine; Option \"searchpath\" names folders"},
    {"searchpath:display", "string", "", "", Ignored, "several renderers; there are no display plug-ins here"},
    {"searchpath:dsolibs", "", "", "", Ignored, "Aqsis; searchpath:rslplugin is for plug-ins of shaders"},
    {"searchpath:plugin", "", "", "", Ignored, "Aqsis; searchpath:rslplugin is for plug-ins of shaders"},
    {"searchpath:procedural", "string", "\"\"", "\"tools\"", Used,
     "Folders for programs and libraries of Procedural \"RunProgram\" and \"DynamicLoad\". After them: --searchpath, the scene's "
     "folder.",
     "\"\""},
    {"searchpath:resource", "string", "", "", Ignored,
     "several renderers; nothing is looked for along it: there is a path for each kind of file"},
    {"searchpath:rixplugin", "", "", "", Ignored, "PRMan; there are no plug-ins of RIS here"},
    {"searchpath:rslplugin", "string", "\"\"", "\"plugins:@\"", Used,
     "Folders for the plug-ins that shaders name; they are loaded with --allow-exec.", "\"\""},
    {"searchpath:shader", "string", "\"\"", "\"shaders:&\"", Used,
     "Folders for shaders and what they #include. After them: --searchpath, ALPENGLOW_SHADERS, the scene's folder, the shipped "
     "shaders.",
     "\"\""},
    {"searchpath:texture", "string", "\"\"", "\"maps:@\"", Used, "Folders for texture, environment and shadow maps.", "\"\""},
    {"shade:specular", "string", "\"prman\"", "\"rispec\"", Used,
     "The exponent of specular(): \"prman\" 8/roughness, \"rispec\" 1/roughness, as RISpec prints it.", "\"prman\""},
    {"shading:directlightingsamples", "", "", "", Ignored,
     "PRMan; each light has its own number of samples, and PixelSamples decides under path"},
    {"shadow:bias", "float", "0.225", "0.05", Used,
     "shadow(): how far before the surfaces of a depth map a point is lit, in world units.", "0.225"},
    {"shadow:bias0", "float", "bias", "0.05", Used,
     "shadow(): comparisons with a depth map spread their bias from bias0 to bias1.", "0.225"},
    {"shadow:bias1", "float", "bias", "0.1", Used, "See bias0.", "0.225"},
    {"shadow:sample", "int", "16", "64", Used, "shadow(): comparisons of a lookup in a depth map.", "16"},
    {"shutter:clampmotion", "", "", "", Ignored, "PRMan; motion ends at its first and last time"},
    {"shutter:offset", "float", "0", "0.5", Used, "Added to both times of Shutter.", "0"},
    {"shutter:shutteropening", "float[2]", "0 1", "[0.25 0.75]", Used,
     "Parts of the shutter's time when it is wide open and when it begins to close; both go linearly.", "[0 1]"},
    {"statistics:displace_ratios", "", "", "", Ignored,
     "PRMan; displacement beyond its bound is reported, with the distance that suffices"},
    {"statistics:echoapi", "", "", "", Ignored, "Aqsis; alpenglow rib prints what is read"},
    {"statistics:endofframe", "int", "", "", Ignored, "several renderers; --stats is the way here"},
    {"statistics:filename", "string", "", "", Ignored, "several renderers; --stats is the way here"},
    {"statistics:level", "", "", "", Ignored, "PRMan; --stats is the way here"},
    {"statistics:progress", "int", "", "", Ignored, "3Delight; --progress is the way here"},
    {"statistics:renderinfo", "", "", "", Ignored, "Aqsis; --stats is the way here"},
    {"statistics:stylesheet", "", "", "", Ignored, "PRMan; --stats writes JSON"},
    {"statistics:xmlfilename", "", "", "", Ignored, "PRMan; --stats is the way here"},
    {"texture:colorspace", "string", "\"auto\"", "\"linear\"", Used,
     "What colours of 8-bit maps are: srgb or linear for maps that declare nothing; or auto: as srgb under path, and under "
     "hidden "
     "and raytrace the numbers of the file (colour.md).",
     "\"auto\""},
    {"texture:enable_gaussian", "", "", "", Ignored, "PRMan; the \"filter\" of a call says it"},
    {"texture:enable_lerp", "", "", "", Ignored, "PRMan; levels of a map are always interpolated"},
    {"texture:maxanisotropy", "float", "", "16", Used,
     "How many times longer than wide the footprint of texture() and environment() may be, at least 1: a longer one is widened, "
     "which blurs. Without it only the number of probes, 32, limits the length."},
    {"texture:missing", "color", "", "[1 0 1]", Used,
     "What texture() and environment() give of a map that cannot be read; without it the call's \"fill\", else 0."},
    {"trace:approximation", "", "", "", Ignored, "3Delight; rays meet the shapes themselves"},
    {"trace:continuationby", "", "", "", Ignored, "PRMan; rays go on by where they ended"},
    {"trace:decimationrate", "", "", "", Ignored, "PRMan; rays meet the same facets as the camera"},
    {"trace:depth", "", "", "", Ignored, "PRMan; Option \"trace\" \"maxdepth\" says it"},
    {"trace:maxdepth", "int", "32 under path, else 4", "8", Used,
     "Greatest number of bounces of a ray; 0: no rays are traced. --max-depth overrides it."},
    {"trace:specularthreshold", "", "", "", Ignored, "several renderers; lobes are taken as they are, however rough"},
    {"trace:worldoffset", "float[3]", "", "", Ignored, kOrigin},
    {"trace:worldorigin", "", "", "", Ignored, kOrigin},
    {"volume:aggregatespace", "", "", "", Ignored, "PRMan; the picture does not depend on how volumes are gathered"},
};

constexpr OptionDescription kHiderParameters[] = {
    {"aaSamples", "int", "1", "3", Used,
     "raytrace: anti-aliasing by colours. A ray goes through the middle of each pixel; pixels that differ from one at "
     "either side, above or below get this many by this many rays: 3, 5, 7 or 9; 1: off. A pixel is the mean of its own "
     "rays; PixelSamples and filters have no say."},
    {"aaThreshold", "float", "0.3", "0.1", Used,
     "raytrace, with aaSamples: sum of the differences of red, green and blue (each from 0 to 1) above which pixels differ."},
    {"adaptive", "int", "1", "0", Used,
     "path: 1: under --noise pixels get samples by the noise about them, without bias (docs/noise.md); 0: all the same number. "
     "Parts, and "
     "pictures with caustics, always have the latter."},
    {"aperture", "float[4]", "[0 0 0 0]", "[6 15 0.2 0]", Used,
     "The opening of the lens of DepthOfField: sides (0: a circle), degrees by which it is turned, roundness of the sides (0 to "
     "1), and "
     "whether light grows toward the rim (1) or the middle (-1)."},
    {"caustics", "int", "0", "1", Used,
     "path: 1: light that reaches surfaces by way of mirrors, glass and narrow highlights is brought by photons, new ones for "
     "each sample; their bias "
     "vanishes with the number of samples."},
    {"causticwidth", "float", "0.1", "0", Used,
     "path with caustics: photons also bring what comes by way of narrow highlights and rough glass, whose lobes spread by less "
     "than this "
     "half angle in radians (of trace()'s distributions about their roughness), 0 to 0.5. 0: mirrors and clear glass alone."},
    {"composite", "", "", "", Ignored, "3Delight; samples are always composited with what is behind them"},
    {"depthfilter", "string", "\"min\"", "\"midpoint\"", Used,
     "hidden and raytrace: the depth of a pixel: min, max, average or midpoint."},
    {"emit", "int", "200000", "1000000", Used,
     "photon: photons that are emitted. path with caustics: those of one sample of all pixels; one for four pixels, if it is not "
     "said."},
    {"extrememotiondof", "", "", "", Ignored, "PRMan; motion and depth of field are exact for each sample"},
    {"focalDist", "float", "that of DepthOfField", "5", Used,
     "raytrace: distance along the axis that a lens by lensDiameter has in focus."},
    {"guide", "int", "1", "0", Used,
     "path: 1: before the first sample, photons find where light reaches surfaces by way of mirrors and clear glass, "
     "and paths find which parts of flat lamps and skies are visible from where; rays and light samples follow that; "
     "shadow rays that bring little are traced at random only. Less noise or less time, and no bias. Points also search for "
     "light of point, spot and distant lights by mirrors and clear glass, which no ray finds. 0: none of these."},
    {"incremental", "", "", "", Ignored, "PRMan; --checkpoint, --spp and --noise say how a picture grows"},
    {"integrationmode", "", "", "", Ignored, "PRMan; the hider path is the way here"},
    {"jitter", "int", "1", "0", Used,
     "hidden and raytrace: 1: samples lie at random places of their cells; 0: in the middle of them; 2: all pixels have the same "
     "pattern."},
    {"lensDiameter", "float", "that of DepthOfField", "0.2", Used,
     "raytrace: diameter of the lens in camera units, as SLProject says it, with focalDist; 0: a pinhole. It takes the place of "
     "DepthOfField."},
    {"lensSamples", "int[2]", "", "[7 7]", Used,
     "raytrace: so many by so many rays (1 to 256) go through the middle of each pixel, from places spread evenly over the lens; "
     "1 by 1: a "
     "pinhole. A pixel is the mean of its own rays; PixelSamples, --spp and filters have no say."},
    {"maxsamples", "int", "", "64", Used,
     "raytrace, in a scene of RIS, which is drawn by path (docs/ris.md): samples per pixel, where PixelSamples says nothing."},
    {"midpointratio", "", "", "", Ignored, "3Delight; \"depthfilter\" \"midpoint\" is half way between two surfaces"},
    {"minsamples", "", "", "", Ignored, "PRMan; --noise gives each pixel the samples that it needs"},
    {"mpcache", "", "", "", Ignored, "PRMan; what is shaded is kept as long as a tile needs it"},
    {"samplemotion", "int", "0", "1", Used,
     "hidden: surfaces are shaded at the time of each sample, not when the shutter opens."},
    {"samplepattern", "", "", "", Ignored, "several renderers; all samples are stratified the same way"},
    {"shading", "string", "\"micropolygon\"", "\"sample\"", Used,
     "hidden and raytrace: \"micropolygon\": surfaces are shaded on micropolygons of ShadingRate, once for all samples that see "
     "them, as ShadingInterpolation says; \"sample\": each sample is shaded where it lies, which is the default of raytrace. "
     "Under raytrace a lens or an open shutter has samples shaded one by one."},
    {"sigma", "", "", "", Ignored, "PRMan; nothing is left out at random"},
    {"sigmablur", "", "", "", Ignored, "PRMan; nothing is left out at random"},
    {"subpixel", "", "", "", Ignored, "PRMan; depth is that of samples, by depthfilter"},
};

constexpr OptionDescription kDisplayParameters[] = {
    {"alphamode", "", "", "", Ignored, "PRMan; colours are premultiplied by alpha, always"},
    {"asrgba", "", "", "", Ignored, "PRMan; colours and alpha have the names R, G, B and A, always"},
    {"associatealpha", "", "", "", Ignored, "3Delight; colours are premultiplied by alpha, always"},
    {"autocrop", "", "", "", Ignored, "several renderers; the data window is that of CropWindow"},
    {"bias", "", "", "", Ignored, "3Delight; shadow() takes its own bias, or that of Option \"shadow\" \"bias\""},
    {"compression", "string", "\"zip\"", "\"lzw\"", Used, "TIFF: none, lzw, packbits, zip or deflate."},
    {"compressionlevel", "", "", "", Ignored, "several renderers; the compression has its usual level"},
    {"dither", "float", "0.5 for 8 bits", "0", Used, "Random amplitude that is added before rounding to whole codes."},
    {"exposure", "float[2]", "that of Exposure", "[1 2.2]", Used, "Gain and gamma of this display, for all of its colours."},
    {"exrcompression", "string", "\"zip\"", "\"piz\"", Used, "OpenEXR: none, rle, zips, zip or piz."},
    {"exrpixeltype", "string", "\"float\"", "\"half\"", Used, "OpenEXR: float or half."},
    {"filter", "string", "that of PixelFilter", "\"box\"", Used,
     "hidden and raytrace: the display's own reconstruction filter, or a depth filter (min, max, average, midpoint)."},
    {"filterwidth", "float[2]", "that of PixelFilter", "[1 1]", Used,
     "hidden and raytrace: full widths of the filter in pixels."},
    {"hostcomputer", "", "", "", Ignored, "PRMan; the metadata of pictures name no machine"},
    {"layer", "string", "\"identifier:name\"", "\"material\"", Used,
     "cryptomatte: what tells the objects apart: an attribute \"class:name\", or \"material\". Several: \"string[2] layer\"."},
    {"levels", "int", "6", "8", Used, "cryptomatte: how many objects can share a pixel, at most 64."},
    {"merge", "", "", "", Ignored, "Aqsis; each Display is a picture of its own"},
    {"mode", "", "", "", Ignored, "PRMan; the display's own argument says which channels it has"},
    {"quality", "", "", "", Ignored, "several renderers; no format here is lossy in that way"},
    {"quantize", "float[4]", "that of Quantize", "[0 255 0 255]", Used,
     "Codes of 0 and 1, least and greatest code; [0 0 0 0]: floating point, where the format has it."},
    {"resolution", "", "", "", Ignored, "PRMan; pictures have pixels, not inches"},
    {"resolutionunit", "", "", "", Ignored, "PRMan; pictures have pixels, not inches"},
    {"scanlineorder", "", "", "", Ignored, "Aqsis; formats have their usual order"},
    {"software", "", "", "", Ignored, "several renderers; the metadata of pictures name the program itself (docs/statistics.md)"},
    {"storage", "", "", "", Ignored, "PRMan; pictures are written in scan lines"},
    {"type", "", "", "", Ignored, "several renderers; quantize, or exrpixeltype, says it"},
};

constexpr HiderDescription kHiders[] = {
    {"hidden",
     "The picture as RISpec defines it: samples are stratified and shared by neighbouring pixels, displays have "
     "filters of their own, "
     "shaders see the lights that they ask for. Also without a Hider request, and by the names paint, stochastic, zbuffer, reyes "
     "and scanline, which other programs have."},
    {"path", "Path-traced global illumination: the same scene and the same shaders, diffuse() specular() and phong() gather the "
             "indirect light "
             "of their lobe, point and distant lights cast traced shadows, noise is measured. docs/light.md has the rules."},
    {"photon",
     "No picture: photons are emitted and the photon maps written that surfaces (Attribute \"photon\") and shaders name. "
     "docs/light.md has the rules."},
    {"raytrace", "The same as hidden, with the name that ray-traced scenes give, but that each sample is shaded where it lies."},
};

template <size_t N> constexpr bool sorted(const OptionDescription (&t)[N]) {
    for (size_t i = 1; i < N; ++i)
        if (!(t[i - 1].name < t[i].name)) return false;
    return true;
}
static_assert(sorted(kOptions) && sorted(kHiderParameters) && sorted(kDisplayParameters), "findKnown searches by halves");

} // namespace

std::span<const OptionDescription> knownOptions() { return kOptions; }
std::span<const OptionDescription> knownHiderParameters() { return kHiderParameters; }
std::span<const OptionDescription> knownDisplayParameters() { return kDisplayParameters; }
std::span<const HiderDescription> knownHiders() { return kHiders; }

const OptionDescription* findKnown(std::span<const OptionDescription> table, std::string_view name) {
    const auto i = std::lower_bound(table.begin(), table.end(), name,
                                    [](const OptionDescription& d, std::string_view n) { return d.name < n; });
    return i != table.end() && i->name == name ? &*i : nullptr;
}

PlainValue plainValue(std::string_view text) {
    PlainValue v;
    for (size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '"') {
            const size_t close = std::min(text.find('"', i + 1), text.size());
            v.texts.emplace_back(text.substr(i + 1, close - i - 1));
            i = close + 1;
        } else if (c == ' ' || c == '[' || c == ']') {
            ++i;
        } else {
            const size_t stop = std::min(text.find_first_of(" ]", i), text.size());
            v.numbers.push_back(std::strtof(std::string(text.substr(i, stop - i)).c_str(), nullptr));
            i = stop;
        }
    }
    return v;
}

std::vector<std::string> knownNames(std::span<const OptionDescription> table, std::string_view category) {
    std::vector<std::string> names;
    for (const OptionDescription& d : table) {
        const size_t colon = d.name.find(':');
        const std::string_view of = d.name.substr(0, colon);
        if (colon == d.name.npos || (!category.empty() && of != category)) continue;
        const std::string_view n = category.empty() ? of : d.name.substr(colon + 1);
        if (names.empty() || names.back() != n) names.emplace_back(n);
    }
    return names;
}

} // namespace alpenglow::known
