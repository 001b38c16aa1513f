#include "programs.h"

namespace alpenglow::rsl {

namespace {

// Ways to write a value, by sort.

constexpr Choice kNumbers[] = {{6, "($F + $F)"},
                               {6, "($F - $F)"},
                               {9, "($F * $F)"},
                               {4, "($F / $F)"},
                               {3, "(-$F)"},
                               {5, "(($B) ? $F : $F)"},
                               {2, "min($F, $F)"},
                               {2, "max($F, $F)"},
                               {1, "min($F, $F, $F)"},
                               {2, "mod($F, $F)"},
                               {1, "step($F, $F)"},
                               {1, "pow($F, $F)"},
                               {1, "atan($F, $F)"},
                               {1, "log($F, $F)"},
                               {2, "clamp($F, $F, $F)"},
                               {2, "mix($F, $F, $F)"},
                               {2, "smoothstep($F, $F, $F)"},
                               {1, "abs($F)"},
                               {1, "floor($F)"},
                               {1, "ceil($F)"},
                               {1, "round($F)"},
                               {1, "sign($F)"},
                               {1, "sqrt($F)"},
                               {1, "inversesqrt($F)"},
                               {1, "sin($F)"},
                               {1, "cos($F)"},
                               {1, "tan($F)"},
                               {1, "asin($F)"},
                               {1, "acos($F)"},
                               {1, "atan($F)"},
                               {1, "exp($F)"},
                               {1, "log($F)"},
                               {1, "radians($F)"},
                               {1, "degrees($F)"},
                               {1, "float noise($F)"},
                               {1, "float noise($F, $F)"},
                               {2, "float noise($P)"},
                               {1, "float cellnoise($P)"},
                               {1, "float pnoise($F, 4)"},
                               {2, "xcomp($P)"},
                               {1, "ycomp($V)"},
                               {1, "zcomp($N)"},
                               {2, "comp($C, $F)"},
                               {1, "comp($M, $F, $F)"},
                               {1, "c[$I]"},
                               {1, "p[2]"},
                               {2, "length($V)"},
                               {1, "distance($P, $P)"},
                               {1, "ptlined($P, $P, $P)"},
                               {2, "($V . $V)"},
                               {1, "($N . $V)"},
                               {1, "determinant($M)"},
                               {2, "a[$I]"},
                               {2, "a[1]"},
                               {1, "comp(b[$I], 1)"},
                               {1, "luminance($C)"},
                               {1, "match(\"b+\", $S)"},
                               {1, "spline($F, $F, $F, $F, $F)"},
                               {1, "spline(\"bezier\", $F, $F, $F, 1, $F)"},
                               {1, "spline(\"bspline\", $F, a)"},
                               {1, "float($B)"},
                               {1, "(x = $F)"},
                               {1, "(z += $F)"},
                               {1, "arraylength(h)"},
                               {1, "h[$I]"},
                               {2, "one->f"},
                               {1, "one->add($F)"},
                               {1, "two->g[$I]"},
                               {1, "two->add($F)"},
                               {1, "two->plain($F)"},
                               {1, "three[$I]->f"},
                               {1, "three[1]->add($F)"},
                               {1, "comp(two->c, $F)"},
                               {1, "weighed(two, $F)"},
                               {1, "arraylength(four)"}};

constexpr Choice kIndices[] = {{2, "(y * $F)"}, {2, "clamp($F, 0, 3)"}, {1, "floor($F + x)"}};

constexpr Choice kUniforms[] = {{2, "($U + $U)"},   {2, "($U * $U)"}, {1, "($U - k)"},
                                {1, "min($U, $U)"}, {1, "sin($U)"},   {1, "($U < $U ? $U : $U)"}};

constexpr Choice kColours[] = {{4, "($C + $C)"},
                               {4, "($C * $C)"},
                               {2, "($C - $C)"},
                               {2, "($C * $F)"},
                               {1, "($F * $C)"},
                               {1, "($C / $F)"},
                               {1, "(-$C)"},
                               {4, "color($F, $F, $F)"},
                               {1, "color \"hsv\" ($F, $F, $F)"},
                               {2, "(($B) ? $C : $C)"},
                               {1, "min($C, $C)"},
                               {1, "max($C, $C)"},
                               {1, "clamp($C, $C, $C)"},
                               {2, "mix($C, $C, $F)"},
                               {1, "mix($C, $C, $C)"},
                               {1, "ctransform(\"hsl\", $C)"},
                               {1, "ctransform(\"xyz\", \"yiq\", $C)"},
                               {1, "color noise($P)"},
                               {1, "color cellnoise($F)"},
                               {1, "spline($F, $C, $C, $C, $C)"},
                               {1, "color($P)"},
                               {1, "color($F)"},
                               {2, "b[$I]"},
                               {1, "step($C, $C)"},
                               {1, "one->c"},
                               {1, "two->mixed($C, $F)"},
                               {1, "three[$I]->c"}};

constexpr Choice kPoints[] = {{4, "($P + $V)"},
                              {2, "($P - $V)"},
                              {2, "($P * $F)"},
                              {3, "point($F, $F, $F)"},
                              {1, "point($V)"},
                              {1, "point($C)"},
                              {1, "rotate($P, $F, $P, $P)"},
                              {1, "transform($M, $P)"},
                              {1, "mix($P, $P, $F)"},
                              {1, "max($P, $P)"},
                              {1, "point noise($P)"},
                              {2, "(($B) ? $P : $P)"},
                              {1, "point \"current\" ($F, $F, $F)"},
                              {1, "($P + $P)"}};

constexpr Choice kVectors[] = {{3, "($V + $V)"},
                               {2, "($V - $V)"},
                               {2, "($P - $P)"},
                               {2, "($V * $F)"},
                               {3, "($V ^ $V)"},
                               {2, "normalize($V)"},
                               {1, "vector($N)"},
                               {1, "vector($F, $F, $F)"},
                               {1, "reflect($V, $N)"},
                               {1, "refract($V, $N, $F)"},
                               {1, "faceforward($V, $V, $V)"},
                               {1, "vtransform($M, $V)"},
                               {2, "(($B) ? $V : $V)"},
                               {1, "mix($V, $V, $F)"},
                               {1, "(-$V)"},
                               {1, "vector noise($P)"},
                               {1, "($V / $F)"}};

constexpr Choice kNormals[] = {{2, "normal($V)"},
                               {1, "normalize($N)"},
                               {2, "(-$N)"},
                               {1, "normal($F, $F, $F)"},
                               {2, "($N * $F)"},
                               {2, "($N + $N)"},
                               {1, "faceforward($N, $V, $V)"},
                               {1, "(($B) ? $N : $N)"},
                               {1, "ntransform($M, $N)"}};

constexpr Choice kMatrices[] = {
    {3, "($M * $M)"},     {1, "matrix($F)"},         {2, "translate($M, $P)"},
    {2, "scale($M, $P)"}, {1, "rotate($M, $F, $V)"}, {1, "inverse($M)"},
    {1, "($M / $M)"},     {1, "(($B) ? $M : $M)"},   {1, "matrix($F, 0, 1, 0, 0, $F, 0, 2, $F, 0, 1, 0, 0.5, 0, 0, $F)"}};

constexpr Choice kTexts[] = {{2, "$T"}, {2, "concat($T, $T)"}, {1, "(($B) ? $S : $S)"}, {1, "concat($T, \"b\", $T)"}};

constexpr Choice kShortTexts[] = {{1, "format(\"%d\", mod($F, 10) + 1)"},
                                  {1, "format(\"a%.2f\", mod($F, 4) + 1)"},
                                  {1, "(($B) ? $T : $T)"},
                                  {1, "format(\"%s-%s\", $T, \"b\")"}};

constexpr Choice kTruths[] = {{4, "$F < $F"},      {2, "$F >= $F"}, {2, "$F > $F"},  {1, "$F <= $F"},
                              {1, "$F == $F"},     {1, "$F != $F"}, {1, "$C == $C"}, {1, "$P != $P"},
                              {1, "$C < $C"},      {1, "$S == $S"}, {1, "$S != $S"}, {2, "($B) && ($B)"},
                              {2, "($B) || ($B)"}, {2, "!($B)"},    {1, "$F"},       {1, "$C && ($B)"}};

template <size_t N> std::vector<Choice> listed(const Choice (&choices)[N]) { return {choices, choices + N}; }

} // namespace

const std::map<char, std::vector<Choice>>& grammar() {
    static const std::map<char, std::vector<Choice>> all = {
        {'F', listed(kNumbers)}, {'I', listed(kIndices)},    {'U', listed(kUniforms)}, {'C', listed(kColours)},
        {'P', listed(kPoints)},  {'V', listed(kVectors)},    {'N', listed(kNormals)},  {'M', listed(kMatrices)},
        {'S', listed(kTexts)},   {'T', listed(kShortTexts)}, {'B', listed(kTruths)},
    };
    return all;
}

const std::map<char, std::vector<const char*>>& constants() {
    static const std::map<char, std::vector<const char*>> all = {
        {'F', {"0.5", "2", "(-1.25)", "0", "3", "0.1", "1"}},
        {'I', {"0", "1"}},
        {'U', {"0.5", "2", "1"}},
        {'C', {"color(1, 0.5, 0.25)", "color(0)"}},
        {'P', {"point(0.5, 1, 2)", "point(0)"}},
        {'V', {"vector(0, 0.5, 1)", "vector(1)"}},
        {'N', {"normal(0, 0, 1)"}},
        {'M', {"matrix(1)", "matrix(1, 2, 0, 0, 0, 1, 0, 0.5, 3, 0, 1, 0, 0, 1, 0, 1)"}},
        {'S', {"\"\"", "\"a\"", "\"bb\""}},
        {'T', {"\"\"", "\"a\"", "\"ab\"", "\"bb\""}},
        {'B', {"u < 0.5", "1 > 0"}},
    };
    return all;
}

} // namespace alpenglow::rsl
