#include "rmannotes.h"
surface hair_kay(float Ka = 1, Kd = .6, Ks = .35, roughness = .15; color rootcolor = color (.109, .037, .007), tipcolor = color (.519, .325, .125), specularcolor = (color(1) + tipcolor) / 2;)
{
    vector T = normalize (dPdv); /* tangent along length of hair */
    vector V = -normalize(I);    /* V is the view vector */
    color Cspec = 0, Cdiff = 0;  /* collect specular & diffuse light */
    float cosang;
    illuminance (P) {
        cosang = cos (abs (acos (T.normalize(L)) - acos (-T.V)));
        Cspec += Cl * v * pow (cosang, 1/roughness);
        Cdiff += Cl * v;
    }
    Oi = Os;
    Ci = Oi * (mix(rootcolor, tipcolor, v) * (Ka*ambient() + Kd * Cdiff)
                + (v * Ks * Cspec * specularcolor));
}
