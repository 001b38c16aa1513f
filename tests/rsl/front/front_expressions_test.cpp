// Expressions: precedence (RISpec 3.2, 13.1), conversions (docs/design/rsl.md), overloads. The expected trees follow from these.
#include "front_helpers.h"

namespace alpenglow::rsl::front_expressions_test {
namespace {

struct Case {
    const char* body;
    const char* tree;
};

const Case kPrecedence[] = {
    {"f = f + g * h;", "(= f (add:float f (mul:float g h)))"},
    {"f = f * g + h;", "(= f (add:float (mul:float f g) h))"},
    {"f = f - g - h;", "(= f (sub:float (sub:float f g) h))"},
    {"f = f / g / h;", "(= f (div:float (div:float f g) h))"},
    {"f = f * v1 . w;", "(= f (mul:float f (dot:float v1 w)))"},
    {"v1 = v1 ^ w * 2;", "(= v1 (cross:vector v1 (mul:vector w (cast:vector 2))))"},
    {"v1 = v1 + w ^ v1;", "(= v1 (add:vector v1 (cross:vector w v1)))"},
    {"f = -f * g;", "(= f (mul:float (negate:float f) g))"},
    {"f = -v1 . w;", "(= f (dot:float (negate:vector v1) w))"},
    {"f = f ? g : h;", "(= f (?:float (notequal:bool f 0) g h))"},
    {"f = f < g ? 1 : h > 2 ? 3 : 4;", "(= f (?:float (less:bool f g) 1 (?:float (greater:bool h 2) 3 4)))"},
    {"f = g = h;", "(= f (= g h))"},
    {"f += g *= 2;", "(+= f (*= g 2))"},
    {"if (f < 1 || g < 2 && h < 3) f = 1;", "(if (or:bool (less:bool f 1) (and:bool (less:bool g 2) (less:bool h 3))) (= f 1))"},
    {"if (f + 1 < g * 2) f = 1;", "(if (less:bool (add:float f 1) (mul:float g 2)) (= f 1))"},
    {"if (!(f == g)) f = 1;", "(if (not:bool (equal:bool f g)) (= f 1))"},
    {"f = (f + g) * h;", "(= f (mul:float (add:float f g) h))"},
    {"f = - - f;", "(= f (negate:float (negate:float f)))"},
    {"f = 2 * -3;", "(= f (mul:float 2 -3))"},
    {"f = a[1] * 2;", "(= f (mul:float (index a 1) 2))"},
    {"f = a[f + 1];", "(= f (index a (add:float f 1)))"},
    {"f = c[0] + ca[1][2];", "(= f (add:float (index c 0) (index (index ca 1) 2)))"},
    {"f = +g;", "(= f g)"},
};

const Case kConversions[] = {
    {"c = 1;", "(= c (cast:color 1))"},
    {"c = f;", "(= c (cast:color f))"},
    {"m = 1;", "(= m (cast:matrix 1))"},
    {"p = v1;", "(= p (cast:point v1))"},
    {"n = p;", "(= n (cast:normal p))"},
    {"c = c * f;", "(= c (mul:color c (cast:color f)))"},
    {"c = f * c;", "(= c (mul:color (cast:color f) c))"},
    {"c *= 2;", "(*= c (cast:color 2))"},
    {"c /= d;", "(/= c d)"},
    {"v1 = p - q;", "(= v1 (sub:vector p q))"},
    {"p = p - q;", "(= p (cast:point (sub:vector p q)))"},
    {"p = p + v1;", "(= p (add:point p (cast:point v1)))"},
    {"p = v1 * p;", "(= p (mul:point (cast:point v1) p))"},
    {"v1 = n + v1;", "(= v1 (add:vector (cast:vector n) v1))"},
    {"n = n * 2;", "(= n (mul:normal n (cast:normal 2)))"},
    {"p += v1;", "(+= p (cast:point v1))"},
    {"p -= 1;", "(-= p (cast:point 1))"},
    {"f = n . p;", "(= f (dot:float (cast:vector n) (cast:vector p)))"},
    {"f = c . d;", "(= f (dot:float c d))"},
    {"m = m * mm;", "(= m (mul:matrix m mm))"},
    {"m = m / 2;", "(= m (div:matrix m (cast:matrix 2)))"},
    {"if (c == d) f = 1;", "(if (equal:bool c d) (= f 1))"},
    {"if (c == 0) f = 1;", "(if (equal:bool c (cast:color 0)) (= f 1))"},
    {"if (p > q) f = 1;", "(if (greater:bool p q) (= f 1))"},
    {"if (str == \"a\") f = 1;", "(if (equal:bool str \"a\") (= f 1))"},
    {"if (f) f = 1;", "(if (notequal:bool f 0) (= f 1))"},
    {"if (f && g > 1) f = 1;", "(if (and:bool (notequal:bool f 0) (greater:bool g 1)) (= f 1))"},
    {"f = f > g;", "(= f (cast:float (greater:bool f g)))"},
    {"f = (f > g) * 2;", "(= f (mul:float (cast:float (greater:bool f g)) 2))"},
    {"c = f > 0 ? c : 0;", "(= c (?:color (greater:bool f 0) c (cast:color 0)))"},
    {"f = PI;", "(= f 3.14159265)"},
    {"f = f * 1.5e1;", "(= f (mul:float f 15))"},
    {"f = .5;", "(= f 0.5)"},
    {"f = 3.;", "(= f 3)"},
};

const Case kCasts[] = {
    {"c = color (1, 2, 3);", "(= c (color 1 2 3))"},
    {"c = (1, 2, 3);", "(= c (color 1 2 3))"},
    {"p = (1, 2, 3);", "(= p (point 1 2 3))"},
    {"p = point (f, g, h) * 2;", "(= p (mul:point (point f g h) (cast:point 2)))"},
    {"c = color \"hsv\" (f, 1, 1);", "(= c (color \"hsv\" f 1 1))"},
    {"p = point \"shader\" (0, 0, 0);", "(= p (point \"shader\" 0 0 0))"},
    {"p = point str (0, 0, 1);", "(= p (point str 0 0 1))"},
    {"v1 = vector \"world\" (0, 0, 1);", "(= v1 (vector \"world\" 0 0 1))"},
    {"p = point \"object\" p;", "(= p (cast:point \"object\" p))"},
    {"c = color 1;", "(= c (cast:color 1))"},
    {"c = color -1;", "(= c (cast:color -1))"},
    {"v1 = vector -v1;", "(= v1 (negate:vector v1))"},
    {"c = color (p);", "(= c (cast:color p))"},
    {"f = float noise(p);", "(= f (noise:float p))"},
    {"c = color noise(p);", "(= c (noise:color p))"},
    {"v1 = vector noise(p);", "(= v1 (noise:vector p))"},
    {"f = float noise(p) * 2;", "(= f (mul:float (noise:float p) 2))"},
    {"m = matrix (1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1);", "(= m (matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1))"},
    {"m = matrix \"world\" 1;", "(= m (cast:matrix \"world\" 1))"},
    {"str = \"a\" \"b\" \"\\n\";", "(= str \"ab\\n\")"},
};

const Case kOverloads[] = {
    {"f = noise(p);", "(= f (noise:float p))"},
    {"c = noise(p);", "(= c (noise:color p))"},
    {"p = noise(p);", "(= p (noise:point p))"},
    {"c = noise(f);", "(= c (noise:color f))"},
    {"f = noise(f, g);", "(= f (noise:float f g))"},
    {"f = 2 * noise(p) - 1;", "(= f (sub:float (mul:float 2 (noise:float p)) 1))"},
    {"f = sqrt(noise(p));", "(= f (sqrt:float (noise:float p)))"},
    {"f = length(p - q);", "(= f (length:float (sub:vector p q)))"},
    {"f = length(n);", "(= f (length:float (cast:vector n)))"},
    {"v1 = normalize(n);", "(= v1 (cast:vector (normalize:normal n)))"},
    {"c = mix(c, d, f);", "(= c (mix:color c d f))"},
    {"c = mix(c, d, 0.5);", "(= c (mix:color c d 0.5))"},
    {"f = mix(1, 2, f);", "(= f (mix:float 1 2 f))"},
    {"f = max(f, 1);", "(= f (max:float f 1))"},
    {"f = clamp(f, 0, 1);", "(= f (clamp:float f 0 1))"},
    {"c = clamp(c, color 0, color 1);", "(= c (clamp:color c (cast:color 0) (cast:color 1)))"},
    {"c = texture(\"a\");", "(= c (texture:color \"a\"))"},
    {"f = texture(\"a\");", "(= f (texture:float \"a\"))"},
    {"c *= texture(\"a\");", "(*= c (texture:color \"a\"))"},
    {"c = d * texture(\"a\");", "(= c (mul:color d (texture:color \"a\")))"},
    {"f = texture(\"a\"[2]);", "(= f (texture:float \"a\" [2]))"},
    {"f = texture(str[1], f, g);", "(= f (texture:float str f g [1]))"},
    {"f = float texture((str)[0], f, g);", "(= f (texture:float str f g [0]))"},
    {"c = texture(str + \"\");", "(= c (texture:color str))"},
    {"c = color texture(str, f, g, \"blur\", 0.1);", "(= c (texture:color str f g \"blur\"=0.1))"},
    {"c = texture(str, f, g, \"uniform float blur\", 0.1);", "(= c (texture:color str f g \"blur\"=0.1))"},
    {"p = transform(\"shader\", p);", "(= p (transform:point \"shader\" p))"},
    {"p = transform(\"shader\", \"world\", p);", "(= p (transform:point \"shader\" \"world\" p))"},
    {"c = spline(f, c, c, d, d);", "(= c (spline:color f c c d d))"},
    {"f = spline(\"linear\", f, 0, 1, 2, 3);", "(= f (spline:float \"linear\" f 0 1 2 3))"},
    {"c = spline(f, ca);", "(= c (spline:color f ca))"},
    {"f = surface(\"Kd\", g);", "(= f (surface:float \"Kd\" g))"},
    {"f = surface(\"x\", a);", "(= f (surface:float \"x\" a))"},
    {"fresnel(v1, n, f, g, h);", "(fresnel:void v1 (cast:vector n) f g h)"},
    {"printf(\"%f %p\", f, p);", "(printf:void \"%f %p\" f p)"},
    {"c = specular(n, v1, 0.1);", "(= c (rsl specular:color (cast:vector n) v1 0.1))"},
    {"v1 = Du(p);", "(= v1 (Du:vector p))"},
    {"c = Du(c);", "(= c (Du:color c))"},
    {"setxcomp(p, 1);", "(setxcomp:void p 1)"},
    {"f = (f > 0 ? noise(p) : 1);", "(= f (?:float (greater:bool f 0) (noise:float p) 1))"},
};

void checkAll(std::span<const Case> cases) {
    for (const Case& c : cases) EXPECT_EQ(printBody(c.body), c.tree) << c.body;
}

TEST(FrontExpressions, Precedence) { checkAll(kPrecedence); }
TEST(FrontExpressions, Conversions) { checkAll(kConversions); }
TEST(FrontExpressions, Casts) { checkAll(kCasts); }
TEST(FrontExpressions, Overloads) { checkAll(kOverloads); }

TEST(FrontExpressions, SymbolsAreShared) {
    const auto c = compileBody("f = f + 1;");
    ASSERT_TRUE(c.program);
    const Expr& e = *c.program->shaders[0]->body->body.back()->value;
    EXPECT_EQ(e.args[0]->symbol, e.args[1]->args[0]->symbol);
}

TEST(FrontExpressions, VaryingFollowsOperands) {
    const auto c = compileSnippet("surface s(float Kd = 1) { uniform float x = Kd * 2; float y = u; Ci = x * y; }");
    ASSERT_TRUE(c.program);
    const auto& body = c.program->shaders[0]->body->body;
    EXPECT_FALSE(body[0]->declarators[0].init->varying);
    EXPECT_TRUE(body[1]->declarators[0].init->varying);
    EXPECT_TRUE(body[2]->value->varying);
    EXPECT_TRUE(c.messages.empty()) << c.text();
}

} // namespace
} // namespace alpenglow::rsl::front_expressions_test
