/* The scenes that the specification explains the interface with, in C of 1989: examples SCENE [RIB-FILE]. Without a file they are
 * drawn as SCENE.exr, of 64 x 64 pixels. */
#include <ri.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static RtColor red = {1, 0, 0}, blue = {.1f, .2f, .7f};

/* The smallest program: a square, seen from the front. */
static void square(void) {
    static RtPoint points[4] = {{.5, .5, 1}, {-.5, .5, 1}, {-.5, -.5, 1}, {.5, -.5, 1}};
    RiWorldBegin();
    RiSurface("constant", RI_NULL);
    RiColor(red);
    RiPolygon(4, RI_P, (RtPointer)points, RI_NULL);
    RiWorldEnd();
}

/* A cube of n cubes a side, each of its own colour, made of one of side 1. */
static void unit_cube(void) {
    static RtPoint sides[6][4] = {{{-.5, -.5, -.5}, {-.5, -.5, .5}, {-.5, .5, .5}, {-.5, .5, -.5}},
                                  {{-.5, .5, -.5}, {-.5, .5, .5}, {.5, .5, .5}, {.5, .5, -.5}},
                                  {{.5, .5, -.5}, {.5, .5, .5}, {.5, -.5, .5}, {.5, -.5, -.5}},
                                  {{.5, -.5, -.5}, {.5, -.5, .5}, {-.5, -.5, .5}, {-.5, -.5, -.5}},
                                  {{-.5, -.5, -.5}, {-.5, .5, -.5}, {.5, .5, -.5}, {.5, -.5, -.5}},
                                  {{-.5, -.5, .5}, {.5, -.5, .5}, {.5, .5, .5}, {-.5, .5, .5}}};
    int i;
    for (i = 0; i < 6; i++) RiPolygon(4, RI_P, (RtPointer)sides[i], RI_NULL);
}
static void color_cube(int n, RtFloat size) {
    int x, y, z;
    RtColor color;
    RiAttributeBegin();
    RiTranslate(-.5, -.5, -.5);
    RiScale(1 / (RtFloat)n, 1 / (RtFloat)n, 1 / (RtFloat)n);
    for (x = 0; x < n; x++)
        for (y = 0; y < n; y++)
            for (z = 0; z < n; z++) {
                color[0] = (x + 1) / (RtFloat)n;
                color[1] = (y + 1) / (RtFloat)n;
                color[2] = (z + 1) / (RtFloat)n;
                RiColor(color);
                RiTransformBegin();
                RiTranslate(x + .5f, y + .5f, z + .5f);
                RiScale(size, size, size);
                unit_cube();
                RiTransformEnd();
            }
    RiAttributeEnd();
}
static void cubes(void) {
    RtFloat fov = 40;
    RiProjection(RI_PERSPECTIVE, RI_FOV, (RtPointer)&fov, RI_NULL);
    RiTranslate(0, 0, 3);
    RiRotate(40, -1, 1, 0);
    RiLightSource("distantlight", RI_NULL);
    RiWorldBegin();
    RiSurface("matte", RI_NULL);
    color_cube(3, .8f);
    RiWorldEnd();
}

/* Every quadric, with lights, named spaces and levels of attributes. */
static void quadrics(void) {
    static RtPoint left = {1, 0, 0}, right = {.3f, 1, .5f};
    static RtMatrix tilt = {{1, 0, 0, 0}, {0, .5f, -.9f, 0}, {0, .9f, .5f, 0}, {0, 0, 0, 1}};
    static RtFloat intensity = 20, half = .5, vary[4] = {0, 1, 1, .5};
    static RtPoint lamp = {4, 4, -4};
    RtLightHandle light;
    RiScreenWindow(-4, 4, -4, 4);
    RiTranslate(0, 0, 10);
    RiWorldBegin();
    light = RiLightSource("pointlight", RI_FROM, (RtPointer)lamp, RI_INTENSITY, (RtPointer)&intensity, RI_NULL);
    RiLightSource("ambientlight", RI_INTENSITY, (RtPointer)&half, RI_NULL);
    RiSurface("plastic", RI_KD, (RtPointer)&half, RI_NULL);
    RiColor(blue);
    RiAttributeBegin();
    RiTranslate(-2.5, 2.5, 0);
    RiSphere(1, -.5, .8f, 270, RI_NULL);
    RiTranslate(2.5, 0, 0);
    RiCone(1.5, 1, 360, RI_NULL);
    RiTranslate(2.5, 0, 0);
    RiCylinder(.8f, -1, 1, 360, RI_NULL);
    RiAttributeEnd();
    RiAttributeBegin();
    RiTranslate(-2.5, 0, 0);
    RiHyperboloid(left, right, 360, RI_NULL);
    RiTranslate(2.5, 0, 0);
    RiRotate(120, 1, .3f, 0);
    RiParaboloid(1, 0, 1.2f, 360, RI_NULL);
    RiIlluminate(light, RI_FALSE);
    RiIdentity();
    RiTranslate(2.5, 0, 0);
    RiDisk(0, 1, 360, "varying float t", (RtPointer)vary, RI_NULL);
    RiAttributeEnd();
    RiTranslate(0, -2.5, 0);
    RiConcatTransform(tilt);
    RiTorus(1, .4f, 0, 360, 360, RI_NULL);
    RiWorldEnd();
}

