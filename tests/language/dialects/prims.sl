surface
showprim(varying float temp=0; varying color hue = color(0,1,0); varying point rest = point(0,0,0); float vertex_ = 0; uniform float mode = 0;
         varying normal refn = normal (0,0,1); float knots[4] = {0,.3,.6,1}; string names[3]={"a","b","c"}; matrix basis = 1;)
{
    uniform float i;
    float acc = vertex_;
    for (i=0;i<4;i+=1) acc += knots[i];
    for (i=0;i<3;i+=1) if (names[i]=="b") acc += 1;
    color c = hue*temp + color(rest[0],ycomp(rest),rest[2]);
    if (mode==1) c = color(ycomp(refn));
    else if (mode==2) c = acc;
    else c *= determinant(basis);
    Ci = c; Oi = Os; Ci *= Oi;
}
