// Mathematics: rsl.md 10.1 (seed 6.4.1). Code for all lane widths above, descriptors below (host only).
#pragma once
//CODE
#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::rsl {
namespace {
Shadeop mathOp(const char* name, std::initializer_list<SignatureText> texts, const char* doc, const char* source,
               std::vector<Example> examples) {
    Shadeop op;
    op.name = name;
    op.signatures = sigs(texts);
    op.section = "Mathematics";
    op.doc = doc;
    op.source = source;
    op.examples = std::move(examples);
    return op;
}
Shadeop flatOp(Shadeop op) {
    op.derivative = DerivativeRule::Zero;
    return op;
}
} // namespace

std::vector<Shadeop> mathematicsShadeops() {
    std::vector<Shadeop> list;
    list.push_back(mathOp("radians", {{"float radians(float degrees)", "al_radians"}}, "Degrees to radians: degrees * PI / 180.", "seed",
                          {{"radians(180)", "3.141593"}}));
    list.push_back(mathOp("degrees", {{"float degrees(float radians)", "al_degrees"}}, "Radians to degrees: radians * 180 / PI.", "seed",
                          {{"degrees(1)", "57.29578"}}));
    list.push_back(mathOp("sin", {{"float sin(float radians)", "al_sin"}},
                          "Sine. Error below 2 ulp up to 1e5 radians; beyond 1e7 the argument has too few digits and the result is only bounded.",
                          "seed", {{"sin(0)", "0"}, {"sin(0.5)", "0.4794255"}}));
    list.push_back(mathOp("cos", {{"float cos(float radians)", "al_cos"}}, "Cosine. Error as for sin.", "seed",
                          {{"cos(0)", "1"}, {"cos(0.5)", "0.8775826"}}));
    list.push_back(mathOp("tan", {{"float tan(float radians)", "al_tan"}}, "Tangent. Where the cosine is exactly 0 the result is 0.", "seed",
                          {{"tan(0.5)", "0.5463025"}}));
    list.push_back(mathOp("asin", {{"float asin(float a)", "al_asin"}}, "Arc sine, -PI/2..PI/2. The argument is clamped to [-1,1]; there the derivative is 0.",
                          "seed; clamping (k)", {{"asin(0.5)", "0.5235988"}, {"asin(2)", "1.570796"}}));
    list.push_back(mathOp("acos", {{"float acos(float a)", "al_acos"}}, "Arc cosine, 0..PI. The argument is clamped to [-1,1]; there the derivative is 0.",
                          "seed; clamping (k)", {{"acos(0.5)", "1.047198"}, {"acos(-2)", "3.141593"}}));
    list.push_back(mathOp("atan", {{"float atan(float a)", "al_atan"}, {"float atan(float y, float x)", "al_atan2"}},
                          "Arc tangent of a, -PI/2..PI/2; or of y/x in the right quadrant, -PI..PI. atan(0, 0) is 0.", "seed",
                          {{"atan(1)", "0.7853982"}, {"atan(1, -1)", "2.356194"}}));
    list.push_back(mathOp("sqrt", {{"float sqrt(float x)", "al_sqrt"}}, "Square root; 0 for x < 0. The derivative at 0 is taken as 0.", "seed",
                          {{"sqrt(2)", "1.414214"}, {"sqrt(-1)", "0"}}));
    list.push_back(mathOp("inversesqrt", {{"float inversesqrt(float x)", "al_inversesqrt"}},
                          "1 / sqrt(x); for x <= 0 a very large float, 1e38.", "seed", {{"inversesqrt(4)", "0.5"}, {"inversesqrt(0)", "1e+38"}}));
    list.push_back(mathOp("pow", {{"float pow(float x, float y)", "al_pow"}},
                          "x to the power y. Negative x: exact sign for integer y, 0 for others. pow(x, 0) = 1; pow(0, y) = 0 for y > 0, infinity "
                          "for y < 0. Numbers too small for a normal float count as 0.",
                          "another copy of the manual (3D), negative x (k)", {{"pow(2, 10)", "1024"}, {"pow(-2, 3)", "-8"}, {"pow(-2, 0.5)", "0"}}));
    list.push_back(mathOp("exp", {{"float exp(float x)", "al_exp"}}, "e to the power x; infinity above 88.72, 0 below -87.3.", "(3D)",
                          {{"exp(1)", "2.718282"}, {"exp(0)", "1"}}));
    list.push_back(mathOp("log", {{"float log(float x)", "al_log"}, {"float log(float x, float base)", "al_logbase"}},
                          "Natural logarithm, or logarithm in a base. For x <= 0 -infinity; numbers too small for a normal float count as 0.", "seed",
                          {{"log(10)", "2.302585"}, {"log(8, 2)", "3"}}));
    list.push_back(flatOp(mathOp("sign", {{"float sign(float x)", "al_sign"}}, "-1 for x < 0, 1 otherwise: 0 counts as positive.", "(3D)",
                                 {{"sign(-3)", "-1"}, {"sign(0)", "1"}})));
    list.push_back(mathOp("mod", {{"float mod(float x, float y)", "al_mod"}},
                          "x - n y with n = floor(x / y): in [0, y] for positive y, in [y, 0] for negative y; mod(x, 0) is 0.", "seed",
                          {{"mod(-1, 3)", "2"}, {"mod(7, 3)", "1"}}));
    list.push_back(mathOp("abs", {{"float abs(float x)", "al_abs"}}, "Absolute value.", "(3D)", {{"abs(-2)", "2"}}));
    list.push_back(flatOp(mathOp("floor", {{"float floor(float x)", "al_floor"}}, "Largest integer not above x.", "(3D)", {{"floor(-1.5)", "-2"}})));
    list.push_back(flatOp(mathOp("ceil", {{"float ceil(float x)", "al_ceil"}}, "Smallest integer not below x.", "(3D)", {{"ceil(1.25)", "2"}})));
    list.push_back(flatOp(mathOp("round", {{"float round(float x)", "al_round"}}, "Nearest integer, halves away from zero.", "(3D), halves (k)",
                                 {{"round(2.5)", "3"}, {"round(-2.5)", "-3"}})));

    Shadeop op = mathOp("min", {}, "Smallest of two or more values of one type; tuples component by component.", "seed",
                        {{"min(1, 2)", "1"}, {"min(point(1,2,3), point(4,3,2))", "1 2 2"}});
    op.signatures = each(kFloatAndTuples, "$ min($ a, $ b, ...)", "al_min");
    list.push_back(op);
    op = mathOp("max", {}, "Largest of two or more values of one type; tuples component by component.", "seed",
                {{"max(1, 2)", "2"}, {"max(point(1,2,3), point(4,3,2))", "4 3 3"}});
    op.signatures = each(kFloatAndTuples, "$ max($ a, $ b, ...)", "al_max");
    list.push_back(op);
    op = mathOp("clamp", {}, "lo if x < lo, hi if x > hi, else x; tuples component by component.", "seed",
                {{"clamp(5, 0, 1)", "1"}, {"clamp(point(-1,0.5,3), point(0,0,0), point(1,1,1))", "0 0.5 1"}});
    op.signatures = each(kFloatAndTuples, "$ clamp($ x, $ lo, $ hi)", "al_clamp");
    list.push_back(op);
    op = flatOp(mathOp("step", {}, "0 if value < edge, else 1. Tuples component by component (seen in the wild).", "seed",
                       {{"step(1, 0.5)", "0"}, {"step(1, 1)", "1"}}));
    op.signatures = each(kFloatAndTuples, "$ step($ edge, $ value)", "al_step");
    list.push_back(op);
    op = mathOp("smoothstep", {}, "0 below lo, 1 at and above hi, 3t^2 - 2t^3 in between. Tuples component by component (seen in the wild).", "seed",
                {{"smoothstep(0, 1, 0.25)", "0.15625"}, {"smoothstep(0, 1, 2)", "1"}});
    op.signatures = each(kFloatAndTuples, "$ smoothstep($ lo, $ hi, $ value)", "al_smoothstep");
    list.push_back(op);
    op = mathOp("mix", {}, "x (1 - alpha) + y alpha, not clamped; alpha may be a tuple of the same type.", "seed; tuple alpha (k)",
                {{"mix(1, 3, 0.25)", "1.5"}, {"mix(color(0,0,0), color(1,2,4), 0.5)", "0.5 1 2"}});
    op.signatures = each("float", "$ mix($ x, $ y, float alpha)", "al_mix") + each(kTuples, "$ mix($ x, $ y, float alpha)", "al_mixf") +
                    each(kTuples, "$ mix($ x, $ y, $ alpha)", "al_mix");
    list.push_back(op);
    for (const char* filter : {"catmullrom", "box", "triangle", "gaussian"}) {
        const std::string name = std::string("__filterstep_") + filter;
        op = mathOp(name.c_str(), {}, "step(edge, value) filtered over value1..value2; filterstep() calls it.", "seed (filter names)", {});
        op.signatures = {parseSignature("float " + name + "(float edge, float value1, float value2)", std::string("al_filterstep_") + filter)};
        list.push_back(op);
    }
    return list;
}
} // namespace alpenglow::rsl
#endif
