/* The C binding of the RenderMan Interface 3.2, as far as a library of procedurals needs it: Procedural "DynamicLoad"
 * loads such a library with --allow-exec and calls the three functions that it defines,
 *
 *     RtPointer ConvertParameters(RtString data);            the data of the request to whatever the library wants to keep
 *     RtVoid    Subdivide(RtPointer data, RtFloat detail);   makes the content by calls of the functions below
 *     RtVoid    Free(RtPointer data);                        gives back what ConvertParameters made
 *
 * Nothing is linked to: the program that loads the library has the functions. Build it with cc -shared -fPIC -I include,
 * in C or C++.
 *
 * The calls mean what the requests of the same names mean in RIB (docs/rib.md), at the place of the procedural: they may
 * come only while Subdivide (or a function given to RiProcedural) runs, in the thread that it runs in; at other times
 * they do nothing. The graphics state is saved before and restored after. detail is the area in pixels of the bound,
 * RI_INFINITY when it reaches behind the eye or there is no picture. Errors are reported by the program, at the line of
 * the request; bad arguments never end it, but what the library itself does to memory is done to the program. The
 * requests of cameras, options, frames, worlds, textures and error handling belong to the scene and are not here.
 * Parameter lists end with RI_NULL; the forms ending in V take arrays. Lengths of values follow from declarations
 * (RiDeclare, or "class type name" as token); a token that nobody declared is left out with an error. */
#ifndef ALPENGLOW_RI_H
#define ALPENGLOW_RI_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#define RI_CHARS const char /* so that literals need no cast */
#else
#define RI_CHARS char
#endif

typedef short RtBoolean;
typedef int RtInt;
typedef float RtFloat;
typedef RI_CHARS* RtToken;
typedef RI_CHARS* RtString;
typedef RtFloat RtColor[3];
typedef RtFloat RtPoint[3];
typedef RtFloat RtVector[3];
typedef RtFloat RtNormal[3];
typedef RtFloat RtHpoint[4];
typedef RtFloat RtMatrix[4][4];
typedef RtFloat RtBasis[4][4];
typedef RtFloat RtBound[6]; /* xmin xmax ymin ymax zmin zmax */
typedef void RtVoid;
typedef void* RtPointer;
typedef RtPointer RtLightHandle;
typedef RtPointer RtObjectHandle;
typedef RtVoid (*RtProcSubdivFunc)(RtPointer, RtFloat);
typedef RtVoid (*RtProcFreeFunc)(RtPointer);
typedef RtVoid (*RtArchiveCallback)(RtToken, RI_CHARS*, ...);

#define RI_FALSE 0
#define RI_TRUE 1
#define RI_INFINITY ((RtFloat)1.0e38)
#define RI_EPSILON ((RtFloat)1.0e-10)
#define RI_NULL ((RtToken)0)

#define RI_P ((RtToken) "P")
#define RI_PZ ((RtToken) "Pz")
#define RI_PW ((RtToken) "Pw")
#define RI_N ((RtToken) "N")
#define RI_NP ((RtToken) "Np")
#define RI_CS ((RtToken) "Cs")
#define RI_OS ((RtToken) "Os")
#define RI_S ((RtToken) "s")
#define RI_T ((RtToken) "t")
#define RI_ST ((RtToken) "st")
#define RI_WIDTH ((RtToken) "width")
#define RI_CONSTANTWIDTH ((RtToken) "constantwidth")
#define RI_KA ((RtToken) "Ka")
#define RI_KD ((RtToken) "Kd")
#define RI_KS ((RtToken) "Ks")
#define RI_KR ((RtToken) "Kr")
#define RI_ROUGHNESS ((RtToken) "roughness")
#define RI_INTENSITY ((RtToken) "intensity")
#define RI_LIGHTCOLOR ((RtToken) "lightcolor")
#define RI_FROM ((RtToken) "from")
#define RI_TO ((RtToken) "to")
#define RI_BILINEAR ((RtToken) "bilinear")
#define RI_BICUBIC ((RtToken) "bicubic")
#define RI_LINEAR ((RtToken) "linear")
#define RI_CUBIC ((RtToken) "cubic")
#define RI_PERIODIC ((RtToken) "periodic")
#define RI_NONPERIODIC ((RtToken) "nonperiodic")
#define RI_PRIMITIVE ((RtToken) "primitive")
#define RI_UNION ((RtToken) "union")
#define RI_INTERSECTION ((RtToken) "intersection")
#define RI_DIFFERENCE ((RtToken) "difference")
#define RI_INSIDE ((RtToken) "inside")
#define RI_OUTSIDE ((RtToken) "outside")
#define RI_LH ((RtToken) "lh")
#define RI_RH ((RtToken) "rh")
#define RI_CONSTANT ((RtToken) "constant")
#define RI_SMOOTH ((RtToken) "smooth")
#define RI_FLATNESS ((RtToken) "flatness")
#define RI_COMMENT ((RtToken) "comment")
#define RI_STRUCTURE ((RtToken) "structure")
#define RI_VERBATIM ((RtToken) "verbatim")

