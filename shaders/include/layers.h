/* Layers of a principled surface: what facets of Trowbridge and Reitz reflect in all, by fits to integrals of it, and the calls of
   trace() that find the light. standard.sl and ris/ are made of these. Roughness a: the width of slopes, which trace() takes; a
   "roughness" that users turn is squared first. c: cosine between normal and viewer, 0 to 1. */
#ifndef LAYERS_H
#define LAYERS_H
#define LAYER_SMOOTH 0.005 /* below: a mirror, a single direction, which photons and the caustic guide know */

/* What facets that reflect all give back in a white furnace; the rest would need a second facet. Within .006. */
float layerAlbedo(float c; float a)
{
    float t = a / (a + c + 1e-6);
    float k0 = (((3.9237 * t - 7.0396) * t + 3.6064) * t - .3403) * t + .0061;
    float k1 = (((-4.9372 * t + 3.4866) * t + 1.4314) * t - 1.1064) * t + .1652;
    float k2 = (((-22.6004 * t + 61.5554) * t - 49.7714) * t + 12.6856) * t + .2727;
    float k3 = (((-23.2799 * t + 79.8951) * t - 106.6448) * t + 58.4119) * t - 10.5027;
    float k4 = (((44.9327 * t - 135.1520) * t + 150.2501) * t - 70.3952) * t + 11.1808;
    return (a < LAYER_SMOOTH) ? 1 : clamp(1 - ((((k4 * a + k3) * a + k2) * a + k1) * a + k0), .2, 1);
}
/* The cosine at which a smooth surface has the mean Fresnel reflectance of these facets. Within .007. */
float layerCosine(float c; float a)
{
    float t = a / (a + c + 1e-6);
    float k0 = ((.1826 * t - .1126) * t + .0496) * t + .001;
    float k1 = ((2.3175 * t - 5.8572) * t + 4.9185) * t - .4423;
    float k2 = ((1.5042 * t - 6.4730) * t + 8.5158) * t - 4.4716;
    float k3 = ((-3.3747 * t + 9.0918) * t - 8.3390) * t + 2.9769;
    return (a < LAYER_SMOOTH) ? c : clamp(c + ((k3 * a + k2) * a + k1) * a + k0, 0, 1);
}
/* The same of the sheen of cloth (Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", 2017), of roughness r. Within
   .03. */
float layerSheen(float c; float r)
{
    float k0 = ((-1.2819 * r + 2.6657) * r - 1.8852) * r + 1.2720;
    float k1 = ((8.1419 * r - 16.6752) * r + 11.2321) * r - 3.5614;
    float k2 = ((-10.5769 * r + 22.5571) * r - 15.6790) * r + 5.2127;
    float k3 = ((6.3505 * r - 15.3930) * r + 12.1818) * r - 4.8735;
    float k4 = ((-1.9190 * r + 5.2302) * r - 4.5010) * r + 1.8882;
    float k = (((k4 * c + k3) * c + k2) * c + k1) * c + k0;
    return min(1, k * k);
}

color layerRoot(color x) { return color(sqrt(comp(x, 0)), sqrt(comp(x, 1)), sqrt(comp(x, 2))); }
color layerPower(color x; float e) { return color(pow(comp(x, 0), e), pow(comp(x, 1), e), pow(comp(x, 2), e)); }

/* Fresnel reflectance. eta: index behind the surface over that before it. 1 beyond the critical angle. */
float layerDielectric(float c; float eta)
{
    float g2 = eta * eta - 1 + c * c, g = sqrt(max(g2, 0));
    float s = (g - c) / (g + c), p = (c * (g + c) - 1) / (c * (g - c) + 1);
    return (g2 <= 0) ? 1 : (eta == 1) ? 0 : min(1, .5 * s * s * (1 + p * p));
}
/* Of a metal: index n and extinction k, a channel each. */
color layerConductor(float c; color n, k)
{
    float c2 = c * c;
    color t0 = n * n - k * k - (1 - c2), r = layerRoot(t0 * t0 + 4 * n * n * k * k);
    color a = layerRoot(max((r + t0) * .5, color 0)), twice = 2 * c * a;
    color s = (r + c2 - twice) / (r + c2 + twice), p = s * (c2 * r + (1 - c2) * (1 - c2) - twice * (1 - c2)) /
        (c2 * r + (1 - c2) * (1 - c2) + twice * (1 - c2));
    return .5 * (s + p);
}
/* Index and extinction of a metal that reflects r seen straight on, and tends to `edge` at the rim (Gulbrandsen, "Artist Friendly
   Metallic Fresnel", 2014). */
