// How long 300 average shaders take: about 100 lines each, put together from patterns as people write them, no two alike. Cold
// (code is generated for each) and from the cache, by another compiler that finds what the first left. CPU time of one thread.
#include "rsl/compiler.h"
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <random>
#include <string>
#include <unistd.h>
#include <vector>

namespace fs = std::filesystem;
using namespace alpenglow;

namespace {

// '$' is a number of the shader's own, '@' the number of the layer.
const char* const kPatterns[] = {
    R"(color layer@(point q; float filter; color first, second)
{
    /* bricks in rows, every other one shifted, with mortar between them */
    float row = floor(ycomp(q) * $);
    float across = xcomp(q) * $ + 0.5 * mod(row, 2);
    float bx = across - floor(across), by = ycomp(q) * $ - row;
    float mortar = smoothstep(0, $ + filter, bx) * smoothstep(0, $ + filter, 1 - bx);
    mortar *= smoothstep(0, $ + filter, by) * smoothstep(0, $ + filter, 1 - by);
    float tone = cellnoise(floor(across), row) * $;
    color brick = mix(first, second, tone) * (1 - 0.25 * noise(q * 20));
    return mix(color($, $, $), brick, mortar);
}
)",
    R"(color layer@(point q; float filter; color first, second)
{
    /* turbulence in octaves that fade out before they alias */
    float sum = 0, frequency = $, amplitude = 1, i;
    for (i = 0; i < 6; i += 1) {
        float weight = 1 - smoothstep(0.2, 0.6, filter * frequency);
        sum += weight * amplitude * abs(2 * noise(q * frequency) - 1);
        frequency *= 2.03;
        amplitude *= $;
    }
    float vein = pow(0.5 + 0.5 * sin(xcomp(q) * $ + sum * $), $);
    return mix(first, second, vein);
}
)",
    R"(color layer@(point q; float filter; color first, second)
{
    /* rings of wood about an axis that wanders */
    point p = q + $ * (vector noise(q * $) - vector(0.5, 0.5, 0.5));
    float r = sqrt(xcomp(p) * xcomp(p) + zcomp(p) * zcomp(p)) * $;
    r += $ * noise(ycomp(p) * 0.5, r);
    float ring = r - floor(r);
    float grain = smoothstep($, 0.8, ring) - smoothstep(0.83, 1, ring);
    float fine = noise(xcomp(p) * 80, zcomp(p) * 80);
    fine = 1 - 0.3 * fine * fine;
    return mix(first, second, grain) * fine;
}
)",
    R"(color layer@(point q; float filter; color first, second)
{
    /* the distances to the two nearest of jittered points */
    float f1 = 1000, f2 = 1000, i, j;
    point cell = point(floor(xcomp(q) * $) + 0.5, floor(ycomp(q) * $) + 0.5, 0);
    for (i = -1; i <= 1; i += 1) {
        for (j = -1; j <= 1; j += 1) {
            point test = cell + vector(i, j, 0);
            vector jitter = vector cellnoise(test) - vector(0.5, 0.5, 0.5);
            float d = distance(test + $ * jitter, point(xcomp(q) * $, ycomp(q) * $, 0));
            if (d < f1) {
                f2 = f1;
                f1 = d;
            } else if (d < f2) {
                f2 = d;
            }
        }
    }
    return mix(first, second, smoothstep(0, $ + filter, f2 - f1));
}
)",
    R"(color layer@(point q; float filter; color first, second)
{
    /* a row of colours read off a curve */
    float v = mod(xcomp(q) * $ + 0.3 * noise(q * $), 1);
    color c = spline(v, first, first, color($, $, $), second, color($, 0.5, $), second, first, first);
    float stripe = smoothstep(0.4 - filter, 0.4 + filter, abs(v - 0.5));
    if (stripe > $) {
        c *= 0.5 + 0.5 * noise(q * $);
    } else {
        c += color($, $, 0) * stripe;
    }
    return c;
}
)",
    R"(color layer@(point q; float filter; color first, second)
{
    /* round spots of chance sizes in a grid */
    float gx = xcomp(q) * $, gy = ycomp(q) * $;
    float cx = floor(gx), cy = floor(gy);
    float size = 0.2 + $ * cellnoise(cx, cy);
    float ox = cellnoise(cx + 17, cy) - 0.5, oy = cellnoise(cx, cy + 31) - 0.5;
    float dx = gx - cx - 0.5 - 0.3 * ox, dy = gy - cy - 0.5 - 0.3 * oy;
    float d = sqrt(dx * dx + dy * dy);
    float angle = atan(dy, dx);
    d *= 1 + $ * sin(angle * 5 + $);
    float inside = 1 - smoothstep(size - filter, size + filter, d);
    color spot = ctransform("hsv", "rgb", color(cellnoise(cx, cy), $, 0.9));
    return mix(first, mix(second, spot, 0.5), inside);
}
)",
    R"(color layer@(point q; float filter; color first, second)
{
    /* a ruled grid, lines of two widths */
    float u1 = abs(mod(xcomp(q) * $, 1) - 0.5), v1 = abs(mod(ycomp(q) * $, 1) - 0.5);
    float u2 = abs(mod(xcomp(q) * 4, 1) - 0.5), v2 = abs(mod(ycomp(q) * 4, 1) - 0.5);
    float thin = max(smoothstep(0.48 - filter, 0.48, u2), smoothstep(0.48 - filter, 0.48, v2));
    float thick = max(smoothstep($ - filter, $, u1), smoothstep($ - filter, $, v1));
    float paper = 0.9 + 0.1 * float noise(q * $);
    color c = mix(first * paper, second, 0.5 * thin);
    return mix(c, second * $, thick);
}
)",
    R"(color layer@(point q; float filter; color first, second)
{
    /* stains that run down and dry at their edges */
    float column = floor(xcomp(q) * $);
    float length0 = 0.3 + $ * cellnoise(column), start = cellnoise(column + 3);
    float y = ycomp(q) - start + 0.05 * noise(xcomp(q) * $, ycomp(q) * 2);
    float along = clamp(y / length0, 0, 1);
    float wide = 0.5 * (1 - along) * $;
    float off = abs(mod(xcomp(q) * $, 1) - 0.5);
    float body = 1 - smoothstep(wide, wide + 0.05 + filter, off);
    float edge = smoothstep(wide - 0.05, wide, off) * body;
    if (y < 0) body = 0;
    return mix(first, second * (1 - 0.5 * edge), body * exp(-along * $));
}
)"};

