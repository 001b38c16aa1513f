/* Blender's shader nodes as light that comes back: each function is the integral of its lobe. Roughness is Blender's, the
   square root of
   the width of slopes. n: the shading normal on the viewer's side. BL_LIGHTS: what makes trace() see lights (the add-on
   defines it). */
#ifndef BLENDER_CLOSURES_H
#define BLENDER_CLOSURES_H
#ifndef BL_LIGHTS
#define BL_LIGHTS "samplearealights", 1
#endif
#define BL_MIRROR .005 /* widths of slopes below: a single direction, as in Cycles, which photons and the caustic guide know */

/* 1 where the outside is seen. */
float blFront()
{
    extern normal N, Ng;
    extern vector I;
    return (((N . Ng < 0) ? -Ng : Ng) . I <= 0) ? 1 : 0;
}
/* The normal on the side that is seen, where a bump leads it away at the rim of what is seen. */
normal blSeen(normal n)
{
    extern vector I;
    vector V = -normalize(I);
    normal out = normalize(n);
    float seen = out . V;
    if (seen < .01) out = normalize(out + (.01 - seen) * V);
    return out;
}
/* Of each channel; below 0 as of 0. */
color blPow(color c; float e) { return color(pow(max(comp(c, 0), 0), e), pow(max(comp(c, 1), 0), e), pow(max(comp(c, 2), 0),
    e)); }
float blLuminance(color c) { return .2126 * comp(c, 0) + .7152 * comp(c, 1) + .0722 * comp(c, 2); }

/* Fresnel reflectance of a dielectric; eta: index behind the surface over that before it. */
float blDielectric(float c, eta)
{
    float g2 = eta * eta - 1 + c * c, g = sqrt(max(g2, 0)), k = max(c, 1e-4);
    float s = (g - k) / (g + k), p = (k * (g + k) - 1) / (k * (g - k) + 1);
    return (g2 <= 0) ? 1 : (eta == 1) ? 0 : min(1, .5 * s * s * (1 + p * p));
}
float blSchlick(float c) { float m = clamp(1 - c, 0, 1); return m * m * m * m * m; }

/* What facets of this width that reflect all give back in a white furnace (a fit to integrals of GGX, within .006). */
float blAlbedo(float c, a)
{
    float t = a / (a + c + 1e-6);
    float k0 = (((3.9237 * t - 7.0396) * t + 3.6064) * t - .3403) * t + .0061;
    float k1 = (((-4.9372 * t + 3.4866) * t + 1.4314) * t - 1.1064) * t + .1652;
    float k2 = (((-22.6004 * t + 61.5554) * t - 49.7714) * t + 12.6856) * t + .2727;
    float k3 = (((-23.2799 * t + 79.8951) * t - 106.6448) * t + 58.4119) * t - 10.5027;
    float k4 = (((44.9327 * t - 135.1520) * t + 150.2501) * t - 70.3952) * t + 11.1808;
    return (a < BL_MIRROR) ? 1 : clamp(1 - ((((k4 * a + k3) * a + k2) * a + k1) * a + k0), .2, 1);
}
/* The cosine at which a smooth surface has the mean Fresnel reflectance of these facets (a fit, within .007). */
float blCosine(float c, a)
{
    float t = a / (a + c + 1e-6);
    float k0 = ((.1826 * t - .1126) * t + .0496) * t + .001;
    float k1 = ((2.3175 * t - 5.8572) * t + 4.9185) * t - .4423;
    float k2 = ((1.5042 * t - 6.4730) * t + 8.5158) * t - 4.4716;
    float k3 = ((-3.3747 * t + 9.0918) * t - 8.3390) * t + 2.9769;
    return (a < BL_MIRROR) ? c : clamp(c + ((k3 * a + k2) * a + k1) * a + k0, 0, 1);
}
/* Widths of slopes along and across; anisotropy -1 to 1 (below 0: across). */
void blWidths(float roughness, anisotropy; output float along, across)
{
    float a = roughness * roughness, aspect = sqrt(1 - .9 * clamp(abs(anisotropy), 0, 1));
    along = a / aspect;
    across = a * aspect;
    if (anisotropy < 0) {
        along = a * aspect;
        across = a / aspect;
    }
}
vector blTurned(normal n; vector along; float turn)
{
    vector u = normalize(along - (along . n) * n), v = n ^ u;
    return (turn == 0) ? u : cos(2 * PI * turn) * u + sin(2 * PI * turn) * v;
}

