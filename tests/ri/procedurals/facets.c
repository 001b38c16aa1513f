/* A library of procedurals as the tests load it: the data says what to make. */
#include <ri.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    char what[32];
    float number;
} Wish;

static int made, freed; /* a library may remember */

RtPointer ConvertParameters(RtString data) {
    Wish* w = calloc(1, sizeof *w);
    sscanf(data, "%31s %f", w->what, &w->number);
    data[0] = 'x'; /* it is ours */
    return w;
}

static void halve(RtPointer data, RtFloat detail) {
    Wish* w = data;
    RtBound bound;
    int i;
    (void)detail;
    if (w->number < 1) {
        RiSphere(w->number, -w->number, w->number, 360, RI_NULL);
        return;
    }
    for (i = 0; i < 2; ++i) {
        Wish* half = malloc(sizeof *half);
        int k;
        *half = *w;
        half->number = w->number / 2;
        for (k = 0; k < 6; ++k) bound[k] = k % 2 ? half->number : -half->number;
        RiTranslate(w->number, 0, 0);
        RiProcedural(half, bound, halve, RiProcFree);
    }
}

static void forever(RtPointer data, RtFloat detail) {
    RtBound bound = {-1, 1, -1, 1, -1, 1};
    (void)data;
    (void)detail;
    RiProcedural(NULL, bound, forever, NULL);
}

static void variables(void) {
    RtPoint corners[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    RtInt nverts[2] = {4, 4}, verts[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    RtColor faces[2] = {{1, 0, 0}, {0, 1, 0}};
    RtFloat seams[8] = {1, 2, 3, 4, 5, 6, 7, 8}, one = 9;
    RtString name[1] = {"box"};
    RiDeclare("kinds", "facevarying float");
    RiPointsPolygons(2, nverts, verts, RI_P, (RtPointer)corners, "uniform color Cs", (RtPointer)faces, "kinds", (RtPointer)seams,
                     "constant float weight", (RtPointer)&one, "constant string label", (RtPointer)name, RI_NULL);
}

static void state(void) {
    RtColor red = {1, 0, 0};
    RtFloat kd = 0.25f, sphere = 0.5f, power = 3;
    RtInt hair = 1;
    RtLightHandle lamp;
    RtObjectHandle object;
    RtPoint at[1] = {{1, 2, 3}};
    RiAttributeBegin();
    RiColor(red);
    RiSurface("matte", RI_KD, (RtPointer)&kd, RI_NULL);
    RiAttribute("displacementbound", "sphere", (RtPointer)&sphere, RI_NULL);
    RiAttribute("dice", "int hair", (RtPointer)&hair, RI_NULL);
    RiBasis(RiBSplineBasis, RI_BSPLINESTEP, RiBezierBasis, RI_BEZIERSTEP);
    lamp = RiLightSource("pointlight", RI_INTENSITY, (RtPointer)&power, RI_NULL);
    RiIlluminate(lamp, RI_TRUE);
    object = RiObjectBegin();
    RiDisk(0, 1, 360, RI_NULL);
    RiObjectEnd();
    RiTranslate(0, 0, 1);
    RiCoordinateSystem("here");
    if (RiTransformPoints("here", "world", 1, at) != at) at[0][2] = -1;
    RiMotionBegin(2, 0.0, 1.0);
    RiTranslate(at[0][0], at[0][1], at[0][2]);
    RiTranslate(0, 0, 0);
    RiMotionEnd();
    RiObjectInstance(object);
    RiSphere(2, -2, 2, 360, RI_NULL);
    RiAttributeEnd();
    RiSphere(3, -3, 3, 360, RI_NULL);
}

static void mistakes(void) {
    RtInt nverts[1] = {-4};
    RtPoint p[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    float x = 1;
    RiPointsPolygons(1, nverts, NULL, RI_NULL);
    RiPointsPolygons(1, NULL, NULL, RI_NULL);
    RiPolygon(3, RI_P, (RtPointer)0, RI_NULL);
    RiSurface(RI_NULL, RI_NULL);
    RiPolygon(3, RI_P, (RtPointer)p, "unheard", (RtPointer)&x, RI_NULL); /* drawn without it */
    RiColor(NULL);
    RiAttributeBegin(); /* never ended */
}

RtVoid Subdivide(RtPointer data, RtFloat detail) {
    Wish* w = data;
    ++made;
    if (!strcmp(w->what, "detail")) RiSphere(1, -1, 1, detail, RI_NULL);
    else if (!strcmp(w->what, "halves")) halve(data, detail);
    else if (!strcmp(w->what, "forever")) forever(data, detail);
    else if (!strcmp(w->what, "variables")) variables();
    else if (!strcmp(w->what, "state")) state();
    else if (!strcmp(w->what, "mistakes")) mistakes();
    else if (!strcmp(w->what, "count")) RiSphere((RtFloat)made, -1, 1, (RtFloat)(100 + freed), RI_NULL);
    else if (!strcmp(w->what, "archive")) {
        RtString* name = malloc(sizeof *name);
        RtBound bound = {-1, 1, -1, 1, -1, 1};
        name[0] = "ball.rib";
        RiProcedural(name, bound, RiProcDelayedReadArchive, RiProcFree);
    }
}

RtVoid Free(RtPointer data) {
    ++freed;
    free(data);
    RiSphere(77, -1, 1, 360, RI_NULL); /* too late: does nothing */
}
