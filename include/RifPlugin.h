/* Filters of requests, in C++: libraries that `alpenglow rib --filter NAME.so` loads (docs/rib-tool.md). The names are those of
 * PRMan's interface of this name, so that a filter for it is compiled again and serves here; binaries do not fit.
 *
 *     #include <RifPlugin.h>
 *
 *     class Bigger : public RifPlugin {
 *     public:
 *         Bigger() {
 *             filter_.ClientData = this;
 *             filter_.Filtering = RifFilter::k_Continue;
 *             filter_.SphereV = [](RtFloat r, RtFloat lo, RtFloat hi, RtFloat t, RtInt n, RtToken tokens[], RtPointer values[]) {
 *                 RiSphereV(2 * r, 2 * lo, 2 * hi, t, n, tokens, values);
 *             };
 *         }
 *         RifFilter& GetFilter() override { return filter_; }
 *
 *     private:
 *         RifFilter filter_;
 *     };
 *     extern "C" RifPlugin* RifPluginManufacture(int, char**) { return new Bigger; }
 *
 *     c++ -std=c++17 -shared -fPIC $(pkg-config --cflags alpenglow) bigger.cpp -o bigger.so
 *
 * A function of the filter stands in the place of its request: what it calls of ri.h goes on to the next filter, or into the
 * result, and what it does not call is left out. Nothing is linked to: the program has the functions of ri.h. */
#ifndef ALPENGLOW_RIFPLUGIN_H
#define ALPENGLOW_RIFPLUGIN_H

#include "ri.h"

/* What a filter does. A null pointer: `Filtering` decides. The functions have the arguments of those of ri.h with the same names;
 * they are valid during the call. Lights and what they shine on: LightSourceV gets "string __handleid" with the name that the
 * light has in the scene among its parameters, which the filter passes on for the names to stay. Objects, archives that are
 * begun, procedurals, declarations, comments and requests that this program does not know pass by all filters. */
