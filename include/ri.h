/* The C binding of the RenderMan Interface 3.2 (appendix A of the specification), and the calls of later renderers that
 * requests of RIB have here. A program is built with
 *
 *     cc program.c $(pkg-config --cflags --libs alpenglow)
 *
 * and draws its pictures itself, or writes RIB (RiBegin says which). docs/capi.md tells what the calls do beyond the
 * specification, docs/rib.md what each of them means. In C (C89 and later) and C++.
 *
 * The same header serves libraries of procedurals: Procedural "DynamicLoad" loads such a library with --allow-exec and
 * calls the three functions that it defines,
 *
 *     RtPointer ConvertParameters(RtString data);            the data of the request to whatever the library wants to keep
 *     RtVoid    Subdivide(RtPointer data, RtFloat detail);   makes the content by calls of the functions below
 *     RtVoid    Free(RtPointer data);                        gives back what ConvertParameters made
 *
 * Nothing is linked to: the program that loads the library has the functions. Build it with cc -shared -fPIC -I include. Its
 * calls mean what the requests of the same names mean at the place of the procedural: they may come only while Subdivide (or
 * a function given to RiProcedural) runs, in the thread that it runs in; at other times they do nothing. The graphics state
 * is saved before and restored after. detail is the area in pixels of the bound, RI_INFINITY when it reaches behind the eye
 * or there is no picture. RiBegin, RiEnd, RiContext and error handling belong to who draws and are not for libraries.
 *
 * Bad arguments never end the program, but arrays must be as long as the calls say. Parameter lists end with RI_NULL; the
 * forms ending in V take arrays. Lengths of values follow from declarations (RiDeclare, or "class type name" as token); a
 * token that nobody declared is left out with an error. One thread calls at a time. */
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
typedef RtPointer RtObjectHandle;
typedef RtPointer RtLightHandle;
typedef RtPointer RtContextHandle;
typedef RtPointer RtArchiveHandle;
typedef RtFloat (*RtFilterFunc)(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
typedef RtVoid (*RtErrorHandler)(RtInt code, RtInt severity, char* message);
typedef RtVoid (*RtFunc)(void);
typedef RtVoid (*RtProcSubdivFunc)(RtPointer data, RtFloat detail);
typedef RtVoid (*RtProcFreeFunc)(RtPointer data);
typedef RtVoid (*RtArchiveCallback)(RtToken type, char* format, ...);

#define RI_FALSE 0
#define RI_TRUE 1
#define RI_INFINITY ((RtFloat)1.0e38)
#define RI_EPSILON ((RtFloat)1.0e-10)
#define RI_NULL ((RtToken)0)

/* The code of the last warning or error; nothing sets it back to RIE_NOERROR. Codes and severities are those of section 7.2. */
extern RtInt RiLastError;

#define RIE_NOERROR 0
#define RIE_NOMEM 1
#define RIE_SYSTEM 2
#define RIE_NOFILE 3
#define RIE_BADFILE 4
#define RIE_VERSION 5
#define RIE_DISKFULL 6
#define RIE_INCAPABLE 11
#define RIE_UNIMPLEMENT 12
#define RIE_LIMIT 13
#define RIE_BUG 14
#define RIE_NOTSTARTED 23
#define RIE_NESTING 24
#define RIE_NOTOPTIONS 25
#define RIE_NOTATTRIBS 26
#define RIE_NOTPRIMS 27
#define RIE_ILLSTATE 28
#define RIE_BADMOTION 29
#define RIE_BADSOLID 30
#define RIE_BADTOKEN 41
#define RIE_RANGE 42
#define RIE_CONSISTENCY 43
#define RIE_BADHANDLE 44
#define RIE_NOSHADER 45
#define RIE_MISSINGDATA 46
#define RIE_SYNTAX 47
#define RIE_MATH 61

#define RIE_INFO 0
#define RIE_WARNING 1
#define RIE_ERROR 2
#define RIE_SEVERE 3

#define RI_A ((RtToken) "a")
#define RI_ABORT ((RtToken) "abort")
#define RI_AMBIENTLIGHT ((RtToken) "ambientlight")
#define RI_AMPLITUDE ((RtToken) "amplitude")
#define RI_AZ ((RtToken) "az")
#define RI_BACKGROUND ((RtToken) "background")
#define RI_BEAMDISTRIBUTION ((RtToken) "beamdistribution")
#define RI_BICUBIC ((RtToken) "bicubic")
#define RI_BILINEAR ((RtToken) "bilinear")
#define RI_BLACK ((RtToken) "black")
#define RI_BUMPY ((RtToken) "bumpy")
#define RI_CAMERA ((RtToken) "camera")
#define RI_CI ((RtToken) "Ci")
#define RI_CLAMP ((RtToken) "clamp")
#define RI_COMMENT ((RtToken) "comment")
#define RI_CONEANGLE ((RtToken) "coneangle")
#define RI_CONEDELTAANGLE ((RtToken) "conedeltaangle")
#define RI_CONSTANT ((RtToken) "constant")
#define RI_CONSTANTWIDTH ((RtToken) "constantwidth")
#define RI_CS ((RtToken) "Cs")
#define RI_CUBIC ((RtToken) "cubic")
#define RI_CURRENT ((RtToken) "current")
#define RI_DEPTHCUE ((RtToken) "depthcue")
#define RI_DIFFERENCE ((RtToken) "difference")
#define RI_DISTANCE ((RtToken) "distance")
#define RI_DISTANTLIGHT ((RtToken) "distantlight")
#define RI_EYESPLITS ((RtToken) "eyesplits")
#define RI_FACEVARYING ((RtToken) "facevarying")
#define RI_FILE ((RtToken) "file")
#define RI_FLATNESS ((RtToken) "flatness")
#define RI_FOG ((RtToken) "fog")
#define RI_FOV ((RtToken) "fov")
#define RI_FRAMEBUFFER ((RtToken) "framebuffer")
#define RI_FROM ((RtToken) "from")
#define RI_HANDLER ((RtToken) "handler")
#define RI_HANDLEID ((RtToken) "__handleid")
#define RI_HIDDEN ((RtToken) "hidden")
#define RI_IDENTIFIER ((RtToken) "identifier")
#define RI_IGNORE ((RtToken) "ignore")
#define RI_INSIDE ((RtToken) "inside")
#define RI_INTENSITY ((RtToken) "intensity")
#define RI_INTERSECTION ((RtToken) "intersection")
#define RI_KA ((RtToken) "Ka")
#define RI_KD ((RtToken) "Kd")
#define RI_KM ((RtToken) "Km")
#define RI_KR ((RtToken) "Kr")
#define RI_KS ((RtToken) "Ks")
#define RI_LH ((RtToken) "lh")
#define RI_LIGHTCOLOR ((RtToken) "lightcolor")
#define RI_LINEAR ((RtToken) "linear")
#define RI_MATTE ((RtToken) "matte")
#define RI_MAXDISTANCE ((RtToken) "maxdistance")
#define RI_METAL ((RtToken) "metal")
#define RI_MINDISTANCE ((RtToken) "mindistance")
#define RI_N ((RtToken) "N")
#define RI_NAME ((RtToken) "name")
#define RI_NDC ((RtToken) "NDC")
#define RI_NG ((RtToken) "Ng")
#define RI_NONPERIODIC ((RtToken) "nonperiodic")
#define RI_NP ((RtToken) "Np")
#define RI_OBJECT ((RtToken) "object")
#define RI_OI ((RtToken) "Oi")
#define RI_ORIGIN ((RtToken) "origin")
#define RI_ORTHOGRAPHIC ((RtToken) "orthographic")
#define RI_OS ((RtToken) "Os")
#define RI_OUTSIDE ((RtToken) "outside")
#define RI_P ((RtToken) "P")
#define RI_PAINT ((RtToken) "paint")
#define RI_PAINTEDPLASTIC ((RtToken) "paintedplastic")
#define RI_PERIODIC ((RtToken) "periodic")
#define RI_PERSPECTIVE ((RtToken) "perspective")
#define RI_PLASTIC ((RtToken) "plastic")
#define RI_POINTLIGHT ((RtToken) "pointlight")
#define RI_PRIMITIVE ((RtToken) "primitive")
#define RI_PRINT ((RtToken) "print")
#define RI_PW ((RtToken) "Pw")
#define RI_PZ ((RtToken) "Pz")
#define RI_RASTER ((RtToken) "raster")
#define RI_RGB ((RtToken) "rgb")
#define RI_RGBA ((RtToken) "rgba")
#define RI_RGBAI ((RtToken) "rgbai")
#define RI_RGBAZ ((RtToken) "rgbaz")
#define RI_RGBI ((RtToken) "rgbi")
#define RI_RGBZ ((RtToken) "rgbz")
#define RI_RGBZI ((RtToken) "rgbzi")
#define RI_RH ((RtToken) "rh")
#define RI_ROUGHNESS ((RtToken) "roughness")
#define RI_S ((RtToken) "s")
#define RI_SCREEN ((RtToken) "screen")
#define RI_SHADER ((RtToken) "shader")
#define RI_SHADINGGROUP ((RtToken) "shadinggroup")
#define RI_SHINYMETAL ((RtToken) "shinymetal")
#define RI_SMOOTH ((RtToken) "smooth")
#define RI_SPECULARCOLOR ((RtToken) "specularcolor")
#define RI_SPOTLIGHT ((RtToken) "spotlight")
#define RI_ST ((RtToken) "st")
#define RI_STRUCTURE ((RtToken) "structure")
#define RI_T ((RtToken) "t")
#define RI_TEXTURENAME ((RtToken) "texturename")
#define RI_THRESHOLD ((RtToken) "threshold")
#define RI_TO ((RtToken) "to")
#define RI_UNIFORM ((RtToken) "uniform")
#define RI_UNION ((RtToken) "union")
#define RI_VARYING ((RtToken) "varying")
#define RI_VERBATIM ((RtToken) "verbatim")
#define RI_VERTEX ((RtToken) "vertex")
#define RI_WIDTH ((RtToken) "width")
#define RI_WORLD ((RtToken) "world")
#define RI_Z ((RtToken) "z")

#define RI_BEZIERSTEP 3
#define RI_BSPLINESTEP 1
#define RI_CATMULLROMSTEP 1
#define RI_HERMITESTEP 2
#define RI_POWERSTEP 4
extern RtBasis RiBezierBasis, RiBSplineBasis, RiCatmullRomBasis, RiHermiteBasis, RiPowerBasis;

/* Contexts. The name of RiBegin says who gets the calls: RI_NULL or "" draws here, anything else is the RIB file to be
 * written ("-" is standard output), compressed where the name ends in .gz. */
RtVoid RiBegin(RI_CHARS* name);
RtVoid RiEnd(void);
RtContextHandle RiGetContext(void);
RtVoid RiContext(RtContextHandle context);

/* Errors. RiErrorHandler may be called at any time, also before RiBegin. RiErrorPrint is what is used until then. */
RtVoid RiErrorHandler(RtErrorHandler handler);
RtVoid RiErrorIgnore(RtInt code, RtInt severity, char* message);
RtVoid RiErrorPrint(RtInt code, RtInt severity, char* message);
RtVoid RiErrorAbort(RtInt code, RtInt severity, char* message);

/* Pixel filters: x and y from the middle of the filter, its widths, all in pixels. */
RtFloat RiBoxFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiTriangleFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiCatmullRomFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiSeparableCatmullRomFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiGaussianFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiSincFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiBesselFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiDiskFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiMitchellFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiBlackmanHarrisFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);
RtFloat RiLanczosFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth);

