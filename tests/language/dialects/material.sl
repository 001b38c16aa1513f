struct SurfData { color diff; color spec; normal n; float rough = 0.2; }
class layeredmat(
    uniform float Kd = 0.8, Ks = 0.3;
    color tint = color(1, 0.8, 0.6);
    string colormap = "";
    uniform string __category = "material,base";
    shader coat = null;
    shader layers[] = {};
    output varying color diffusePass = 0;
    output varying color specPass = 0;)
{
    varying color m_albedo = 0;
    varying normal m_N = 0;
    uniform float m_n = 0;
    constant float PI2 = 6.2831853;

    public void construct() { m_n = arraylength(layers); }

    public void begin()
    {
        m_N = normalize(N);
        m_N = faceforward(m_N, I);
        m_albedo = tint * Cs;
        if (colormap != "") m_albedo *= color texture(colormap, s, t, "blur", 0, "filter", "gaussian");
    }
    public void displacement(output point P; output normal N)
    {
        P += 0.01 * sin(PI2 * s) * normalize(N);
        N = calculatenormal(P);
    }
    public void opacity(output color Oi) { Oi = Os; }
    public void prelighting(output color Ci, Oi) { m_albedo *= 0.9; }
    public void lighting(output color Ci, Oi)
    {
        varying color d = 0, sp = 0;
        vector V = -normalize(I);
        illuminance("-nodiffuse", P, m_N, PI / 2, "lightcache", "reuse")
        {
            d += Cl * max(0, normalize(L) . m_N);
            sp += Cl * specularbrdf(normalize(L), m_N, V, 0.1);
        }
        diffusePass = Kd * m_albedo * d;
        specPass = Ks * sp;
        Ci = diffusePass + specPass;
    }
    public void postlighting(output color Ci, Oi)
    {
        if (coat != null) Ci = coat->apply(Ci);
        uniform float i;
        for (i = 0; i < m_n; i += 1)
            if (layers[i] != null) Ci += layers[i]->apply(color(0, 0, 0));
        Ci *= Oi;
    }
    public color getAlbedo() { return m_albedo; }
}
