/* sepia: an old photograph: brown tones, grain of the plate, a pale border.
     tone     colour of the middle tones
     grain    strength of the grain
     border   width of the border, pixels */
imager sepia(color tone = color(1, .78, .52); float grain = .12, border = 4;)
{
    uniform float format[3] = {1, 1, 1};
    option("Format", format);
    float y = luminance(Ci);
    float g = 1 + grain * (cellnoise(xcomp(P), ycomp(P)) - .5) * 2;
    color print = mix(tone * y, color(y), smoothstep(.5, 1.2, y)) * g;
    float x = min(min(xcomp(P), ycomp(P)), min(format[0] - xcomp(P), format[1] - ycomp(P)));
    float edge = smoothstep(border - 1, border + 1, x + 1.5 * noise(P / 6));
    Ci = mix(color(.82, .78, .68), print, edge);
    Oi = 1;
    alpha = 1;
}
