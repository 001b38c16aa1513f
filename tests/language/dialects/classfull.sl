#define MEMBER(t, n) varying t m_##n = 0
class uberClass( uniform color diffuseColor = color(.5); uniform float specularRoughness[2] = {.1, .4}; uniform float diffuseGain = .5, specularGain = .5; string bumpMap = ""; uniform float maxsamples = 16; uniform string __instanceid = ""; shader shaders_m[] = {}; uniform float __computesOpacity = 0;)
{
    MEMBER(color, diff);
    MEMBER(normal, nn);
    MEMBER(vector, vn);
    uniform float m_depth = 0;
    varying float roughs[2];
    string m_names[];
    public constant float version = 2;

    float schlick(float c) { return pow(1 - clamp(c, 0, 1), 5); }
    void setup() {
        m_nn = normalize(N); m_vn = -normalize(I);
        if ((m_nn . m_vn) < 0) m_nn = -m_nn;
        rayinfo("depth", m_depth);
    }
    public void construct() { push(m_names, "one"); if (diffuseGain > 0) push(m_names, "two"); }
    public void begin() { setup(); uniform float i; for (i = 0; i < 2; i += 1) roughs[i] = specularRoughness[i]; }
    public void displacement(output point P; output normal N) { if (bumpMap != "") { float d = texture(bumpMap[0]); P += d * m_nn; N = calculatenormal(P); } }
    public void opacity(output color Oi) { Oi = Os * (1 - .5 * schlick(m_nn . m_vn)); }
    public void surface(output color Ci, Oi)
    {
        opacity(Oi);
        m_diff = diffuseColor * diffuse(m_nn) * diffuseGain;
        color sp = 0; uniform float i;
        for (i = 0; i < arraylength(specularRoughness); i += 1) sp += specular(m_nn, m_vn, roughs[i]);
        Ci = (m_diff + sp * specularGain * schlick(m_nn . m_vn)) * Oi;
        if (arraylength(m_names) > 1 && m_names[0] == "one") Ci += helper(Ci);
        uniform float n = arraylength(shaders_m);
        for (i = 0; i < n; i += 1) { color o = 0; shaders_m[i]->addTo(Ci, o); }
    }
    color helper(color x) { return x * version * 0; }
}