#define RI_BEZIERSTEP 3
#define RI_BSPLINESTEP 1
#define RI_CATMULLROMSTEP 1
#define RI_HERMITESTEP 2
#define RI_POWERSTEP 4
extern RtBasis RiBezierBasis, RiBSplineBasis, RiCatmullRomBasis, RiHermiteBasis, RiPowerBasis;

/* Every call with a parameter list, in both forms. */
#define RI_BOTH(result, name, ...)                                                                                               \
    result name(__VA_ARGS__, ...);                                                                                               \
    result name##V(__VA_ARGS__, RtInt n, RtToken tokens[], RtPointer values[])

/* Blocks, declarations, motion */
RtToken RiDeclare(RI_CHARS* name, RI_CHARS* declaration);
RtVoid RiAttributeBegin(void);
RtVoid RiAttributeEnd(void);
RtVoid RiTransformBegin(void);
RtVoid RiTransformEnd(void);
RtVoid RiSolidBegin(RtToken operation);
RtVoid RiSolidEnd(void);
RtObjectHandle RiObjectBegin(void);
RtVoid RiObjectEnd(void);
RtVoid RiObjectInstance(RtObjectHandle handle);
RtVoid RiMotionBegin(RtInt n, ...);
RtVoid RiMotionBeginV(RtInt n, RtFloat times[]);
RtVoid RiMotionEnd(void);

/* Attributes */
RtVoid RiColor(RtColor color);
RtVoid RiOpacity(RtColor color);
RtVoid RiTextureCoordinates(RtFloat s1, RtFloat t1, RtFloat s2, RtFloat t2, RtFloat s3, RtFloat t3, RtFloat s4, RtFloat t4);
RtVoid RiShadingRate(RtFloat size);
RtVoid RiShadingInterpolation(RtToken type);
RtVoid RiMatte(RtBoolean on);
RtVoid RiBound(RtBound bound);
RtVoid RiDetail(RtBound bound);
RtVoid RiDetailRange(RtFloat minvisible, RtFloat lowertransition, RtFloat uppertransition, RtFloat maxvisible);
RtVoid RiGeometricApproximation(RtToken type, RtFloat value);
RtVoid RiOrientation(RtToken orientation);
RtVoid RiReverseOrientation(void);
RtVoid RiSides(RtInt sides);
RtVoid RiBasis(RtBasis ubasis, RtInt ustep, RtBasis vbasis, RtInt vstep);
RtVoid RiTrimCurve(RtInt nloops, RtInt ncurves[], RtInt order[], RtFloat knot[], RtFloat min[], RtFloat max[], RtInt n[],
                   RtFloat u[], RtFloat v[], RtFloat w[]);
RI_BOTH(RtVoid, RiAttribute, RI_CHARS* name);

/* Shaders and lights */
RI_BOTH(RtVoid, RiSurface, RI_CHARS* name);
RI_BOTH(RtVoid, RiDisplacement, RI_CHARS* name);
RI_BOTH(RtVoid, RiAtmosphere, RI_CHARS* name);
RI_BOTH(RtVoid, RiInterior, RI_CHARS* name);
RI_BOTH(RtVoid, RiExterior, RI_CHARS* name);
RI_BOTH(RtVoid, RiShader, RI_CHARS* name, RI_CHARS* handle);
RI_BOTH(RtLightHandle, RiLightSource, RI_CHARS* name);
RI_BOTH(RtLightHandle, RiAreaLightSource, RI_CHARS* name);
RtVoid RiIlluminate(RtLightHandle light, RtBoolean on);