/* Points from one space to another: gives back points, or 0 when there is no such space: then they are as they were. */
RtPoint* RiTransformPoints(RtToken fromspace, RtToken tospace, RtInt n, RtPoint points[]);

/* RiProcedural: a function of the program's own is called at once, with the area of the bound in pixels (RI_INFINITY when it
 * is not known), and free after it. The built-in ones take RtString arrays as data: { file }, { command, data }, { library, data
 * }. RiProcFree is free(). */
RtVoid RiProcDelayedReadArchive(RtPointer data, RtFloat detail);
RtVoid RiProcRunProgram(RtPointer data, RtFloat detail);
RtVoid RiProcDynamicLoad(RtPointer data, RtFloat detail);
RtVoid RiProcFree(RtPointer data);
/* The callback of RiReadArchive gets the comments of the archive, at their places: "comment" or "structure", and the text as a
 * format without arguments. */
/* Generated from the table of requests by `alpenglow info --requests --header`: */
/* Structure */
RtVoid RiAttributeBegin(void);
RtVoid RiAttributeEnd(void);
RtVoid RiElse(void);
RtVoid RiElseIf(RtToken expression, ...);
RtVoid RiElseIfV(RtToken expression, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiFrameBegin(RtInt number);
RtVoid RiFrameEnd(void);
RtVoid RiIfBegin(RtToken expression, ...);
RtVoid RiIfBeginV(RtToken expression, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiIfEnd(void);
RtVoid RiMotionBegin(RtInt n, ...);
RtVoid RiMotionBeginV(RtInt n, RtFloat times[]);
RtVoid RiMotionEnd(void);
RtObjectHandle RiObjectBegin(void);
RtVoid RiObjectEnd(void);
RtVoid RiResourceBegin(void);
RtVoid RiResourceEnd(void);
RtVoid RiSolidBegin(RtToken operation);
RtVoid RiSolidEnd(void);
RtVoid RiTransformBegin(void);
RtVoid RiTransformEnd(void);
RtVoid RiWorldBegin(void);
RtVoid RiWorldEnd(void);

/* Camera, display and other options */
RtVoid RiCamera(RtToken name, ...);
RtVoid RiCameraV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiClipping(RtFloat hither, RtFloat yon);
RtVoid RiClippingPlane(RtFloat x, RtFloat y, RtFloat z, RtFloat nx, RtFloat ny, RtFloat nz);
RtVoid RiColorSamples(RtInt n, RtFloat nRGB[], RtFloat RGBn[]);
RtVoid RiCropWindow(RtFloat xmin, RtFloat xmax, RtFloat ymin, RtFloat ymax);
RtVoid RiDepthOfField(RtFloat fstop, RtFloat focallength, RtFloat focaldistance);
RtVoid RiDisplay(RtToken name, RtToken type, RtToken mode, ...);
RtVoid RiDisplayV(RtToken name, RtToken type, RtToken mode, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiDisplayChannel(RtToken channel, ...);
RtVoid RiDisplayChannelV(RtToken channel, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiExposure(RtFloat gain, RtFloat gamma);
RtVoid RiFormat(RtInt xres, RtInt yres, RtFloat pixelaspect);
RtVoid RiFrameAspectRatio(RtFloat ratio);
RtVoid RiHider(RtToken name, ...);
RtVoid RiHiderV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiImager(RtToken name, ...);
RtVoid RiImagerV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiOption(RtToken name, ...);
RtVoid RiOptionV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiPixelFilter(RtFilterFunc filter, RtFloat xwidth, RtFloat ywidth);
RtVoid RiPixelSamples(RtFloat x, RtFloat y);
RtVoid RiPixelVariance(RtFloat variance);
RtVoid RiProjection(RtToken name, ...);
RtVoid RiProjectionV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiQuantize(RtToken type, RtInt one, RtInt min, RtInt max, RtFloat dither);
RtVoid RiRelativeDetail(RtFloat factor);
RtVoid RiScreenWindow(RtFloat left, RtFloat right, RtFloat bottom, RtFloat top);
RtVoid RiShutter(RtFloat open, RtFloat close);

/* Attributes */
RtVoid RiAttribute(RtToken name, ...);
RtVoid RiAttributeV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiBasis(RtBasis ubasis, RtInt ustep, RtBasis vbasis, RtInt vstep);
RtVoid RiBound(RtBound bound);
RtVoid RiColor(RtColor color);
RtVoid RiDetail(RtBound bound);
RtVoid RiDetailRange(RtFloat minvisible, RtFloat lowertransition, RtFloat uppertransition, RtFloat maxvisible);
RtVoid RiGeometricApproximation(RtToken type, RtFloat value);
RtVoid RiGeometricRepresentation(RtToken type);
RtVoid RiMatte(RtBoolean on);
RtVoid RiOpacity(RtColor color);
RtVoid RiOrientation(RtToken orientation);
RtVoid RiResource(RtToken handle, RtToken type, ...);
RtVoid RiResourceV(RtToken handle, RtToken type, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiReverseOrientation(void);
RtVoid RiShadingInterpolation(RtToken type);
RtVoid RiShadingRate(RtFloat size);
RtVoid RiSides(RtInt sides);
RtVoid RiTextureCoordinates(RtFloat s1, RtFloat t1, RtFloat s2, RtFloat t2, RtFloat s3, RtFloat t3, RtFloat s4, RtFloat t4);
RtVoid RiTrimCurve(RtInt nloops, RtInt ncurves[], RtInt order[], RtFloat knot[], RtFloat min[], RtFloat max[], RtInt n[],
                   RtFloat u[], RtFloat v[], RtFloat w[]);

/* Shaders */
RtVoid RiAtmosphere(RtToken name, ...);
RtVoid RiAtmosphereV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiBxdf(RtToken name, RtToken handle, ...);
RtVoid RiBxdfV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiDisplace(RtToken name, RtToken handle, ...);
RtVoid RiDisplaceV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiDisplacement(RtToken name, ...);
RtVoid RiDisplacementV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiExterior(RtToken name, ...);
RtVoid RiExteriorV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiInterior(RtToken name, ...);
RtVoid RiInteriorV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiPattern(RtToken name, RtToken handle, ...);
RtVoid RiPatternV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiShader(RtToken name, RtToken handle, ...);
RtVoid RiShaderV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiSurface(RtToken name, ...);
RtVoid RiSurfaceV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiVPAtmosphere(RtToken name, ...);
RtVoid RiVPAtmosphereV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiVPInterior(RtToken name, ...);
RtVoid RiVPInteriorV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiVPSurface(RtToken name, ...);
RtVoid RiVPSurfaceV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);

/* Lights */
RtLightHandle RiAreaLightSource(RtToken name, ...);
RtLightHandle RiAreaLightSourceV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiEnableLightFilter(RtToken light, RtToken filter, RtBoolean on);
RtVoid RiIlluminate(RtLightHandle light, RtBoolean on);
RtVoid RiLight(RtToken name, RtToken handle, ...);
RtVoid RiLightV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiLightFilter(RtToken name, RtToken handle, ...);
RtVoid RiLightFilterV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtLightHandle RiLightSource(RtToken name, ...);
RtLightHandle RiLightSourceV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);

/* Transformations */
RtVoid RiConcatTransform(RtMatrix matrix);
RtVoid RiCoordSysTransform(RtToken name);
RtVoid RiCoordinateSystem(RtToken name);
RtVoid RiDeformation(RtToken name, ...);
RtVoid RiDeformationV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiIdentity(void);
RtVoid RiPerspective(RtFloat fov);
RtVoid RiRotate(RtFloat angle, RtFloat dx, RtFloat dy, RtFloat dz);
RtVoid RiScale(RtFloat sx, RtFloat sy, RtFloat sz);
RtVoid RiScopedCoordinateSystem(RtToken name);
RtVoid RiSkew(RtFloat angle, RtFloat dx1, RtFloat dy1, RtFloat dz1, RtFloat dx2, RtFloat dy2, RtFloat dz2);
RtVoid RiTransform(RtMatrix matrix);
RtVoid RiTranslate(RtFloat dx, RtFloat dy, RtFloat dz);

/* Primitives */
RtVoid RiBlobby(RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings, RtString strings[], ...);
RtVoid RiBlobbyV(RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings, RtString strings[],
                 RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiCone(RtFloat height, RtFloat radius, RtFloat thetamax, ...);
RtVoid RiConeV(RtFloat height, RtFloat radius, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiCurves(RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap, ...);
RtVoid RiCurvesV(RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiCylinder(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...);
RtVoid RiCylinderV(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiDisk(RtFloat height, RtFloat radius, RtFloat thetamax, ...);
RtVoid RiDiskV(RtFloat height, RtFloat radius, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiGeneralPolygon(RtInt nloops, RtInt nverts[], ...);
RtVoid RiGeneralPolygonV(RtInt nloops, RtInt nverts[], RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiGeometry(RtToken name, ...);
RtVoid RiGeometryV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiHierarchicalSubdivisionMesh(RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[],
                                     RtInt nargs[], RtInt intargs[], RtFloat floatargs[], RtToken stringargs[], ...);
RtVoid RiHierarchicalSubdivisionMeshV(RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[],
                                      RtInt nargs[], RtInt intargs[], RtFloat floatargs[], RtToken stringargs[], RtInt n,
                                      RtToken tokens[], RtPointer values[]);
RtVoid RiHyperboloid(RtPoint point1, RtPoint point2, RtFloat thetamax, ...);
RtVoid RiHyperboloidV(RtPoint point1, RtPoint point2, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiNuPatch(RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder, RtFloat vknot[],
                 RtFloat vmin, RtFloat vmax, ...);
RtVoid RiNuPatchV(RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder, RtFloat vknot[],
                  RtFloat vmin, RtFloat vmax, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiParaboloid(RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...);
RtVoid RiParaboloidV(RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiPatch(RtToken type, ...);
RtVoid RiPatchV(RtToken type, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiPatchMesh(RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap, ...);
RtVoid RiPatchMeshV(RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap, RtInt n, RtToken tokens[],
                    RtPointer values[]);
RtVoid RiPoints(RtInt npoints, ...);
RtVoid RiPointsV(RtInt npoints, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiPointsGeneralPolygons(RtInt npolys, RtInt nloops[], RtInt nverts[], RtInt verts[], ...);
RtVoid RiPointsGeneralPolygonsV(RtInt npolys, RtInt nloops[], RtInt nverts[], RtInt verts[], RtInt n, RtToken tokens[],
                                RtPointer values[]);
RtVoid RiPointsPolygons(RtInt npolys, RtInt nverts[], RtInt verts[], ...);
RtVoid RiPointsPolygonsV(RtInt npolys, RtInt nverts[], RtInt verts[], RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiPolygon(RtInt nvertices, ...);
RtVoid RiPolygonV(RtInt nvertices, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiProcedural(RtPointer data, RtBound bound, RtProcSubdivFunc subdivide, RtProcFreeFunc free);
RtVoid RiSphere(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, ...);
RtVoid RiSphereV(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiSubdivisionMesh(RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[], RtInt nargs[],
                         RtInt intargs[], RtFloat floatargs[], ...);
RtVoid RiSubdivisionMeshV(RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[], RtInt nargs[],
                          RtInt intargs[], RtFloat floatargs[], RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiTorus(RtFloat majorradius, RtFloat minorradius, RtFloat phimin, RtFloat phimax, RtFloat thetamax, ...);
RtVoid RiTorusV(RtFloat majorradius, RtFloat minorradius, RtFloat phimin, RtFloat phimax, RtFloat thetamax, RtInt n,
                RtToken tokens[], RtPointer values[]);
RtVoid RiVolume(RtToken type, RtBound bound, RtInt dimensions[], ...);
RtVoid RiVolumeV(RtToken type, RtBound bound, RtInt dimensions[], RtInt n, RtToken tokens[], RtPointer values[]);

/* Archives */
RtArchiveHandle RiArchiveBegin(RtToken name, ...);
RtArchiveHandle RiArchiveBeginV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiArchiveEnd(void);
RtVoid RiArchiveRecord(RtToken type, RtToken format, ...);
RtVoid RiReadArchive(RtToken name, RtArchiveCallback callback, ...);
RtVoid RiReadArchiveV(RtToken name, RtArchiveCallback callback, RtInt n, RtToken tokens[], RtPointer values[]);

/* Maps */
RtVoid RiMakeBrickMap(RtInt nclouds, RtString clouds[], RtToken brickmap, ...);
RtVoid RiMakeBrickMapV(RtInt nclouds, RtString clouds[], RtToken brickmap, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiMakeBump(RtToken picture, RtToken texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth,
                  RtFloat twidth, ...);
RtVoid RiMakeBumpV(RtToken picture, RtToken texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth,
                   RtFloat twidth, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiMakeCubeFaceEnvironment(RtToken px, RtToken nx, RtToken py, RtToken ny, RtToken pz, RtToken nz, RtToken texture,
                                 RtFloat fov, RtFilterFunc filter, RtFloat swidth, RtFloat twidth, ...);
RtVoid RiMakeCubeFaceEnvironmentV(RtToken px, RtToken nx, RtToken py, RtToken ny, RtToken pz, RtToken nz, RtToken texture,
                                  RtFloat fov, RtFilterFunc filter, RtFloat swidth, RtFloat twidth, RtInt n, RtToken tokens[],
                                  RtPointer values[]);
RtVoid RiMakeLatLongEnvironment(RtToken picture, RtToken texture, RtFilterFunc filter, RtFloat swidth, RtFloat twidth, ...);
RtVoid RiMakeLatLongEnvironmentV(RtToken picture, RtToken texture, RtFilterFunc filter, RtFloat swidth, RtFloat twidth, RtInt n,
                                 RtToken tokens[], RtPointer values[]);
RtVoid RiMakeOcclusion(RtInt npictures, RtString pictures[], RtToken shadow, ...);
RtVoid RiMakeOcclusionV(RtInt npictures, RtString pictures[], RtToken shadow, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiMakeShadow(RtToken picture, RtToken shadow, ...);
RtVoid RiMakeShadowV(RtToken picture, RtToken shadow, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiMakeTexture(RtToken picture, RtToken texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth,
                     RtFloat twidth, ...);
RtVoid RiMakeTextureV(RtToken picture, RtToken texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth,
                      RtFloat twidth, RtInt n, RtToken tokens[], RtPointer values[]);

/* Other */
RtToken RiDeclare(RtToken name, RtToken declaration);
RtVoid RiDisplayFilter(RtToken name, RtToken handle, ...);
RtVoid RiDisplayFilterV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiIntegrator(RtToken name, RtToken handle, ...);
RtVoid RiIntegratorV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiObjectInstance(RtObjectHandle handle);
RtVoid RiPixelSampleImager(RtToken name, ...);
RtVoid RiPixelSampleImagerV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiSampleFilter(RtToken name, RtToken handle, ...);
RtVoid RiSampleFilterV(RtToken name, RtToken handle, RtInt n, RtToken tokens[], RtPointer values[]);
RtVoid RiSystem(RtToken command);
/* End of the generated prototypes. */
#undef RI_CHARS

#ifdef __cplusplus
}
#endif
#endif
