// The names of Attribute "category" "name".
#include "scene/knownoptions.h"
#include "scene/knownwords.h"

namespace alpenglow::scene {
namespace {

constexpr std::string_view kRadiosity = "BMRT's radiosity; the hider path is the way here",
                           kCache = "irradiance caches of several renderers; nothing is cached here";

constexpr OptionDescription kAttributes[] = {
    {"autoshadows:res", "", "", "", Ignored, kAqsis},
    {"autoshadows:shadowmapname", "", "", "", Ignored, kAqsis},
    {"caustic:maxpixeldist", "", "", "", Ignored, kBmrt},
    {"caustic:ngather", "", "", "", Ignored, kBmrt},
    {"caustic:refractionindex", "", "", "", Ignored, kBmrt},
    {"caustic:specularcolor", "", "", "", Ignored, kBmrt},
    {"cull:backfacing", "int", "1", "0", Asked,
     "Backs are never culled, as 0 asks for; Sides 1 leaves them out of what is seen."},
    {"cull:hidden", "int", "", "0", Used,
     "hidden: whether a Procedural whose bound lies outside of the picture is neither read nor run. Unset: where Attribute "
     "\"visibility\" lets the "
     "camera alone see it. Not with a lens, displacement, movement, solids and area lights. Nothing else that is hidden is left "
     "out."},
    {"curve:opacitysamples", "", "", "", Ignored, kPrman},
    {"derivatives:centered", "int", "1", "0", Asked, "shade:derivatives chooses how derivatives are taken here."},
    {"derivatives:extrapolate", "", "", "", Ignored, kPrman},
    {"derivatives:smooth", "int", "1", "0", Asked, "shade:derivatives chooses how derivatives are taken here."},
    {"dice:binary", "int", "", "", Ignored,
     "several renderers; edges of diced shapes are always cut into halves, so that shapes with the same edge meet"},
    {"dice:hair", "int", "0", "1", Asked, "Curves are not diced."},
    {"dice:maxlength", "", "", "", Ignored, kPrman},
    {"dice:minlength", "float", "", "", Ignored, kSeveral},
    {"dice:rasterorient", "int", "1", "0", Used,
     "Displaced shapes are diced as the eye sees their edges, which count by at least a quarter of their length; 0: by their "
     "length, as if they faced the eye. Where rays may come from elsewhere (path, ray-traced shadows, mirrors) lengths always "
     "count."},
    {"dice:referencecamera", "string", "", "", Ignored, kSeveral},
    {"dice:roundcurve", "int", "0", "1", Used, "Curves without \"N\" are tubes instead of ribbons that face the ray (PRMan)."},
    {"dice:strategy", "string", "", "", Ignored, kSeveral},
    {"displacementbound:coordinatesystem", "string", "\"object\"", "\"shader\"", Used,
     "The space of displacementbound:sphere, by any name; unknown ones are camera space. The distance is measured in it, "
     "stretched as it is."},
    {"displacementbound:offscreen", "", "", "", Ignored, kPrman},
    {"displacementbound:sphere", "float", "0", "0.1", Used,
     "The farthest that displacement moves a point. More than that is drawn as well, with a warning that names the distance."},
    {"geometry:backfacing", "int", "", "", Ignored, "only attribute() reads it: 1 where the back of the surface is seen"},
    {"geometry:boundingbox", "float[6]", "", "", Ignored,
     "only attribute() reads it: xmin xmax ymin ymax zmin zmax of the primitive in object space, of its points and before "
     "displacement, for textures that are to fit it. Quadrics count as if they turned about whole."},
    {"geometry:frontfacing", "int", "", "", Ignored, "only attribute() reads it: 1 where the front of the surface is seen"},
    {"geometry:geometricnormal", "int", "", "", Ignored, "only attribute() reads it: the normal of the geometry"},
    {"grouping:membership", "string", "\"\"", "\"+leaves\"", Used,
     "The groups that primitives belong to, for the subset of traced rays. + adds one, - removes one, else the list is "
     "replaced."},
    {"grouping:tracesubset", "string", "\"\"", "\"leaves\"", Used,
     "Rays that leave these primitives see only that group, if the call names none."},
    {"hider:composite", "int", "1", "0", Asked, "Primitives are always composited with what is behind them."},
    {"identifier:id", "", "", "", Ignored, kPrman},
    {"identifier:name", "string", "\"\"", "\"ball\"", Asked, "The name of what follows."},
    {"identifier:object", "", "", "", Ignored, kPrman},
    {"identifier:shadinggroup", "string", "", "", Ignored, kSeveral},
    {"indirect:maxerror", "", "", "", Ignored, kRadiosity},
    {"indirect:maxpixeldist", "", "", "", Ignored, kRadiosity},
    {"indirect:minsamples", "", "", "", Ignored, kRadiosity},
    {"indirect:nsamples", "", "", "", Ignored, kRadiosity},
    {"irradiance:filemode", "string", "", "", Ignored, kCache},
    {"irradiance:handle", "string", "", "", Ignored, kCache},
    {"irradiance:maxerror", "float", "", "", Ignored, kCache},
    {"irradiance:maxpixeldist", "float", "", "", Ignored, kCache},
    {"irradiance:nsamples", "int", "64", "256", Asked, "Shaders ask it for a number of samples."},
    {"irradiance:shadingrate", "float", "1", "4", Asked, "Irradiance is found at every shaded point."},
    {"light:emitphotons", "int", "0", "1", Used,
     "1: the light emits photons; 0: it does not. Where no light says 1, all do for Hider \"photon\" and for the caustics of "
     "path, "
     "and no photon map is made that has no file."},
    {"light:group", "string", "\"\"", "\"key\"", Used,
     "The label of a light in light path expressions, beside its handle (docs/lightpaths.md)."},
    {"light:nsamples", "", "1", "16", Used, "BMRT's name of light:samples."},
    {"light:samples", "int", "1", "16", Used, "Samples of an area light in an illuminance loop, 1 to 1024."},
    {"light:samplingstrategy", "string", "none", "\"trace\"", Used,
     "Where an area light or a sky is seen: \"illuminance\" in light loops alone, \"trace\" in trace() alone. Unset: in both, so "
     "that "
     "a loop and a trace() with \"samplearealights\" over the same lobe count it twice. diffuse() and its like see all. "
     "attribute() "
     "gives \"illuminance\" when it is not set."},
    {"light:shadows", "", "\"off\"", "\"on\"", Used,
     "BMRT: \"on\": the light casts traced shadows under hidden and raytrace, too."},
    {"light:units", "string", "\"radiance\" under path, else by the shader", "\"samples\"", Used,
     "What an area light's Cl is: \"radiance\", or \"samples\": its geometry gives the mean of Cl over samples, as BMRT and "
     "3Delight had it."},
    {"photon:causticmap", "string", "\"\"", "\"caustics\"", Used,
     "The photon map of light that comes to the surface by way of mirrors and glass: what caustic() looks up."},
    {"photon:estimator", "int", "50", "100", Used,
     "Photons of one lookup by caustic() or by rays of indirectdiffuse(), 1 to 4096."},
    {"photon:globalmap", "string", "\"\"", "\"global\"", Used,
     "The photon map of all light on the surface: what rays of indirectdiffuse() that meet it take instead of running its "
     "shader."},
    {"photon:shadingmodel", "string", "the shader's lobes", "\"glass\"", Used,
     "How the surface scatters photons: matte, plastic, glass, dielectric, water, chrome, conductor or transparent. Not for the "
     "caustics of path."},
    {"polygon:concave", "", "", "", Ignored, kPrman},
    {"polygon:smoothdisplacement", "", "", "", Ignored, kPrman},
    {"polygon:smoothnormals", "", "", "", Ignored, kPrman},
    {"procedural:attribute", "", "", "", Ignored, kPrman},
    {"procedural:reentrant", "", "", "", Ignored, kPrman},
    {"radiosity:averagecolor", "", "", "", Ignored, kRadiosity},
    {"radiosity:averageemission", "", "", "", Ignored, kRadiosity},
    {"radiosity:elemsize", "", "", "", Ignored, kRadiosity},
    {"radiosity:minsize", "", "", "", Ignored, kRadiosity},
    {"radiosity:patchsize", "", "", "", Ignored, kRadiosity},
    {"radiosity:specularcolor", "", "", "", Ignored, kRadiosity},
    {"radiosity:zonal", "", "", "", Ignored, kRadiosity},
    {"render:casts_shadows", "", "\"shader\"", "\"none\"", Used,
     "BMRT: what stops shadow rays: \"none\", \"opaque\", \"Os\" (its constant opacity) or \"shade\" (its shader's)."},
    {"render:displacementbound", "", "", "", Ignored, kBmrt},
    {"render:truedisplacement", "", "", "", Ignored, "BMRT; displacement is always true here"},
    {"render:visibility", "", "7", "3", Used,
     "BMRT: a sum: 1 seen by the camera, 2 by reflected and refracted rays, 4 by shadow rays."},
    {"shade:backfacing", "", "", "", Ignored, kPrman},
    {"shade:camerahitmode", "string", "", "", Ignored, kPrman},
    {"shade:derivatives", "string", "surface shaders under path: \"exact\", else \"differences\"", "\"exact\"", Used,
     "How shaders take derivatives: \"exact\", or \"differences\" over the footprint of the pixel, as grids had them."},
    {"shade:diffusehitmode", "string", "\"shader\"", "\"primitive\"", Used,
     "What diffuse rays meet: the shader's result, or \"primitive\": Cs and Os."},
    {"shade:frequency", "", "", "", Ignored, kPrman},
    {"shade:relativeshadingrate", "", "", "", Ignored, kPrman},
    {"shade:resolution", "", "", "", Ignored, kSeveral},
    {"shade:specularhitmode", "string", "\"shader\"", "\"primitive\"", Used,
     "What specular rays meet: the shader's result, or \"primitive\": Cs and Os."},
    {"shade:strategy", "string", "", "", Ignored, kSeveral},
    {"shade:transmissionhitmode", "string", "\"shader\"", "\"primitive\"", Used,
     "What stops shadow rays: the shader's Oi, \"primitive\": the constant Os, \"opaque\": everything."},
    {"shade:volumeintersectionpriority", "", "", "", Ignored, kPrman},
    {"shade:volumeintersectionstrategy", "", "", "", Ignored, kPrman},
    {"shadow:bias", "float", "that of the option", "0.05", Used, "shadow(): the option of this name, for points of a primitive."},
    {"shadow:bias0", "float", "bias", "0.05", Used,
     "shadow(): comparisons with a depth map spread their bias from bias0 to bias1."},
    {"shadow:bias1", "float", "bias", "0.1", Used, "See bias0."},
    {"sides:backfacetolerance", "", "", "", Ignored, kPrman},
    {"sides:doubleshaded", "int", "0", "1", Asked, "Each side is shaded where a ray meets it."},
    {"stitch:enable", "int", "1", "0", Used,
     "Displaced shapes with the same edge meet there: its points go to the middle of where the shapes take them. 0: each goes "
     "its own way."},
    {"stitch:newgroup", "", "", "", Ignored, kPrman},
    {"stitch:traceenable", "", "", "", Ignored, kPrman},
    {"stochastic:pointfalloff", "", "", "", Ignored, kPrman},
    {"stochastic:sigma", "", "", "", Ignored, kPrman},
    {"subsurface:absorption", "color", "", "[0.0021 0.0041 0.0071]", Used, "Of subsurface(): coefficient of absorption, 1/mm."},
    {"subsurface:groupname", "string", "\"\"", "\"skin\"", Used,
     "Of subsurface(): primitives of one group bound one inside. Without it those that have the same attributes."},
    {"subsurface:meanfreepath", "color", "1", "[1.2 0.8 0.5]", Used,
     "Of subsurface(), with reflectance: the mean way between two events, mm."},
    {"subsurface:reflectance", "color", "", "[0.8 0.6 0.5]", Used,
     "Of subsurface(): what a half space gives back of diffuse light; with meanfreepath, in place of the coefficients."},
    {"subsurface:refractionindex", "float", "1.3", "1.5", Used,
     "Of subsurface(): index of refraction, 1/3 to 3, in 32nds; 1: nothing is reflected inside."},
    {"subsurface:samples", "int", "1 under path, else 16", "64", Used, "Of subsurface(): walks of a call."},
    {"subsurface:scale", "float", "1", "0.1", Used, "Of subsurface(): millimetres in a unit of current space."},
    {"subsurface:scattering", "color", "", "[2.19 2.62 3]", Used, "Of subsurface(): coefficient of scattering, 1/mm."},
    {"subsurface:shadingrate", "float", "1", "4", Asked, "Shaders ask it."},
    {"trace:autobias", "", "", "", Ignored, "PRMan; the error bound of each hit is the offset here"},
    {"trace:bias", "float", "the error bound of each hit", "0.01", Used,
     "How far from the surface rays begin. Best left alone. attribute() gives -1 when it is not set."},
    {"trace:decimationrate", "", "", "", Ignored, kPrman},
    {"trace:displacements", "int", "0", "1", Asked, "Rays always meet displaced surfaces."},
    {"trace:importancethreshold", "", "", "", Ignored, kPrman},
    {"trace:maxdiffusedepth", "int", "32 under path, else 1", "2", Used,
     "Diffuse bounces after which these surfaces send no more diffuse rays."},
    {"trace:maxspeculardepth", "int", "32 under path, else 2", "5", Used,
     "Specular bounces after which these surfaces send no more specular rays."},
    {"trace:samplemotion", "int", "0", "1", Asked,
     "hidden: on any surface, shading and rays are those of the time of the sample, not of when the shutter opens."},
    {"trace:samplepattern", "", "", "", Ignored, kPrman},
    {"trimcurve:sense", "string", "\"inside\"", "\"outside\"", Used, "Which side of a TrimCurve is cut away."},
    {"visibility:camera", "int", "1", "0", Used, "Seen by the camera."},
    {"visibility:diffuse", "int", "as visibility:trace", "1", Used, "Seen by diffuse rays."},
    {"visibility:indirect", "", "", "", Ignored, kPrman},
    {"visibility:midpoint", "", "", "", Ignored, kPrman},
    {"visibility:photon", "", "as diffuse or specular", "1", Used,
     "Whether photons meet the primitive. Not for the caustics of path."},
    {"visibility:specular", "int", "as visibility:trace", "1", Used, "Seen by specular rays."},
    {"visibility:subset", "string", "", "", Ignored, kSeveral},
    {"visibility:trace", "int", "1 under path and where a scene says no visibility at all, else 0", "1", Used,
     "Seen by diffuse and specular rays that no attribute of their own decides on."},
    {"visibility:transmission", "", "1 under path and where a scene says 1 of nothing, else 0", "0", Used,
     "Stops shadow rays. The old words: \"transparent\" is 0; \"opaque\", \"Os\" and \"shader\" are 1 and say what stops them, "
     "as shade:transmissionhitmode does."},
    {"volume:depthinterpolation", "", "", "", Ignored, kPrman},
    {"volume:depthrelativeshadingrate", "", "", "", Ignored, kPrman},
};

constexpr bool sorted() {
    for (size_t i = 1; i < std::size(kAttributes); ++i)
        if (!(kAttributes[i - 1].name < kAttributes[i].name)) return false;
    return true;
}
static_assert(sorted(), "findKnown searches by halves");

} // namespace

std::span<const OptionDescription> knownAttributes() { return kAttributes; }

} // namespace alpenglow::scene
