/* PxrProjector: where a point lies in a picture that is projected, of RIS, in the space coordsys (object when not given). projection 0: a camera at the origin that looks along +z, of focalLength mm and a film of apertureX by apertureY
   inches, seen by resolutionX by resolutionY pixels as filmFit says (0 fills them, 1 and 2 its width or height fit, 3 shows all); 1: a sphere, 2: a cylinder about y from -1 to 1; 3: the square from -1 to 1 along +z. The picture
   is then turned by angle degrees, scaled and moved as by PxrManifold2D; invertT 1 lets t run downward. use 1 and 2 take __Pref and __Nref, __WPref and __WNref in place of P and N.
   resultMask: 0 outside of the picture (clampTo 1) and of the clipping planes of a camera, with frontOnly where the surface is turned away, softly over frontFalloff (of the cosine), and with traceOcclusion where something
   stands between it and the projector, or nearer than traceMaxDistance before it. With that a material waits for rays. */
#include "rispattern.h"
surface PxrProjector(float projection = 0; string coordsys = ""; float use = 0, frontOnly = 1; varying float frontFalloff = 0; float traceOcclusion = 0, traceMaxDistance = 10000; string traceSet = "";
                     float resolutionX = 2048, resolutionY = 1556, focalLength = 50, apertureX = .98, apertureY = .735, nearClipPlane = .01, farClipPlane = 10000, filmFit = 0, clampTo = 1;
                     varying float angle = 0, scaleS = 1, scaleT = 1, offsetS = 0, offsetT = 0; float invertT = 1, verbose = 0; RIS_RESULT; output varying float resultS = 0, resultT = 0, resultMask = 0) {
    uniform string space = (coordsys == "") ? "object" : coordsys;
    point q = transform(space, P), rest = P;
    normal n = normalize(ntransform(space, N)), turned = N;
    uniform string from = (use == 2) ? "world" : "object";
    if (use != 0 && getvar(null, (use == 2) ? "__WPref" : "__Pref", rest) == 1) q = transform(from, space, rest);
    if (use != 0 && getvar(null, (use == 2) ? "__WNref" : "__Nref", turned) == 1) n = normalize(ntransform(from, space, turned));
    float x = xcomp(q), y = ycomp(q), z = zcomp(q), inside = 1;
    vector away = vector(0, 0, -1); /* from the surface toward the projector */
    if (projection == 0) {
        uniform float film = apertureX / max(apertureY, 1e-6), device = resolutionX / max(resolutionY, 1);
        uniform float wide = (filmFit == 1) ? 1 : (filmFit == 2) ? 0 : (filmFit == 3) ? ((device > film) ? 0 : 1) : ((device > film) ? 1 : 0);
        uniform float across = 25.4 * ((wide == 1) ? apertureX : apertureY * device), upward = 25.4 * ((wide == 1) ? apertureX / max(device, 1e-6) : apertureY);
        float depth = max(z, 1e-6);
        x = x / depth * focalLength / max(across, 1e-6);
        y = y / depth * focalLength / max(upward, 1e-6);
        inside = (z >= nearClipPlane && z <= farClipPlane) ? 1 : 0;
        away = normalize(-vector q);
    } else if (projection == 3) {
        x /= 2;
        y /= 2;
    } else {
        float r = (projection == 1) ? max(length(vector q), 1e-12) : max(sqrt(x * x + z * z), 1e-12);
        away = (projection == 1) ? vector q / r : vector(x, 0, z) / r;
        x = atan(x, z) / (2 * PI);
        y = (projection == 1) ? asin(clamp(y / r, -1, 1)) / PI : y / 2;
    }
    float c = cos(radians(angle)), d = sin(radians(angle));
    float a = x + .5, b = y + .5;
    resultS = scaleS * (c * a - d * b) + offsetS;
    resultT = scaleT * (d * a + c * b) + offsetT;
    if (clampTo != 0 && (resultS < 0 || resultS > 1 || resultT < 0 || resultT > 1)) inside = 0;
    if (invertT != 0) resultT = 1 - resultT;
    result_Q = point(resultS, resultT, 0);
    result_Qradius = .5 * (abs(Du(resultS) * du) + abs(Dv(resultS) * dv) + abs(Du(resultT) * du) + abs(Dv(resultT) * dv));
    resultMask = inside;
    if (frontOnly != 0) {
        float facing = n . away;
        resultMask *= (frontFalloff > 0) ? smoothstep(0, frontFalloff, facing) : (facing > 0) ? 1 : 0;
    }
    if (traceOcclusion != 0) {
        vector back = normalize(vtransform(space, "current", away));
        point eye = transform(space, "current", point(0, 0, 0)), end = P + traceMaxDistance * back;
        if (projection == 0 && distance(P, eye) < traceMaxDistance) end = eye;
        color through = transmission(P, end, "subset", traceSet);
        resultMask *= (comp(through, 0) + comp(through, 1) + comp(through, 2)) / 3;
    }
}
