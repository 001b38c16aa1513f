/* a window's light, with a grid of bars */
light windowlight(
    float intensity = 1; color lightcolor = 1;
    point from = point "camera" (0,0,0), center = point "shader" (0,0,1), in = point "shader" (0,0,1), up = point "shader" (0,1,0);
    float xorder = 2, yorder = 3, framewidth = .1, fuzz = .05)
{
    uniform point relin, path, right, rise;
    relin = normalize(in);
    right = normalize(up ^ relin);
    rise = relin ^ right;
    path = center - from;
    solar(path, 0.0) {
        point offset = Ps - center;
        float x = offset . right, y = offset . rise;
        x = mod(x * xorder, 1);
        y = mod(y * yorder, 1);
        Cl = intensity * lightcolor * (smoothstep(framewidth - fuzz, framewidth, x) * smoothstep(framewidth - fuzz, framewidth, y));
    }
}
