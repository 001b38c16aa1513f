/* glass that bends light */
surface pane(float Ka = 0.2, Kd = 0, Ks = 0.5, Kr = 1, Kt = 1, roughness = 0.05, eta = 1.5; color specularcolor = 1, transmitcolor = 1;)
{
    point Nf, V, Rdir, Tdir;
    float kr, kt;
    color ev, eT;
    point IN;
    IN = normalize(I);
    Nf = faceforward(normalize(N), I);
    V = -IN;
    fresnel(IN, Nf, (IN.N < 0) ? 1/eta : eta, kr, kt, Rdir, Tdir);
    kr *= Kr;
    kt *= Kt;
    if (kr > 0.001) ev = kr * trace(P, Rdir); else ev = 0;
    eT = (kt > 0.001) ? kt * transmitcolor * trace(P, Tdir) : color (0,0,0);
    Oi = Os;
    Ci = ev + eT + Os * Cs * (Ka*ambient() + Kd*diffuse(Nf)) + specularcolor*Ks*specular(Nf, V, roughness);
}
