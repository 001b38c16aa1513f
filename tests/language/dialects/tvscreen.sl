surface tv(float lines = 240, pixels = 320, frame = 0; string movie = "frame"; float ext = 4; color phosphor[3] = {color(1,0,0),color(0,1,0),color(0,0,1)};)
{
    string file = format("%s.%04d.tif", movie, frame), alt = concat(movie, ".", "tif");
    if (ext == 4) file = alt;
    float x = s*pixels, y = t*lines, sub = floor(mod(x*3, 3)), even = mod(floor(y), 2);
    color pic = texture(file, (floor(x)+.5)/pixels, (floor(y)+.5)/lines);
    Ci = 0;
    if (sub == 0) Ci = pic*phosphor[0]; else if (sub == 1) Ci = pic*phosphor[1]; else Ci = pic * phosphor[2];
    Ci *= 3 * (even != 0 ? 1 : .6); Oi = 1;
}