/* A ball that is moved and grows while the shutter is open. */
static void motion(void) {
    RiShutter(0, 1);
    RiPixelSamples(3, 3);
    RiTranslate(0, 0, 5);
    RiWorldBegin();
    RiSurface("constant", RI_NULL);
    RiMotionBegin(2, 0.0, 1.0);
    RiTranslate(-.4f, 0, 0);
    RiTranslate(.4f, .1f, 0);
    RiMotionEnd();
    RiMotionBegin(2, 0.0, 1.0);
    RiSphere(.4f, -.4f, .4f, 360, RI_NULL);
    RiSphere(.5f, -.5f, .5f, 360, RI_NULL);
    RiMotionEnd();
    RiWorldEnd();
}

/* A ball with a hole, as solids. */
static void solid(void) {
    RiTranslate(0, 0, 5);
    RiRotate(20, 0, 1, 0);
    RiLightSource("distantlight", RI_NULL);
    RiWorldBegin();
    RiSurface("matte", RI_NULL);
    RiSolidBegin(RI_DIFFERENCE);
    RiSolidBegin(RI_PRIMITIVE);
    RiSphere(.8f, -.8f, .8f, 360, RI_NULL);
    RiSolidEnd();
    RiSolidBegin(RI_PRIMITIVE);
    RiColor(red);
    RiCylinder(.4f, -1, 1, 360, RI_NULL);
    RiDisk(1, .4f, 360, RI_NULL);
    RiDisk(-1, .4f, -360, RI_NULL);
    RiSolidEnd();
    RiSolidEnd();
    RiWorldEnd();
}

/* Patches of several bases, a mesh, NURBS with a trim curve, curves, points, a subdivision surface, a blobby. */
static void surfaces(void) {
    static RtFloat arch[16][3], heights[3][3] = {{0, .3f, 0}, {.3f, .6f, .3f}, {0, .3f, 0}};
    static RtFloat knots[] = {0, 0, 0, 1, 1, 1}, hull[9][4], widths[2] = {.1f, .02f}, one = .2f;
    static RtPoint line[4] = {{0, 0, 0}, {.3f, 1, 0}, {.6f, -1, 0}, {1, 0, 0}};
    static RtInt four = 4, loops[] = {1}, order[] = {2}, n[] = {5};
    static RtFloat tknot[] = {0, 0, 1, 2, 3, 4, 4}, tmin[] = {0}, tmax[] = {4};
    static RtFloat tu[] = {.3f, .7f, .7f, .3f, .3f}, tv[] = {.3f, .3f, .7f, .7f, .3f}, tw[] = {1, 1, 1, 1, 1};
    static RtInt faces[6] = {4, 4, 4, 4, 4, 4};
    static RtInt corners[24] = {0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3};
    static RtPoint box[8] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    static RtToken tags[] = {"crease"};
    static RtInt nargs[] = {5, 1}, creases[] = {0, 1, 3, 2, 0};
    static RtFloat sharp[] = {3};
    static RtInt code[] = {1001, 0, 1001, 16, 0, 2, 0, 1};
    static RtFloat blobs[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, .6f, 0, 0, 1};
    int i, k;
    for (i = 0; i < 4; i++)
        for (k = 0; k < 4; k++) {
            arch[4 * i + k][0] = k / 3.0f;
            arch[4 * i + k][1] = i / 3.0f;
            arch[4 * i + k][2] = -(RtFloat)((i == 1 || i == 2) && (k == 1 || k == 2));
        }
    for (i = 0; i < 3; i++)
        for (k = 0; k < 3; k++) {
            hull[3 * i + k][0] = k / 2.0f;
            hull[3 * i + k][1] = i / 2.0f;
            hull[3 * i + k][2] = -heights[i][k];
            hull[3 * i + k][3] = 1;
        }
    RiScreenWindow(-2, 2, -2, 2);
    RiTranslate(0, 0, 5);
    RiLightSource("distantlight", RI_NULL);
    RiWorldBegin();
    RiSurface("matte", RI_NULL);
    RiTransformBegin();
    RiTranslate(-1.8f, .5, 0);
    RiPatch(RI_BICUBIC, RI_P, (RtPointer)arch, RI_NULL);
    RiTranslate(1.3f, 0, 0);
    RiBasis(RiBSplineBasis, RI_BSPLINESTEP, RiCatmullRomBasis, RI_CATMULLROMSTEP);
    RiPatchMesh(RI_BICUBIC, 4, RI_NONPERIODIC, 4, RI_NONPERIODIC, RI_P, (RtPointer)arch, RI_NULL);
    RiTranslate(1.2f, 0, 0);
    RiTrimCurve(1, loops, order, tknot, tmin, tmax, n, tu, tv, tw);
    RiNuPatch(3, 3, knots, 0, 1, 3, 3, knots, 0, 1, RI_PW, (RtPointer)hull, RI_NULL);
    RiTransformEnd();
    RiTranslate(-1.8f, -1.2f, 0);
    RiBasis(RiBezierBasis, RI_BEZIERSTEP, RiBezierBasis, RI_BEZIERSTEP);
    RiCurves(RI_CUBIC, 1, &four, RI_NONPERIODIC, RI_P, (RtPointer)line, RI_WIDTH, (RtPointer)widths, RI_NULL);
    RiPoints(4, RI_P, (RtPointer)line, RI_CONSTANTWIDTH, (RtPointer)&one, RI_NULL);
    RiTranslate(1.4f, 0, 0);
    RiTransformBegin();
    RiScale(.8f, .8f, .8f);
    RiRotate(30, 1, 1, 0);
    RiSubdivisionMesh("catmull-clark", 6, faces, corners, 1, tags, nargs, creases, sharp, RI_P, (RtPointer)box, RI_NULL);
    RiTransformEnd();
    RiTranslate(1.5, .3f, 0);
    RiColor(red);
    RiBlobby(2, 8, code, 32, blobs, 0, (RtString*)0, RI_NULL);
    RiWorldEnd();
}

