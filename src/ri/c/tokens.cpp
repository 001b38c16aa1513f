// ri.h: the standard tokens as variables, as in the specification's binding (appendix A). Programs that include ri.h have
// constants; those that load the library at run time look these up by name.
#include <ri.h>

#undef RI_A
#undef RI_ABORT
#undef RI_AMBIENTLIGHT
#undef RI_AMPLITUDE
#undef RI_AZ
#undef RI_BACKGROUND
#undef RI_BEAMDISTRIBUTION
#undef RI_BICUBIC
#undef RI_BILINEAR
#undef RI_BLACK
#undef RI_BUMPY
#undef RI_CAMERA
#undef RI_CI
#undef RI_CLAMP
#undef RI_COMMENT
#undef RI_CONEANGLE
#undef RI_CONEDELTAANGLE
#undef RI_CONSTANT
#undef RI_CONSTANTWIDTH
#undef RI_CS
#undef RI_CUBIC
#undef RI_CURRENT
#undef RI_DEPTHCUE
#undef RI_DIFFERENCE
#undef RI_DISTANCE
#undef RI_DISTANTLIGHT
#undef RI_EYESPLITS
#undef RI_FACEVARYING
#undef RI_FILE
#undef RI_FLATNESS
#undef RI_FOG
#undef RI_FOV
#undef RI_FRAMEBUFFER
#undef RI_FROM
#undef RI_HANDLER
#undef RI_HANDLEID
#undef RI_HIDDEN
#undef RI_IDENTIFIER
#undef RI_IGNORE
#undef RI_INSIDE
#undef RI_INTENSITY
#undef RI_INTERSECTION
#undef RI_KA
#undef RI_KD
#undef RI_KM
#undef RI_KR
#undef RI_KS
#undef RI_LH
#undef RI_LIGHTCOLOR
#undef RI_LINEAR
#undef RI_MATTE
#undef RI_MAXDISTANCE
#undef RI_METAL
#undef RI_MINDISTANCE
#undef RI_N
#undef RI_NAME
#undef RI_NDC
#undef RI_NG
#undef RI_NONPERIODIC
#undef RI_NP
#undef RI_OBJECT
#undef RI_OI
#undef RI_ORIGIN
#undef RI_ORTHOGRAPHIC
#undef RI_OS
#undef RI_OUTSIDE
#undef RI_P
#undef RI_PAINT
#undef RI_PAINTEDPLASTIC
#undef RI_PERIODIC
#undef RI_PERSPECTIVE
#undef RI_PLASTIC
#undef RI_POINTLIGHT
#undef RI_PRIMITIVE
#undef RI_PRINT
#undef RI_PW
#undef RI_PZ
#undef RI_RASTER
#undef RI_RGB
#undef RI_RGBA
#undef RI_RGBAI
#undef RI_RGBAZ
#undef RI_RGBI
#undef RI_RGBZ
#undef RI_RGBZI
#undef RI_RH
#undef RI_ROUGHNESS
#undef RI_S
#undef RI_SCREEN
#undef RI_SHADER
#undef RI_SHADINGGROUP
#undef RI_SHINYMETAL
#undef RI_SMOOTH
#undef RI_SPECULARCOLOR
#undef RI_SPOTLIGHT
#undef RI_ST
#undef RI_STRUCTURE
#undef RI_T
#undef RI_TEXTURENAME
#undef RI_THRESHOLD
#undef RI_TO
#undef RI_UNIFORM
#undef RI_UNION
#undef RI_VARYING
#undef RI_VERBATIM
#undef RI_VERTEX
#undef RI_WIDTH
#undef RI_WORLD
#undef RI_Z