color blDiffuse(normal n; float roughness)
{
    extern point P;
    extern vector I;
    color light = 0;
    if (roughness <= 0) light = diffuse(n);
    else light = trace(P, n, "distribution", "oren-nayar", "wo", -normalize(I), "roughness", roughness, "type", "diffuse",
        BL_LIGHTS);
    return light;
}
color blTranslucent(normal n) { return diffuse(-n); }

/* Facets that reflect all. kind: a distribution of trace(). */
color blFacetsOf(string kind; normal n; vector udir; float along, across)
{
    extern point P;
    extern vector I;
    vector V = -normalize(I);
    color light = 0;
    if (max(along, across) < BL_MIRROR) light = trace(P, 2 * (n . V) * n - V, BL_LIGHTS);
    else light = trace(P, n, "distribution", kind, "wo", V, "udir", udir, "roughness", along, "roughnessv", across, BL_LIGHTS);
    return light;
}
color blFacets(normal n; vector udir; float along, across) { return blFacetsOf("ggx", n, udir, along, across); }
/* The Fresnel reflectance of a dielectric's facets as a whole. As a weight it shows which lobe of a surface is worth a ray. */
float blMirrored(float c, a, eta) { return blDielectric(blCosine(c, a), eta); }
/* Glossy BSDF. whole 1: light that facets lose to each other is given back ("Multiscatter GGX"). */
color blGlossy(normal n; vector udir; float roughness, anisotropy, turn, whole; string kind)
{
    extern vector I;
    float along, across, all = 1;
    blWidths(roughness, anisotropy, along, across);
    if (whole == 1) all = blAlbedo(-(n . normalize(I)), sqrt(along * across));
    return blFacetsOf(kind, n, blTurned(n, udir, turn), along, across) / all;
}
/* Glass BSDF: what is mirrored and what comes through. front 1: from outside. */
void blGlass(normal n; float front, roughness, ior; output color mirrored, through)
{
    extern point P;
    extern vector I;
    vector V = -normalize(I);
    float a = roughness * roughness;
    if (a < BL_MIRROR) {
        float eta = (front == 1) ? ior : 1 / ior, kr = blDielectric(n . V, eta);
        mirrored = kr * trace(P, 2 * (n . V) * n - V, BL_LIGHTS);
        through = (1 - kr) * trace(P, (ior == 1) ? -V : refract(-V, n, 1 / eta), BL_LIGHTS);
    } else {
        color part[2] = trace(P, (front == 1) ? n : -n, "distribution", "glass-ggx", "wo", V, "roughness", a, "eta", ior,
            BL_LIGHTS);
        mirrored = part[0];
        through = part[1];
    }
}
/* Refraction BSDF: all light comes through; where none can, nothing. */
color blRefraction(normal n; float front, roughness, ior)
{
    extern vector I;
    vector V = -normalize(I);
    float eta = (front == 1) ? ior : 1 / ior, kr = blDielectric(n . V, eta);
    color mirrored, through, light = 0;
    blGlass(n, front, roughness, ior, mirrored, through);
    if (kr < 1) light = through / (1 - kr);
    return light;
}
/* Subsurface Scattering: radius in scene units. */
color blSubsurface(color reflectance, radius; float anisotropy)
{
    extern point P;
    return subsurface(P, "reflectance", clamp(reflectance, color 0, color .999), "diffusemeanfreepath", max(radius, color
        1e-6), "ior", 1,
                      "unitlength", 1, "anisotropy", anisotropy);
}
/* Velvet and sheen: light about the rim. */
color blVelvet(normal n; float roughness)
{
    extern vector I;
    float c = clamp(-(n . normalize(I)), 0, 1), s = clamp(roughness, .05, 1);
    return pow(1 - c, 1 / s) * diffuse(n);
}
/* Hair: Chiang et al. 2016 as far as trace()'s "hair" goes. */
color blHair(vector along; color absorption; float roughness, radial, tilt, ior)
{
    extern point P;
    extern vector I;
    return trace(P, along, "distribution", "hair", "wo", -normalize(I), "udir", along, "absorption", absorption, "eta", ior,
        BL_LIGHTS);
}

