imager
vignette_and_grain( float amount=.3, grain=.02; color bgcolor=color(0,0,0); )
{
    float xres[3]; float x, y, d;
    option("Format", xres);
    x = xcomp(P)/max(xres[0],1) - .5;
    y = ycomp(P)/max(xres[1],1) - .5;
    d = 1 - amount*(x*x+y*y)*2;
    Ci = (Ci + (1-alpha)*bgcolor) * d + grain*(float cellnoise(xcomp(P),ycomp(P)) - .5);
    Oi = 1;
    alpha = 1;
}
