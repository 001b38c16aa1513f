/* macro heavy, with token pasting and line joins */
#define REP(v,f) mod((v)*(f),1)
#define ONE(i) c##i = noise(s*(i+1)); \
               total += c##i;
#define PULSE(a,b,x) ( step((a),(x)) \
                     - step((b),(x)) )
#define FILTERWIDTH(x) max(abs(Du(x)*du)+abs(Dv(x)*dv), 1.0e-6)
surface weave(float freq = 12; color warp = color(.8,.2,.1), weft = color (.1,.2,.8);)
{
    float c0, c1, c2, total = 0;
    float ss = REP(s,freq), tt = REP(t,freq);
    float col = floor(s*freq), row = floor(t*freq);
    float even = mod(col+row,2);
    ONE(0) ONE(1) ONE(2)
    float w = FILTERWIDTH(s*freq);
    float over = PULSE(.1,.9,even>.5?ss:tt);
    color Ct = mix(warp, weft, even) * (.7 + .3*over) * (1 - .1*total/3);
    Ct *= 1 - clamp(w,0,1)*.5;
    Oi = Os; Ci = Os*Ct*diffuse(faceforward(normalize(N),I));
}
