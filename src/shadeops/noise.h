// Noise and random: rsl.md 10.2 (seed 6.4.2). Code for all lane widths above, descriptors below (host only).
#pragma once
//CODE
#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::rsl {
namespace {
/// The forms of one family for the results float, color, point, vector, normal.
std::vector<Signature> noiseForms(const char* name, const char* symbol, bool period) {
    std::vector<Signature> list;
    for (const char* type : {"float", "color", "point", "vector", "normal"}) {
        const std::string head = std::string(type) + " " + name, tail = type == std::string("float") ? "_f" : "_t";
        const auto add = [&](const std::string& parameters, const char* form) {
            list.push_back(parseSignature(head + "(" + parameters + ")", std::string(symbol) + form + tail));
        };
        if (period) {
            add("float x, float period", "1");
            add("float x, float y, float xperiod, float yperiod", "2");
            add("point p, point period", "3");
            add("point p; float w; point period; float wperiod", "4");
        } else {
            add("float x", "1");
            add("float x, float y", "2");
            add("point p", "3");
            add("point p; float w", "4");
            add("color p", "3");
        }
    }
    return list;
}
} // namespace

std::vector<Shadeop> noiseShadeops() {
    std::vector<Shadeop> list;
    Shadeop op;
    op.section = "Noise";
    op.outOfLine = true;

    op.name = "noise";
    op.signatures = noiseForms("noise", "al_noise", false);
    op.doc = "Gradient noise of 1 to 4 dimensions in [0,1]: mean near 0.5, exactly 0.5 at integer points, continuous second derivatives, no "
             "period. The components of a color, point or vector result do not correlate. The result is in [0,1] for points and vectors too. "
             "Beyond 1e9 the argument counts as 1e9. Same bits for any number of lanes.";
    op.source = "seed; range and smoothness (k)";
    op.examples = {{"noise(3)", "0.5"}, {"noise(point(1,2,3))", "0.5"}, {"noise(2, 5)", "0.5"}};
    list.push_back(op);

    op.name = "pnoise";
    op.signatures = noiseForms("pnoise", "al_pnoise", true);
    op.doc = "As noise, repeating with the given period in each coordinate. Periods are rounded to integers, at least 1; 256 and any other "
             "integer up to 2^22. No derivative with respect to a period.";
    op.examples = {{"pnoise(3, 4)", "0.5"}};
    list.push_back(op);

    op.name = "cellnoise";
    op.signatures = noiseForms("cellnoise", "al_cellnoise", false);
    op.doc = "A random value in [0,1), constant in every unit cell of floor(argument). Derivative 0.";
    op.derivative = DerivativeRule::Zero;
    op.examples = {{"cellnoise(0.25) - cellnoise(0.75)", "0"}};
    list.push_back(op);

    op = Shadeop{};
    op.section = "Noise";
    op.name = "random";
    op.signatures = sigs({{"float random()"}, {"color random()"}, {"point random()"}, {"vector random()"}, {"normal random()"}});
    op.lowering = Lowering::Special;
    op.derivative = DerivativeRule::Zero;
    op.pure = false;
    op.doc = "Uniform in [0,1), components independent. Varying: hashes pixel, sample and call site. Assigned to a uniform variable: hashes "
             "primitive, call site and seed, so that a value does not depend on how points are batched. al_random_f and al_random_t turn a "
             "hash into the value.";
    op.source = "seed";
    list.push_back(op);
    return list;
}
} // namespace alpenglow::rsl
#endif