extern "C" {

RtToken RI_A = (RtToken) "a";
RtToken RI_ABORT = (RtToken) "abort";
RtToken RI_AMBIENTLIGHT = (RtToken) "ambientlight";
RtToken RI_AMPLITUDE = (RtToken) "amplitude";
RtToken RI_AZ = (RtToken) "az";
RtToken RI_BACKGROUND = (RtToken) "background";
RtToken RI_BEAMDISTRIBUTION = (RtToken) "beamdistribution";
RtToken RI_BICUBIC = (RtToken) "bicubic";
RtToken RI_BILINEAR = (RtToken) "bilinear";
RtToken RI_BLACK = (RtToken) "black";
RtToken RI_BUMPY = (RtToken) "bumpy";
RtToken RI_CAMERA = (RtToken) "camera";
RtToken RI_CI = (RtToken) "Ci";
RtToken RI_CLAMP = (RtToken) "clamp";
RtToken RI_COMMENT = (RtToken) "comment";
RtToken RI_CONEANGLE = (RtToken) "coneangle";
RtToken RI_CONEDELTAANGLE = (RtToken) "conedeltaangle";
RtToken RI_CONSTANT = (RtToken) "constant";
RtToken RI_CONSTANTWIDTH = (RtToken) "constantwidth";
RtToken RI_CS = (RtToken) "Cs";
RtToken RI_CUBIC = (RtToken) "cubic";
RtToken RI_CURRENT = (RtToken) "current";
RtToken RI_DEPTHCUE = (RtToken) "depthcue";
RtToken RI_DIFFERENCE = (RtToken) "difference";
RtToken RI_DISTANCE = (RtToken) "distance";
RtToken RI_DISTANTLIGHT = (RtToken) "distantlight";
RtToken RI_EYESPLITS = (RtToken) "eyesplits";
RtToken RI_FACEVARYING = (RtToken) "facevarying";
RtToken RI_FILE = (RtToken) "file";
RtToken RI_FLATNESS = (RtToken) "flatness";
RtToken RI_FOG = (RtToken) "fog";
RtToken RI_FOV = (RtToken) "fov";
RtToken RI_FRAMEBUFFER = (RtToken) "framebuffer";
RtToken RI_FROM = (RtToken) "from";
RtToken RI_HANDLER = (RtToken) "handler";
RtToken RI_HANDLEID = (RtToken) "__handleid";
RtToken RI_HIDDEN = (RtToken) "hidden";
RtToken RI_IDENTIFIER = (RtToken) "identifier";
RtToken RI_IGNORE = (RtToken) "ignore";
RtToken RI_INSIDE = (RtToken) "inside";
RtToken RI_INTENSITY = (RtToken) "intensity";
RtToken RI_INTERSECTION = (RtToken) "intersection";
RtToken RI_KA = (RtToken) "Ka";
RtToken RI_KD = (RtToken) "Kd";
RtToken RI_KM = (RtToken) "Km";
RtToken RI_KR = (RtToken) "Kr";
RtToken RI_KS = (RtToken) "Ks";
RtToken RI_LH = (RtToken) "lh";
RtToken RI_LIGHTCOLOR = (RtToken) "lightcolor";
RtToken RI_LINEAR = (RtToken) "linear";
RtToken RI_MATTE = (RtToken) "matte";
RtToken RI_MAXDISTANCE = (RtToken) "maxdistance";
RtToken RI_METAL = (RtToken) "metal";
RtToken RI_MINDISTANCE = (RtToken) "mindistance";
RtToken RI_N = (RtToken) "N";
RtToken RI_NAME = (RtToken) "name";
RtToken RI_NDC = (RtToken) "NDC";
RtToken RI_NG = (RtToken) "Ng";
RtToken RI_NONPERIODIC = (RtToken) "nonperiodic";
RtToken RI_NP = (RtToken) "Np";
RtToken RI_OBJECT = (RtToken) "object";
RtToken RI_OI = (RtToken) "Oi";
RtToken RI_ORIGIN = (RtToken) "origin";
RtToken RI_ORTHOGRAPHIC = (RtToken) "orthographic";
RtToken RI_OS = (RtToken) "Os";
RtToken RI_OUTSIDE = (RtToken) "outside";
RtToken RI_P = (RtToken) "P";
RtToken RI_PAINT = (RtToken) "paint";
RtToken RI_PAINTEDPLASTIC = (RtToken) "paintedplastic";
RtToken RI_PERIODIC = (RtToken) "periodic";
RtToken RI_PERSPECTIVE = (RtToken) "perspective";
RtToken RI_PLASTIC = (RtToken) "plastic";
RtToken RI_POINTLIGHT = (RtToken) "pointlight";
RtToken RI_PRIMITIVE = (RtToken) "primitive";
RtToken RI_PRINT = (RtToken) "print";
RtToken RI_PW = (RtToken) "Pw";
RtToken RI_PZ = (RtToken) "Pz";
RtToken RI_RASTER = (RtToken) "raster";
RtToken RI_RGB = (RtToken) "rgb";
RtToken RI_RGBA = (RtToken) "rgba";
RtToken RI_RGBAI = (RtToken) "rgbai";
RtToken RI_RGBAZ = (RtToken) "rgbaz";
RtToken RI_RGBI = (RtToken) "rgbi";
RtToken RI_RGBZ = (RtToken) "rgbz";
RtToken RI_RGBZI = (RtToken) "rgbzi";
RtToken RI_RH = (RtToken) "rh";
RtToken RI_ROUGHNESS = (RtToken) "roughness";
RtToken RI_S = (RtToken) "s";
RtToken RI_SCREEN = (RtToken) "screen";
RtToken RI_SHADER = (RtToken) "shader";
RtToken RI_SHADINGGROUP = (RtToken) "shadinggroup";
RtToken RI_SHINYMETAL = (RtToken) "shinymetal";
RtToken RI_SMOOTH = (RtToken) "smooth";
RtToken RI_SPECULARCOLOR = (RtToken) "specularcolor";
RtToken RI_SPOTLIGHT = (RtToken) "spotlight";
RtToken RI_ST = (RtToken) "st";
RtToken RI_STRUCTURE = (RtToken) "structure";
RtToken RI_T = (RtToken) "t";
RtToken RI_TEXTURENAME = (RtToken) "texturename";
RtToken RI_THRESHOLD = (RtToken) "threshold";
RtToken RI_TO = (RtToken) "to";
RtToken RI_UNIFORM = (RtToken) "uniform";
RtToken RI_UNION = (RtToken) "union";
RtToken RI_VARYING = (RtToken) "varying";
RtToken RI_VERBATIM = (RtToken) "verbatim";
RtToken RI_VERTEX = (RtToken) "vertex";
RtToken RI_WIDTH = (RtToken) "width";
RtToken RI_WORLD = (RtToken) "world";
RtToken RI_Z = (RtToken) "z";

} // extern "C"
