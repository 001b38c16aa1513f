// Colours: rsl.md 10.3 (seed 6.4.3). Linear RGB triples; other spaces by explicit conversion.
#pragma once
//CODE
#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::rsl {
std::vector<Shadeop> colourShadeops() {
    std::vector<Shadeop> list;
    Shadeop op;
    op.section = "Colours";
    op.source = "seed";
    op.name = "comp";
    op.signatures = sigs({{"float comp(color c; float i)", "al_comp"}});
    op.doc = "Component of a colour (or of a matrix); the index is truncated and clamped to 0..2.";
    op.examples = {{"comp(color(1,2,3), 1)", "2"}};
    list.push_back(op);
    op.name = "setcomp";
    op.signatures = sigs({{"void setcomp(output color c; float i, float value)", "al_setcomp"}});
    op.doc = "Sets a component of a colour (or of a matrix); the index is truncated and clamped to 0..2.";
    op.examples = {};
    list.push_back(op);
    op.name = "luminance";
    op.signatures = sigs({{"float luminance(color c)", "al_luminance"}});
    op.doc = "0.2126 r + 0.7152 g + 0.0722 b (Rec. 709).";
    op.source = "seen in 3Delight shaders, weights (k)";
    op.examples = {{"luminance(color(1,1,1))", "1"}};
    list.push_back(op);
    op.name = "ctransform";
    op.signatures = sigs({{"color ctransform(string tospace; color c)"}, {"color ctransform(string fromspace, string tospace; color c)"}});
    op.lowering = Lowering::Special;
    op.derivative = DerivativeRule::Inherent;
    op.doc = "From one colour space (default rgb) to another: rgb hsv hsl yiq xyz, any case; an unknown space leaves c as it is. hue 0..1; YIQ by "
             "the NTSC coefficients; XYZ of Rec. 709 primaries with D65. Symbols al_rgb_to_hsv, al_hsv_to_rgb, al_rgb_to_hsl, al_hsl_to_rgb, "
             "al_rgb_to_yiq, al_yiq_to_rgb, al_rgb_to_xyz, al_xyz_to_rgb; the way between two spaces goes through rgb.";
    op.source = "seed; details (k)";
    op.examples = {{"ctransform(\"hsv\", color(1,0,0))", "0 1 1"}};
    list.push_back(op);
    return list;
}
} // namespace alpenglow::rsl
#endif
