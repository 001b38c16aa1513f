/* iridescent: a class with members that are worked out once for a point and used by its methods: the shell of a beetle, whose hue turns with the angle
   between light, surface and eye.
     hues      turns of the hue between straight and grazing
     saturation, value   of the shell */
class iridescent(float hues = 1.2, start = .35, saturation = .85, value = .7, Ka = 1, roughness = .12;)
{
    normal facing = 0;
    vector view = 0;

    color shell(vector l) {
        float c = normalize(l + view) . view;
        return ctransform("hsv", "rgb", color(mod(start + hues * (1 - c), 1), saturation, value));
    }

    public void prelighting(output color Ci, Oi) {
        extern normal N;
        extern vector I;
        facing = faceforward(normalize(N), I);
        view = -normalize(I);
    }

    public void lighting(output color Ci, Oi) {
        extern point P;
        Oi = Os;
        Ci = Ka * ambient() * shell(facing) * Cs;
        illuminance(P, facing, PI / 2) {
            vector l = normalize(L);
            color c = shell(l);
            Ci += Cs * Cl * (.45 * c * (facing . l) + c * pow(max(0, facing . normalize(l + view)), 1 / roughness));
        }
    }
}
