/* standard: a principled surface: metal, plastic, glass, skin, cloth and lacquer by one set of parameters, those of Autodesk's
   Standard Surface, which MaterialX has as standard_surface. Layers from the outside in: coat, sheen, specular reflection of
   facets (GGX), transmission, subsurface, diffuse; each lets through what it does not reflect, so a white one reflects all light.
     base, base_color, diffuse_roughness; base_color is multiplied by Color, opacity by Opacity
     metalness: the base is a metal of base_color, at the rim specular_color
     specular, specular_color, specular_roughness, specular_IOR, specular_anisotropy (0 to 1), specular_rotation (turns)
     transmission, transmission_color, transmission_depth: light comes through; with a depth it has the colour after that way
       inside, without at each surface. transmission_extra_roughness adds to specular_roughness
     subsurface, subsurface_color, subsurface_radius (of red, green, blue), subsurface_scale (of radii, in current space),
       subsurface_anisotropy: light walks below the surface
     sheen, sheen_color, sheen_roughness; coat, coat_color, coat_roughness, coat_anisotropy, coat_rotation, coat_IOR, coat_normal,
       coat_affect_color, coat_affect_roughness; emission, emission_color
     thin_walled 1: a sheet; bump_normal: in place of N (0: none); samples: rays of a lobe outside of Hider "path"
     *_map: pictures that multiply, each at (s, t) scaled, turned by map_rotation degrees and moved, again and again with map_repeat 1; *_channel: of the picture, -1:
       all; normal_map: slopes along s and t about N, strength normal_scale; alpha_cutoff above 0: opacity is 0 or 1
   Point, spot and distant lights, area lights and skies are seen once, by each lobe. A mirror (roughness below .07) sees no points.
   Not here: thin film, dispersion, scattering inside of what transmits (Interior "medium").
   Ball: Surface "standard" "color base_color" [.8 .3 .1] "float coat" 1 */