/* Objects: retained once, drawn three times, each with the colour of its place. */
static void objects(void) {
    static RtColor colors[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    RtObjectHandle ball;
    int i;
    RiTranslate(0, 0, 5);
    RiWorldBegin();
    RiSurface("constant", RI_NULL);
    ball = RiObjectBegin();
    RiSphere(.3f, -.3f, .3f, 360, RI_NULL);
    RiObjectEnd();
    for (i = 0; i < 3; i++) {
        RiAttributeBegin();
        RiColor(colors[i]);
        RiTranslate(.7f * (i - 1), 0, 0);
        RiObjectInstance(ball);
        RiAttributeEnd();
    }
    RiWorldEnd();
}

/* A procedural that makes itself of smaller ones. */
typedef struct {
    int level;
    RtFloat size;
} Sponge;
static RtVoid sponge(RtPointer data, RtFloat detail) {
    const Sponge* s = (const Sponge*)data;
    int i;
    if (s->level == 0 || detail < 1) {
        static RtFloat z[4];
        RtPoint p[4];
        RtFloat h = s->size / 2;
        for (i = 0; i < 4; i++) {
            p[i][0] = i == 0 || i == 3 ? -h : h;
            p[i][1] = i < 2 ? -h : h;
            p[i][2] = z[i];
        }
        RiPolygon(4, RI_P, (RtPointer)p, RI_NULL);
        return;
    }
    for (i = 0; i < 9; i++) {
        RtBound bound;
        Sponge* part;
        if (i == 4) continue;
        part = (Sponge*)malloc(sizeof(Sponge));
        part->level = s->level - 1;
        part->size = s->size / 3;
        bound[0] = bound[2] = -part->size / 2;
        bound[1] = bound[3] = part->size / 2;
        bound[4] = bound[5] = 0;
        RiTransformBegin();
        RiTranslate((i % 3 - 1) * part->size, (i / 3 - 1) * part->size, 0);
        RiProcedural(part, bound, sponge, RiProcFree);
        RiTransformEnd();
    }
}
static void procedural(void) {
    static RtBound bound = {-.9f, .9f, -.9f, .9f, 0, 0};
    Sponge* whole = (Sponge*)malloc(sizeof(Sponge));
    whole->level = 3;
    whole->size = 1.8f;
    RiTranslate(0, 0, 5);
    RiWorldBegin();
    RiSurface("constant", RI_NULL);
    RiProcedural(whole, bound, sponge, RiProcFree);
    RiWorldEnd();
}

/* Frames of an animation, with attributes that hold in one of them. */
static void frames(void) {
    RtInt frame;
    for (frame = 1; frame <= 2; frame++) {
        char name[32];
        RiFrameBegin(frame);
        sprintf(name, "frames%d.exr", (int)frame);
        RiDisplay(name, "openexr", RI_RGBA, RI_NULL);
        RiRotate(45 * (RtFloat)frame, 0, 0, 1);
        square();
        RiFrameEnd();
    }
}

typedef struct {
    const char* name;
    void (*draw)(void);
} Scene;
static const Scene scenes[] = {{"square", square},   {"cubes", cubes},           {"quadrics", quadrics},
                               {"motion", motion},   {"solid", solid},           {"surfaces", surfaces},
                               {"objects", objects}, {"procedural", procedural}, {"frames", frames}};

int main(int argc, char** argv) {
    size_t i;
    for (i = 0; argc > 1 && i < sizeof scenes / sizeof *scenes; i++) {
        char name[64];
        if (strcmp(argv[1], scenes[i].name) != 0) continue;
        RiBegin(argc > 2 ? argv[2] : RI_NULL);
        sprintf(name, "%s.exr", scenes[i].name);
        RiFormat(64, 64, 1);
        RiDisplay(name, "openexr", RI_RGBA, RI_NULL);
        RiPixelFilter(RiBoxFilter, 1, 1);
        scenes[i].draw();
        RiEnd();
        return RiLastError;
    }
    fprintf(stderr, "examples SCENE [RIB-FILE]\n");
    return 2;
}