/* Transformations. RiTransformPoints gives back points, or 0 when there is no such space: then they are as they were. */
RtVoid RiIdentity(void);
RtVoid RiTransform(RtMatrix matrix);
RtVoid RiConcatTransform(RtMatrix matrix);
RtVoid RiPerspective(RtFloat fov);
RtVoid RiTranslate(RtFloat dx, RtFloat dy, RtFloat dz);
RtVoid RiRotate(RtFloat angle, RtFloat dx, RtFloat dy, RtFloat dz);
RtVoid RiScale(RtFloat sx, RtFloat sy, RtFloat sz);
RtVoid RiSkew(RtFloat angle, RtFloat dx1, RtFloat dy1, RtFloat dz1, RtFloat dx2, RtFloat dy2, RtFloat dz2);
RtVoid RiCoordinateSystem(RtToken space);
RtVoid RiScopedCoordinateSystem(RtToken space);
RtVoid RiCoordSysTransform(RtToken space);
RtPoint* RiTransformPoints(RtToken fromspace, RtToken tospace, RtInt n, RtPoint points[]);

/* Primitives */
RI_BOTH(RtVoid, RiPolygon, RtInt nvertices);
RI_BOTH(RtVoid, RiGeneralPolygon, RtInt nloops, RtInt nverts[]);
RI_BOTH(RtVoid, RiPointsPolygons, RtInt npolys, RtInt nverts[], RtInt verts[]);
RI_BOTH(RtVoid, RiPointsGeneralPolygons, RtInt npolys, RtInt nloops[], RtInt nverts[], RtInt verts[]);
RI_BOTH(RtVoid, RiPatch, RtToken type);
RI_BOTH(RtVoid, RiPatchMesh, RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap);
RI_BOTH(RtVoid, RiNuPatch, RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder,
        RtFloat vknot[], RtFloat vmin, RtFloat vmax);
RI_BOTH(RtVoid, RiSubdivisionMesh, RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[],
        RtInt nargs[], RtInt intargs[], RtFloat floatargs[]);
RI_BOTH(RtVoid, RiSphere, RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax);
RI_BOTH(RtVoid, RiCone, RtFloat height, RtFloat radius, RtFloat thetamax);
RI_BOTH(RtVoid, RiCylinder, RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax);
RI_BOTH(RtVoid, RiHyperboloid, RtPoint point1, RtPoint point2, RtFloat thetamax);
RI_BOTH(RtVoid, RiParaboloid, RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax);
RI_BOTH(RtVoid, RiDisk, RtFloat height, RtFloat radius, RtFloat thetamax);
RI_BOTH(RtVoid, RiTorus, RtFloat majorradius, RtFloat minorradius, RtFloat phimin, RtFloat phimax, RtFloat thetamax);
RI_BOTH(RtVoid, RiPoints, RtInt npoints);
RI_BOTH(RtVoid, RiCurves, RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap);
RI_BOTH(RtVoid, RiBlobby, RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings,
        RtString strings[]);
RI_BOTH(RtVoid, RiGeometry, RtToken type);

/* More procedurals: done at once, nested up to a limit of the program. The first three take RtString arrays as data: {
 * file }, { command, data }, { library, data }. RiProcFree is free(). The callback of RiReadArchive is not called. */
RtVoid RiProcedural(RtPointer data, RtBound bound, RtProcSubdivFunc subdivide, RtProcFreeFunc free);
RtVoid RiProcDelayedReadArchive(RtPointer data, RtFloat detail);
RtVoid RiProcRunProgram(RtPointer data, RtFloat detail);
RtVoid RiProcDynamicLoad(RtPointer data, RtFloat detail);
RtVoid RiProcFree(RtPointer data);
RI_BOTH(RtVoid, RiReadArchive, RtToken name, RtArchiveCallback callback);
RtVoid RiArchiveRecord(RtToken type, RI_CHARS* format, ...);

#undef RI_BOTH
#undef RI_CHARS

#ifdef __cplusplus
}
#endif
#endif