/* The diffuse part of Principled BSDF up to Blender 3.6 (Burley 2012), averaged over the directions of light. */
float blBurley(float c, roughness)
{
    float f = blSchlick(c);
    return .976 * (1 - .5 * f) + roughness * (f * (1 + .667 * c) + .0476 + .0119 * c);
}
/* Principled BSDF up to Blender 3.6. Layers are added, only metal and transmission take from the diffuse base. */
color blPrincipled3(normal n, nc; vector tangent; float front; color base; float subsurface; color radius, subcolor; float
    metallic, specular,
                    spectint, roughness, anisotropic, turn, sheen, sheentint, coat, coatroughness, ior, transmission,
                        transroughness)
{
    extern vector I;
    vector V = -normalize(I);
    float c = n . V, along, across, lum = blLuminance(base);
    color light = 0, tint = (lum > 0) ? base / lum : color 1;
    float body = (1 - metallic) * (1 - transmission);
    if (body > 0) {
        if (subsurface < 1) light += body * (1 - subsurface) * base * blBurley(c, roughness) * diffuse(n);
        if (subsurface > 0) light += body * subsurface * blSubsurface(subcolor, radius * subsurface, 0);
        if (sheen > 0) light += body * sheen * .0476 * mix(color 1, tint, color sheentint) * (1 + 8 * blSchlick(c)) *
            diffuse(n);
    }
    vector u = blTurned(n, tangent, turn);
    blWidths(roughness, anisotropic, along, across);
    if (transmission < 1 && (specular > 0 || metallic > 0)) {
        float f0 = .08 * max(specular, 1e-4), eta = 2 / (1 - sqrt(f0)) - 1;
        color facing = metallic * base + (1 - metallic) * f0 * mix(color 1, tint, color spectint);
        float rim = (blMirrored(c, sqrt(along * across), eta) - f0) / (1 - f0);
        light += (1 - transmission * (1 - metallic)) * (facing + (1 - facing) * rim) * blFacets(n, u, along, across);
    }
    if (transmission > 0 && metallic < 1) {
        color mirrored, through;
        blGlass(n, front, roughness, ior, mirrored, through);
        light += transmission * (1 - metallic) * (mix(color 1, tint, color spectint) * mirrored + base * through);
    }
    if (coat > 0) {
        /* GTR1 has long tails: it is GGX of widths spread evenly, by their logarithm, from a to 1 */
        float a = pow(max(coatroughness * coatroughness, .0001), random());
        light += .25 * coat * blMirrored(nc . V, a, 1.5) * blFacets(nc, u, a, a);
    }
    return light;
}
/* Principled BSDF from Blender 4.0 on: each layer lets through what it does not reflect. */
color blPrincipled4(normal n, nc; vector tangent; float front; color base; float subsurface; color radius; float metallic,
    level; color spectint;
                    float roughness, anisotropic, turn, sheen, sheenroughness; color sheentint; float coat, coatroughness,
                        coatior; color coattint;
                    float ior, transmission, diffuseroughness)
{
    extern vector I;
    vector V = -normalize(I);
    float c = n . V, along, across, a = roughness * roughness, whole = blAlbedo(c, a);
    color light = 0, over = 1, below = 1;
    vector u = blTurned(n, tangent, turn);
    blWidths(roughness, anisotropic, along, across);
    if (sheen > 0) {
        color cloth = sheen * sheentint * pow(1 - c, 1 / clamp(sheenroughness, .1, 1));
        light += cloth * diffuse(n);
        over *= 1 - cloth;
    }
    if (coat > 0) {
        float ca = coatroughness * coatroughness, reflected = coat * blDielectric(nc . V, coatior);
        light += over * coat * blMirrored(nc . V, ca, coatior) * blFacets(nc, u, ca, ca);
        over *= (1 - reflected) * mix(color 1, coattint, color coat);
    }
    if (metallic > 0) {
        light += over * metallic * (base + (spectint - base) * blSchlick(c)) * blFacets(n, u, along, across) / whole;
        below *= 1 - metallic;
    }
    if (transmission > 0) {
        color mirrored, through;
        blGlass(n, front, roughness, ior, mirrored, through);
        light += over * below * transmission * (spectint * mirrored + blPow(base, .5) * through);
        below *= 1 - transmission;
    }
    if (metallic < 1 && transmission < 1) {
        float f0 = (ior - 1) / (ior + 1), r = f0 * f0 * 2 * level, eta = ior;
        if (level != .5) {
            r = clamp(r, 0, .99);
            eta = (1 + sqrt(r)) / (1 - sqrt(r));
        }
        light += over * below * spectint * blMirrored(c, a, eta) * blFacets(n, u, along, across);
        below *= 1 - spectint * blDielectric(c, eta) * whole;
        if (subsurface < 1) light += over * below * (1 - subsurface) * base * blDiffuse(n, diffuseroughness);
        if (subsurface > 0) light += over * below * subsurface * blSubsurface(base, radius, 0);
    }
    return light;
}
#endif
