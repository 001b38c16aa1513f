/* Functions of the Open Shading Language that RSL has under other names or not at all: included by what is read from .osl files (docs/ris.md). */
#ifndef OSL_H
#define OSL_H
#define M_PI 3.14159265358979
#define M_PI_2 1.57079632679490
#define M_PI_4 .785398163397448
#define M_2PI 6.28318530717959
#define M_1_PI .318309886183791
#define M_2_PI .636619772367581
#define M_E 2.71828182845905
#define M_SQRT2 1.41421356237310
#define M_SQRT1_2 .707106781186548

float osl_fmod(float a, b;) { float q = a / b; return a - b * ((q < 0) ? ceil(q) : floor(q)); }
float osl_int(float a;) { return (a < 0) ? ceil(a) : floor(a); }
float trunc(float a;) { return (a < 0) ? ceil(a) : floor(a); }
float fabs(float a;) { return abs(a); }
float atan2(float y, x;) { return atan(y, x); }
float hypot(float a, b;) { return sqrt(a * a + b * b); }
float log2(float a;) { return log(a) / log(2); }
float log10(float a;) { return log(a) / log(10); }
float exp2(float a;) { return pow(2, a); }
float cbrt(float a;) { return sign(a) * pow(abs(a), 1 / 3); }
float dot(vector a, b;) { return a . b; }
vector cross(vector a, b;) { return a ^ b; }
float linearstep(float a, b, x;) { return (a == b) ? ((x < a) ? 0 : 1) : clamp((x - a) / (b - a), 0, 1); }
float luminance(color c;) { return .2126 * comp(c, 0) + .7152 * comp(c, 1) + .0722 * comp(c, 2); }
float aastep(float edge, x;) { return filterstep(edge, x); }
float filterwidth(float x;) { return abs(Du(x) * du) + abs(Dv(x) * dv); }
float inversesqrt(float a;) { return (a > 0) ? 1 / sqrt(a) : 0; }
float expm1(float a;) { return exp(a) - 1; }
float select(float a, b, c;) { return (c != 0) ? b : a; }
color select(color a, b; float c;) { return (c != 0) ? b : a; }
float hashnoise(float x;) { return float cellnoise(x); }
float hashnoise(float x, y;) { return float cellnoise(x, y); }
float hashnoise(point p;) { return float cellnoise(p); }
float backfacing() { return (N . I > 0) ? 1 : 0; }
float osl_isnull(float a;) { return 0; }

float snoise(float x;) { return 2 * float noise(x) - 1; }
float snoise(float x, y;) { return 2 * float noise(x, y) - 1; }
float snoise(point p;) { return 2 * float noise(p) - 1; }
float snoise(point p; float t;) { return 2 * float noise(p, t) - 1; }
color snoise(float x;) { return 2 * color noise(x) - 1; }
color snoise(float x, y;) { return 2 * color noise(x, y) - 1; }
color snoise(point p;) { return 2 * color noise(p) - 1; }
color snoise(point p; float t;) { return 2 * color noise(p, t) - 1; }
vector snoise(point p;) { return 2 * vector noise(p) - vector(1, 1, 1); }
vector snoise(float x, y;) { return 2 * vector noise(x, y) - vector(1, 1, 1); }
#endif
