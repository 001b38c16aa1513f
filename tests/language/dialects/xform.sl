/* warns: not-output unknown-name */
surface xforms(string a = "world"; matrix mm = (1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1); matrix m2 = matrix "shader" 1; matrix m3 = 2; matrix m4=matrix "world" (1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1);
   point centre = point "object" (0, 0, 0); vector up = vector "camera" (0, 1, 0); normal nn = normal "world" 1; point p0 = 0; color hue = color "hls" (.5,.5,.5), xyz = color "xyz" (.3,.3,.3);)
{
    point A = transform(a, "current", centre);
    vector B = vtransform("current", a, up);
    normal C = ntransform(a, nn);
    point D = transform(mm, A);
    matrix M = mm * m2 / m3;
    point sp = point a (1, 2, 3);
    vector vv = vector "world" (xcomp(B), ycomp(B), 0);
    point q = rotate(P, radians(30), centre, centre + up);
    setxcomp(q, 1); setcomp(hue, 1, .5); setcomp(M, 0, 0, 3);
    float det = determinant(M) + comp(M, 1, 1);
    M = rotate(M, 1, vector(0, 1, 0)); M = translate(M, point(1, 0, 0)); M = scale(M, point(2, 2, 2));
    color c = ctransform("hsv", hue) + ctransform("rgb", "yiq", xyz);
    point NDC = transform("NDC", P), ras = transform("raster", P), scr = transform("screen", P);
    float dd = depth(P), pl = ptlined(P, p0, centre);
    if (A != D || B == vv) c += 1;
    Ci = c * det + color(xcomp(NDC), ycomp(ras), zcomp(scr)) * dd * pl + length(q - sp) * (C . B); Oi = 1;
}
matrix mm_() { return 1; }
