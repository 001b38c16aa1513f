/* a screen of wires */
surface mesh(float Ka = 1, Kd = .75, Ks = .4, roughness = .1; color specularcolor = 1; float density = .25, frequency = 20;)
{
    varying point Nf, V;
    if (mod(s*frequency, 1) < density || mod(t*frequency, 1) < density) Oi = 1.0;
    else Oi = 0.0;
    if (comp(Oi, 0) > 0) {
        Nf = faceforward(normalize(N), I);
        V = -normalize(I);
        Ci = Cs * (Ka*ambient() + Kd*diffuse(Nf)) + specularcolor*Ks*specular(Nf, V, roughness);
    } else
        Ci = 0;
}
