/* softsun: a sun with a size: parallel light from a cone of directions, so that under "path" its shadows have soft edges. Low it is red.
     size        half the angle that it is seen under, degrees (the real one has .27)
     elevation   above the horizon, degrees; azimuth: around "world" y
   Ball: LightSource "softsun" 1 "float size" 6 "float elevation" 40 "float intensity" 1.3 */
light softsun(float intensity = 1, size = .27, elevation = 45, azimuth = -30; string __category = "sun";)
{
    uniform float up = radians(elevation), around = radians(azimuth);
    uniform vector toward = vector "world" (sin(around) * cos(up), sin(up), -cos(around) * cos(up));
    /* The way through the air, in atmospheres, and what it takes of each colour. */
    uniform float air = 1 / (sin(max(up, .03)) + .15 * pow(max(elevation, 0) + 3.885, -1.253));
    solar(-toward, radians(size)) {
        Cl = intensity * color(exp(-.06 * air), exp(-.11 * air), exp(-.22 * air)) * 1.2;
    }
}
