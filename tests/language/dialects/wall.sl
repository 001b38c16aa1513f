/* bricks in the filtered style, every size a macro */
#define BRICKWIDTH        0.25
#define BRICKHEIGHT       0.08
#define MORTARTHICKNESS   0.01
#define BMWIDTH           (BRICKWIDTH+MORTARTHICKNESS)
#define BMHEIGHT          (BRICKHEIGHT+MORTARTHICKNESS)
#define MWF               (MORTARTHICKNESS*0.5/BMWIDTH)
#define MHF               (MORTARTHICKNESS*0.5/BMHEIGHT)
#define boxstep(a,b,x) (clamp(((x)-(a))/((b)-(a)),0,1))
#define MINFILTERWIDTH  1.0e-7
surface wall(
    uniform float Ka = 1;
    uniform float Kd = 1;
    uniform color Cbrick = color (0.5, 0.15, 0.14);
    uniform color Cmortar = color (0.5, 0.5, 0.5);
    )
{
    color Ct;
    point Nf;
    float ss, tt, sbrick, tbrick, w, h;
    float scoord = s;
    float tcoord = t;
    float swidth, twidth;

    Nf = normalize(faceforward(N, I));
    ss = scoord / BMWIDTH;
    tt = tcoord / BMHEIGHT;
    if (mod(tt*0.5,1) > 0.5)
        ss += 0.5;  /* shift alternate rows */
    swidth = max(abs(Du(ss)*du) + abs(Dv(ss)*dv), MINFILTERWIDTH);
    twidth = max(abs(Du(tt)*du) + abs(Dv(tt)*dv), MINFILTERWIDTH);
    sbrick = floor(ss); /* which brick? */
    tbrick = floor(tt);
    ss -= sbrick;
    tt -= tbrick;
    w = boxstep(MWF-swidth,MWF,ss) - boxstep(1-MWF-swidth,1-MWF,ss);
    h = boxstep(MHF-twidth,MHF,tt) - boxstep(1-MHF-twidth,1-MHF,tt);
    Ct = mix(Cmortar, Cbrick, w*h);
    Oi = Os;
    Ci = Os * Ct * (Ka * ambient() + Kd * diffuse(Nf));
}