#include "layers.h"
#include "layermaps.h"
surface standard(varying float base = 1; varying color base_color = .8; varying float diffuse_roughness = 0, metalness = 0;
                 varying float specular = 1; varying color specular_color = 1;
                 varying float specular_roughness = .2, specular_IOR = 1.5, specular_anisotropy = 0, specular_rotation = 0;
                 varying float transmission = 0; varying color transmission_color = 1;
                 varying float transmission_depth = 0, transmission_extra_roughness = 0;
                 varying float subsurface = 0; varying color subsurface_color = 1, subsurface_radius = 1;
                 varying float subsurface_scale = 1, subsurface_anisotropy = 0;
                 varying float sheen = 0; varying color sheen_color = 1; varying float sheen_roughness = .3;
                 varying float coat = 0; varying color coat_color = 1;
                 varying float coat_roughness = .1, coat_anisotropy = 0, coat_rotation = 0, coat_IOR = 1.5;
                 varying normal coat_normal = 0; varying float coat_affect_color = 0, coat_affect_roughness = 0;
                 varying float emission = 0; varying color emission_color = 1, opacity = 1;
                 float thin_walled = 0; varying normal bump_normal = 0;
                 string base_color_map = "", specular_roughness_map = "", metalness_map = "", specular_map = "",
                     specular_color_map = "", transmission_map = "", sheen_color_map = "", sheen_roughness_map = "",
                     coat_map = "", coat_roughness_map = "", emission_map = "", opacity_map = "", normal_map = "";
                 float specular_roughness_channel = 1, metalness_channel = 2, specular_channel = 3, transmission_channel = 0,
                     sheen_roughness_channel = 3, coat_channel = 0, coat_roughness_channel = 1, opacity_channel = 3;
                 float map_scale[2] = {1, 1}, map_offset[2] = {0, 0}, map_rotation = 0, map_repeat = 1, normal_scale = 1, alpha_cutoff = 0,
                     samples = 16;)
{
    color zero = 0, none = 1;
    float ss, tt;
    layerPlace(map_scale[0], map_scale[1], map_offset[0], map_offset[1], map_rotation, map_repeat, ss, tt);
    vector V = -normalize(I), along = layerDpds();
    normal Nb = (bump_normal == normal 0) ? normalize(N) : bump_normal, n, nc;
    if (normal_map != "") Nb = layerNormalMap(normal_map, ss, tt, normal_scale, normalize(N), along);
    float front = layerSide(Nb, n), c = n . V, rays = layerSamples(samples);

    color albedo = base * base_color * Cs * layerMap(base_color_map, ss, tt);
    float metal = clamp(metalness * layerChannel(metalness_map, metalness_channel, ss, tt), 0, 1);
    float rough = clamp(specular_roughness * layerChannel(specular_roughness_map, specular_roughness_channel, ss, tt), 0, 1);
    color shine = specular * specular_color * layerMap(specular_color_map, ss, tt) *
        layerChannel(specular_map, specular_channel, ss, tt);
    float glass = transmission * layerChannel(transmission_map, transmission_channel, ss, tt);
    float lacquer = clamp(coat * layerChannel(coat_map, coat_channel, ss, tt), 0, 1);
    color opaque = opacity * Os * layerChannel(opacity_map, opacity_channel, ss, tt);
    if (alpha_cutoff > 0) opaque = (comp(opaque, 1) < alpha_cutoff) ? zero : none;
    if (lacquer > 0) {
        albedo = layerPower(max(albedo, zero), 1 + lacquer * coat_affect_color);
        rough = mix(rough, 1, lacquer * coat_affect_roughness * coat_roughness * (1 - rough));
    }
    color light = 0;
    float ax, ay;
    layerWidths(rough * rough, specular_anisotropy, ax, ay);
    vector udir = layerTangent(n, along, specular_rotation);
    if (metal > 0) {
        color index, extinction;
        layerMetal(albedo, shine, index, extinction);
        light += metal * layerReflectMetal(n, V, udir, ax, ay, index, extinction, rays);
    }
    if (metal < 1) {
        float body = 1 - metal, a = sqrt(ax * ay);
        color below = body;
        if (glass > 0) {
            color tint = none;
            float tr = min(1, rough + transmission_extra_roughness), tx, ty;
            layerWidths(tr * tr, specular_anisotropy, tx, ty);
            if (transmission_depth <= 0 || thin_walled == 1) tint = transmission_color;
            if (thin_walled == 1) light += glass * body * layerSheet(n, V, udir, tx, ty, specular_IOR, rays, shine, tint);
            else light += glass * body * layerGlass(n, front, V, udir, tx, ty, specular_IOR, rays, shine, tint);
            below *= 1 - glass;
        }
        if (glass < 1) {
            light += shine * below * layerReflect(n, V, udir, ax, ay, specular_IOR, rays);
            below *= 1 - shine * layerAlbedo(c, a) * layerDielectric(layerCosine(c, a), specular_IOR);
            color spread = albedo * (1 - subsurface);
            if (sheen > 0 || sheen_color_map != "") {
                color cloth = sheen * sheen_color * layerMap(sheen_color_map, ss, tt) *
                    layerSheen(c, clamp(sheen_roughness * layerChannel(sheen_roughness_map, sheen_roughness_channel, ss, tt), .1, 1));
                light += below * cloth * layerDiffuse(n, V, 0, rays);
                below *= 1 - cloth;
            }
            light += below * spread * (layerDiffuse(n, V, diffuse_roughness, rays) + ambient());
            if (subsurface > 0) {
                if (thin_walled == 1) /* half of it leaves on the other side */
                    light += below * subsurface * subsurface_color * .5 * (diffuse(n) + diffuse(-n));
                else
                    light += below * subsurface * subsurface(P, "reflectance", clamp(subsurface_color, zero, color .999),
                        "meanfreepath", max(subsurface_radius * subsurface_scale, color 1e-6), "ior", 1, "scale", 1,
                        "anisotropy", subsurface_anisotropy);
            }
        }
    }
    light += emission * emission_color * layerMap(emission_map, ss, tt);
    if (lacquer > 0) {
        layerSide((coat_normal == normal 0) ? normalize(N) : coat_normal, nc);
        float cr = clamp(coat_roughness * layerChannel(coat_roughness_map, coat_roughness_channel, ss, tt), 0, 1), cx, cy;
        layerWidths(cr * cr, coat_anisotropy, cx, cy);
        float cc = nc . V, ca = sqrt(cx * cy);
        light *= mix(none, coat_color, lacquer) *
            (1 - lacquer * layerAlbedo(cc, ca) * layerDielectric(layerCosine(cc, ca), coat_IOR));
        light += lacquer * layerReflect(nc, V, layerTangent(nc, along, coat_rotation), cx, cy, coat_IOR, rays);
    }
    if (glass > 0 && transmission_depth > 0 && front == 0 && thin_walled != 1) /* what the way inside has taken */
        light *= layerPower(clamp(transmission_color, color 1e-4, none), glass * length(I) / transmission_depth);
    Oi = opaque;
    Ci = opaque * light;
}