struct RifFilter {
    enum { k_Continue, k_Terminate };
    void* ClientData = nullptr; /* the filter's own */
    int Filtering = k_Continue; /* requests without a function: k_Continue passes them on, k_Terminate leaves them out */
    RtVoid (*FrameBegin)(RtInt number) = nullptr;
    RtVoid (*FrameEnd)(void) = nullptr;
    RtVoid (*WorldBegin)(void) = nullptr;
    RtVoid (*WorldEnd)(void) = nullptr;
    RtVoid (*AttributeBegin)(void) = nullptr;
    RtVoid (*AttributeEnd)(void) = nullptr;
    RtVoid (*TransformBegin)(void) = nullptr;
    RtVoid (*TransformEnd)(void) = nullptr;
    RtVoid (*SolidBegin)(RtToken operation) = nullptr;
    RtVoid (*SolidEnd)(void) = nullptr;
    RtVoid (*ObjectEnd)(void) = nullptr;
    RtVoid (*MotionBeginV)(RtInt n, RtFloat times[]) = nullptr;
    RtVoid (*MotionEnd)(void) = nullptr;
    RtVoid (*ResourceBegin)(void) = nullptr;
    RtVoid (*ResourceEnd)(void) = nullptr;
    RtVoid (*ResourceV)(RtToken handle, RtToken type, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*IfBeginV)(RtString expression, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*ElseIfV)(RtString expression, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*Else)(void) = nullptr;
    RtVoid (*IfEnd)(void) = nullptr;
    RtVoid (*Format)(RtInt xres, RtInt yres, RtFloat pixelaspect) = nullptr;
    RtVoid (*FrameAspectRatio)(RtFloat ratio) = nullptr;
    RtVoid (*ScreenWindow)(RtFloat left, RtFloat right, RtFloat bottom, RtFloat top) = nullptr;
    RtVoid (*CropWindow)(RtFloat xmin, RtFloat xmax, RtFloat ymin, RtFloat ymax) = nullptr;
    RtVoid (*ProjectionV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*Clipping)(RtFloat hither, RtFloat yon) = nullptr;
    RtVoid (*ClippingPlane)(RtFloat x, RtFloat y, RtFloat z, RtFloat nx, RtFloat ny, RtFloat nz) = nullptr;
    RtVoid (*DepthOfField)(RtFloat fstop, RtFloat focallength, RtFloat focaldistance) = nullptr;
    RtVoid (*Shutter)(RtFloat open, RtFloat close) = nullptr;
    RtVoid (*PixelVariance)(RtFloat variance) = nullptr;
    RtVoid (*PixelSamples)(RtFloat x, RtFloat y) = nullptr;
    RtVoid (*PixelFilter)(RtFilterFunc filter, RtFloat xwidth, RtFloat ywidth) = nullptr;
    RtVoid (*Exposure)(RtFloat gain, RtFloat gamma) = nullptr;
    RtVoid (*ImagerV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*Quantize)(RtToken type, RtInt one, RtInt min, RtInt max, RtFloat dither) = nullptr;
    RtVoid (*DisplayV)(RtString name, RtToken type, RtToken mode, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*DisplayChannelV)(RtString channel, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*HiderV)(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*ColorSamples)(RtInt n, RtFloat nRGB[], RtFloat RGBn[]) = nullptr;
    RtVoid (*RelativeDetail)(RtFloat factor) = nullptr;
    RtVoid (*OptionV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*CameraV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*Color)(RtColor color) = nullptr;
    RtVoid (*Opacity)(RtColor color) = nullptr;
    RtVoid (*TextureCoordinates)(RtFloat s1, RtFloat t1, RtFloat s2, RtFloat t2, RtFloat s3, RtFloat t3, RtFloat s4,
                                 RtFloat t4) = nullptr;
    RtVoid (*ShadingRate)(RtFloat size) = nullptr;
    RtVoid (*ShadingInterpolation)(RtToken type) = nullptr;
    RtVoid (*Matte)(RtBoolean on) = nullptr;
    RtVoid (*Bound)(RtBound bound) = nullptr;
    RtVoid (*Detail)(RtBound bound) = nullptr;
    RtVoid (*DetailRange)(RtFloat minvisible, RtFloat lowertransition, RtFloat uppertransition, RtFloat maxvisible) = nullptr;
    RtVoid (*GeometricApproximation)(RtToken type, RtFloat value) = nullptr;
    RtVoid (*GeometricRepresentation)(RtToken type) = nullptr;
    RtVoid (*Orientation)(RtToken orientation) = nullptr;
    RtVoid (*ReverseOrientation)(void) = nullptr;
    RtVoid (*Sides)(RtInt sides) = nullptr;
    RtVoid (*Basis)(RtBasis ubasis, RtInt ustep, RtBasis vbasis, RtInt vstep) = nullptr;
    RtVoid (*TrimCurve)(RtInt nloops, RtInt ncurves[], RtInt order[], RtFloat knot[], RtFloat min[], RtFloat max[], RtInt n[],
                        RtFloat u[], RtFloat v[], RtFloat w[]) = nullptr;
    RtVoid (*AttributeV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*SurfaceV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*DisplacementV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*AtmosphereV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*InteriorV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*ExteriorV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*ShaderV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtLightHandle (*LightSourceV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtLightHandle (*AreaLightSourceV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*Illuminate)(RtLightHandle light, RtBoolean on) = nullptr;
    RtVoid (*BxdfV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*PatternV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*DisplaceV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*LightV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*LightFilterV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*EnableLightFilter)(RtString light, RtString filter, RtBoolean on) = nullptr;
    RtVoid (*IntegratorV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*DisplayFilterV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*SampleFilterV)(RtString name, RtString handle, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*PixelSampleImagerV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*VPAtmosphereV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*VPInteriorV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*VPSurfaceV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*Identity)(void) = nullptr;
    RtVoid (*Transform)(RtMatrix matrix) = nullptr;
    RtVoid (*ConcatTransform)(RtMatrix matrix) = nullptr;
    RtVoid (*Perspective)(RtFloat fov) = nullptr;
    RtVoid (*Translate)(RtFloat dx, RtFloat dy, RtFloat dz) = nullptr;
    RtVoid (*Rotate)(RtFloat angle, RtFloat dx, RtFloat dy, RtFloat dz) = nullptr;
    RtVoid (*Scale)(RtFloat sx, RtFloat sy, RtFloat sz) = nullptr;
    RtVoid (*Skew)(RtFloat angle, RtFloat dx1, RtFloat dy1, RtFloat dz1, RtFloat dx2, RtFloat dy2, RtFloat dz2) = nullptr;
    RtVoid (*DeformationV)(RtString name, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*CoordinateSystem)(RtToken space) = nullptr;
    RtVoid (*ScopedCoordinateSystem)(RtToken space) = nullptr;
    RtVoid (*CoordSysTransform)(RtToken space) = nullptr;
    RtVoid (*PolygonV)(RtInt nvertices, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*GeneralPolygonV)(RtInt nloops, RtInt nverts[], RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*PointsPolygonsV)(RtInt npolys, RtInt nverts[], RtInt verts[], RtInt n, RtToken tokens[],
                              RtPointer values[]) = nullptr;
    RtVoid (*PointsGeneralPolygonsV)(RtInt npolys, RtInt nloops[], RtInt nverts[], RtInt verts[], RtInt n, RtToken tokens[],
                                     RtPointer values[]) = nullptr;
    RtVoid (*PatchV)(RtToken type, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*PatchMeshV)(RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap, RtInt n, RtToken tokens[],
                         RtPointer values[]) = nullptr;
    RtVoid (*NuPatchV)(RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder,
                       RtFloat vknot[], RtFloat vmin, RtFloat vmax, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*SubdivisionMeshV)(RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags, RtToken tags[],
                               RtInt nargs[], RtInt intargs[], RtFloat floatargs[], RtInt n, RtToken tokens[],
                               RtPointer values[]) = nullptr;
    RtVoid (*HierarchicalSubdivisionMeshV)(RtToken scheme, RtInt nfaces, RtInt nverts[], RtInt verts[], RtInt ntags,
                                           RtToken tags[], RtInt nargs[], RtInt intargs[], RtFloat floatargs[],
                                           RtToken stringargs[], RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*SphereV)(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[],
                      RtPointer values[]) = nullptr;
    RtVoid (*ConeV)(RtFloat height, RtFloat radius, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*CylinderV)(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[],
                        RtPointer values[]) = nullptr;
    RtVoid (*HyperboloidV)(RtPoint point1, RtPoint point2, RtFloat thetamax, RtInt n, RtToken tokens[],
                           RtPointer values[]) = nullptr;
    RtVoid (*ParaboloidV)(RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[],
                          RtPointer values[]) = nullptr;
    RtVoid (*DiskV)(RtFloat height, RtFloat radius, RtFloat thetamax, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*TorusV)(RtFloat majorradius, RtFloat minorradius, RtFloat phimin, RtFloat phimax, RtFloat thetamax, RtInt n,
                     RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*PointsV)(RtInt npoints, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*CurvesV)(RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap, RtInt n, RtToken tokens[],
                      RtPointer values[]) = nullptr;
    RtVoid (*BlobbyV)(RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings, RtString strings[],
                      RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*GeometryV)(RtToken type, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*VolumeV)(RtToken type, RtBound bound, RtInt dimensions[], RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*ReadArchiveV)(RtString name, RtArchiveCallback callback, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*MakeTextureV)(RtString picture, RtString texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth,
                           RtFloat twidth, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*MakeBumpV)(RtString picture, RtString texture, RtToken swrap, RtToken twrap, RtFilterFunc filter, RtFloat swidth,
                        RtFloat twidth, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*MakeLatLongEnvironmentV)(RtString picture, RtString texture, RtFilterFunc filter, RtFloat swidth, RtFloat twidth,
                                      RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*MakeShadowV)(RtString picture, RtString shadow, RtInt n, RtToken tokens[], RtPointer values[]) = nullptr;
    RtVoid (*MakeBrickMapV)(RtInt nclouds, RtString clouds[], RtString brickmap, RtInt n, RtToken tokens[],
                            RtPointer values[]) = nullptr;
    RtVoid (*MakeOcclusionV)(RtInt npictures, RtString pictures[], RtString shadow, RtInt n, RtToken tokens[],
                             RtPointer values[]) = nullptr;
};

/* Made by RifPluginManufacture, deleted when the stream is over. */
class RifPlugin {
public:
    virtual ~RifPlugin() = default;
    /* Asked once, when the filter has been made. Must stay where it is. */
    virtual RifFilter& GetFilter() = 0;
};

extern "C" {
/* Defined by the library. The arguments are those behind its name on the command line (-rifargs); null: it refuses them. */
RifPlugin* RifPluginManufacture(int argc, char** argv);
/* Defined by the program: the filter whose function runs in this thread; null outside. */
RifPlugin* RifGetCurrentPlugin(void);
}

#endif