const char* const kEnds[] = {
    R"(    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color shine = 0;
    illuminance(P, Nf, PI / 2) {
        vector H = normalize(normalize(L) + V);
        shine += Cl * pow(max(0, Nf . H), 1 / roughness);
    }
    Oi = Os;
    Ci = Os * (base * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * shine);
)",
    R"(    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    float Kr, Kt;
    vector R, T;
    fresnel(normalize(I), Nf, 1 / 1.5, Kr, Kt, R, T);
    Oi = Os * mix(1, Kt, edge);
    Ci = Oi * (base * (Ka * ambient() + Kd * diffuse(Nf)) + Kr * specularcolor * Ks * specular(Nf, V, roughness));
)",
    R"(    point PP = transform("shader", P) + bump * height * normalize(vector(N));
    normal Nb = normalize(calculatenormal(transform("shader", "current", PP)));
    normal Nf = faceforward(Nb, I);
    Oi = Os;
    Ci = Os * (base * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, -normalize(I), roughness));
)"};

std::string shaderText(unsigned seed, std::string& name) {
    std::mt19937 random(seed);
    const auto pick = [&](size_t n) { return size_t(random() % unsigned(n)); };
    const auto filled = [&](const char* text, int layer) {
        std::string s;
        for (const char* p = text; *p; p++) {
            char number[32];
            if (*p == '$') std::snprintf(number, sizeof number, "%.4g", 0.05 + double(random() % 10000) / 12000), s += number;
            else if (*p == '@') s += std::to_string(layer);
            else s += *p;
        }
        return s;
    };
    name = "average" + std::to_string(seed);
    std::string s = "/* " + name + ": layers of patterns, lit */\n\n";
    const int layers = 4;
    for (int k = 0; k < layers; k++) s += filled(kPatterns[pick(std::size(kPatterns))], k) + "\n";
    s += "surface " + name +
         "(\n    float Ka = 1;\n    float Kd = 0.7;\n    float Ks = 0.4;\n    float roughness = 0.1;\n"
         "    color specularcolor = 1;\n    float scale = 2;\n    float bump = 0.02;\n    float edge = 0.3;\n";
    for (int k = 0; k < layers; k++)
        s += filled("    color first@ = color($, $, $);\n    color second@ = color($, $, $);\n    float amount@ = $;\n", k);
    s += "    string space = \"shader\";\n)\n{\n    point q = scale * transform(space, P);\n"
         "    float filter = max(sqrt(area(q)), 0.0001);\n    color base = Cs;\n    float height = 0;\n";
    for (int k = 0; k < layers; k++) {
        const std::string n = std::to_string(k);
        s += "    if (amount" + n + " > 0) {\n        color c" + n + " = layer" + n + "(q * " + std::to_string(k + 1) +
             ", filter, first" + n + ", second" + n + ");\n        base = mix(base, c" + n + ", amount" + n +
             ");\n        height += amount" + n + " * comp(c" + n + ", 1);\n    }\n";
    }
    return s + kEnds[pick(std::size(kEnds))] + "}\n";
}

double cpuSeconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

} // namespace

int main(int argc, char** argv) {
    const int count = argc > 1 ? std::atoi(argv[1]) : 300;
    const fs::path work = fs::temp_directory_path() / ("alpenglow_compile_speed_" + std::to_string(getpid()));
    fs::create_directories(work / "cache");
    std::vector<std::string> names;
    long lines = 0;
    for (int k = 0; k < count; k++) {
        std::string name;
        const std::string text = shaderText(unsigned(k + 1), name);
        for (char c : text) lines += c == '\n';
        std::FILE* f = std::fopen((work / (name + ".sl")).c_str(), "w");
        if (!f || std::fwrite(text.data(), 1, text.size(), f) != text.size()) return 1;
        std::fclose(f);
        names.push_back(name);
    }
    std::printf("%d shaders, %.0f lines each\n", count, double(lines) / count);
    int missed = 0;
    for (const auto& [what, limit] : {std::pair{"cold", 60.0}, {"from the cache", 3.0}}) {
        rsl::ShaderCompiler::Settings settings;
        settings.cacheDirectory = (work / "cache").string();
        rsl::ShaderCompiler compiler(settings);
        Diagnostics d;
        const double begin = cpuSeconds();
        double front = 0;
        for (const std::string& name : names) {
            const double t = cpuSeconds();
            const auto shader = compiler.load(name, {work.string()}, d);
            front += cpuSeconds() - t;
            if (!shader || !compiler.kernel(shader, {}, d)) {
                std::printf("%s does not compile: %s\n", name.c_str(), d.all().empty() ? "" : toString(d.all().back()).c_str());
                fs::remove_all(work);
                return 1;
            }
        }
        const double seconds = (cpuSeconds() - begin) * 300 / count;
        std::printf("300 %-16s %7.2f s CPU (reading and checking %.2f), limit %g   %s\n", what, seconds, front * 300 / count,
                    limit, seconds < limit ? "PASS" : "MISS");
        missed += seconds >= limit;
    }
    fs::remove_all(work);
    return missed;
}
