#define DEG(x) ((x)*PI/180)
light slideprojector_old (
    float fieldofview=PI/32; point from = point "shader" (8,-4,10), to = point "shader" (0,0,0), up = point "eye" (0,1,0);
    string slidename = "", shadowname = ""; float intensity=1; uniform float aspect = 4/3; )
{
    uniform vector relT; vector relU, relV, relPs; float Pt, Ps_, spread = 1/tan(fieldofview/2), sloc, tloc;
    relT = normalize(to - from);
    relU = relT ^ up;
    relV = normalize(relT ^ relU);
    relU = relV ^ relT;
    illuminate(from, relT, atan(1.415/spread)) {
        relPs = Ps - from;
        Pt = relPs.relT;
        sloc = .5 + spread*(relPs.relU)/Pt/2*aspect;
        tloc = .5 + spread*(relPs.relV)/Pt/2;
        if (sloc > 0 && sloc < 1 && tloc > 0 && tloc < 1) {
            if (slidename != "") Cl = intensity * color texture(slidename, sloc, tloc); else Cl = intensity;
            if (shadowname != "") Cl *= 1 - shadow(shadowname, Ps);
        } else Cl = 0;
    }
}