void layerMetal(color reflected, edge; output color n, k)
{
    color r = clamp(reflected, color 0, color .999), root = layerRoot(r);
    n = mix((1 + root) / (1 - root), (1 - r) / (1 + r), clamp(edge, color 0, color 1));
    k = layerRoot(max(((n + 1) * (n + 1) * r - (n - 1) * (n - 1)) / (1 - r), color 0));
}
/* From `facing` straight on to `edge` at the rim: Schlick's curve, with an exponent of 5. */
color layerSchlick(float c; color facing, edge; float exponent) { return facing + (edge - facing) * pow(1 - c, exponent); }

/* The side of the surface that is looked at. out: the normal there, turned to the viewer where a bump or an interpolated normal
   leads away from him. True (1): from outside, where N points. */
float layerSide(normal shading; output normal out)
{
    extern normal N, Ng;
    extern vector I;
    vector V = -normalize(I);
    normal outside = (N . Ng < 0) ? -Ng : Ng;
    float front = (outside . I <= 0) ? 1 : 0;
    out = normalize(shading);
    if (front == 0) out = -out;
    float seen = out . V;
    if (seen < .01) out = normalize(out + (.01 - seen) * V);
    return front;
}
/* Widths of slopes along and across for an anisotropy of 0 to 1 (Burley, "Physically Based Shading at Disney", 2012). */
void layerWidths(float a, anisotropy; output float along, across)
{
    float aspect = sqrt(1 - .9 * clamp(anisotropy, 0, 1));
    along = min(1, a / aspect);
    across = a * aspect;
}
/* A tangent turned about the normal by a part of a whole turn. */
vector layerTangent(normal n; vector along; float turn)
{
    vector u = normalize(along - (along . n) * n), v = n ^ u;
    return (turn == 0) ? u : cos(2 * PI * turn) * u + sin(2 * PI * turn) * v;
}
/* The direction in which s grows. */
vector layerDpds()
{
    extern float s, t;
    extern vector dPdu, dPdv;
    float su = Du(s), sv = Dv(s), tu = Du(t), tv = Dv(t), det = su * tv - sv * tu;
    return (det == 0) ? dPdu : sign(det) * (dPdu * tv - dPdv * tu);
}
/* How many rays a call asks for: only outside of path, and not behind other rays. */
float layerSamples(float samples)
{
    float depth = 0, n = samples;
    if (rayinfo("depth", depth) == 1 && depth > 0) n = 1;
    return max(1, n);
}

/* Light that a surface of refraction index eta reflects, Fresnel's loss included. */
color layerReflect(normal n; vector V, udir; float along, across, eta, samples)
{
    extern point P;
    color light = 0;
    if (max(along, across) < LAYER_SMOOTH)
        light = layerDielectric(n . V, eta) * trace(P, 2 * (n . V) * n - V, "samplelights", 1);
    else
        light = trace(P, n, "distribution", "ggx", "wo", V, "udir", udir, "roughness", along, "roughnessv", across, "eta", eta,
                      "samples", samples, "samplelights", 1);
    return light;
}
/* The same of a metal; light that facets lose to each other is given back (Turquin, "Practical multiple scattering compensation
   for microfacet models", 2019). */
color layerReflectMetal(normal n; vector V, udir; float along, across; color eta, k; float samples)
{
    extern point P;
    color light = 0;
    if (max(along, across) < LAYER_SMOOTH)
        light = layerConductor(n . V, eta, k) * trace(P, 2 * (n . V) * n - V, "samplelights", 1);
    else {
        color index[2] = {eta, k};
        float all = layerAlbedo(n . V, sqrt(along * across));
        light = (1 + layerConductor(1, eta, k) * ((1 - all) / all)) *
            trace(P, n, "distribution", "ggx", "wo", V, "udir", udir, "roughness", along, "roughnessv", across, "eta", index,
                  "samples", samples, "samplelights", 1);
    }
    return light;
}
/* The same where the reflectance is `weight` on the whole: of facets that reflect all, and of what they lose to each other. */
color layerReflectAs(color weight; normal n; vector V, udir; float along, across, samples)
{
    extern point P;
    color light = 0;
    if (max(along, across) < LAYER_SMOOTH)
        light = weight * trace(P, 2 * (n . V) * n - V, "samplelights", 1);
    else
        light = weight / layerAlbedo(n . V, sqrt(along * across)) *
            trace(P, n, "distribution", "ggx", "wo", V, "udir", udir, "roughness", along, "roughnessv", across, "samples", samples,
                  "samplelights", 1);
    return light;
}
/* A solid of glass: light that it mirrors, times `mirror`, and light that comes through, times `through`. n on the viewer's side,
   from outside where front is 1. Facets that reflect and refract are one lobe, which takes of each what it does. */
color layerGlass(normal n; float front; vector V, udir; float along, across, eta, samples; color mirror, through)
{
    extern point P;
    color light = 0, none = 0;
    if (max(along, across) < LAYER_SMOOTH) {
        float relative = (front == 1) ? eta : 1 / eta, kr = layerDielectric(n . V, relative);
        light = kr * mirror * trace(P, 2 * (n . V) * n - V, "samplelights", 1) +
            (1 - kr) * through * trace(P, (eta == 1) ? -V : refract(-V, n, 1 / relative), "samplelights", 1);
    } else {
        normal outside = (front == 1) ? n : -n;
        light = through * trace(P, outside, "distribution", "glass-ggx", "wo", V, "udir", udir, "roughness", along, "roughnessv",
                                across, "eta", eta, "samples", samples, "samplelights", 1);
        if (mirror != through)
            light += (mirror - through) * trace(P, outside, "distribution", "glass-ggx", "lobeparameters", {1, 0}, "wo", V, "udir",
                                                udir, "roughness", along, "roughnessv", across, "eta", eta, "samples", samples,
                                                "samplelights", 1);
    }
    return light;
}
/* A thin sheet of it: nothing is bent, and both faces reflect. Light through a rough one is spread as its reflection is. */
color layerSheet(normal n; vector V, udir; float along, across, eta, samples; color mirror, through)
{
    extern point P;
    float a = sqrt(along * across), one = layerDielectric(layerCosine(n . V, a), eta), both = 2 * one / (1 + one);
    color light = layerReflectAs(mirror * both, n, V, udir, along, across, samples), passed = (1 - both) * through;
    if (max(along, across) < LAYER_SMOOTH)
        light += passed * trace(P, -V, "samplelights", 1);
    else
        light += passed / layerAlbedo(n . V, a) *
            trace(P, -n, "distribution", "ggx", "wo", V - 2 * (n . V) * n, "udir", udir, "roughness", along, "roughnessv", across,
                  "samples", samples, "samplelights", 1);
    return light;
}
/* Diffuse light, of a surface that is rough by `slope` (standard deviation, radians; Oren and Nayar). */
color layerDiffuse(normal n; vector V; float slope, samples)
{
    extern point P;
    color light = 0;
    if (slope <= 0)
        light = diffuse(n);
    else
        light = trace(P, n, "distribution", "oren-nayar", "wo", V, "roughness", slope, "type", "diffuse", "samples", samples,
                      "samplelights", 1);
    return light;
}
#endif
