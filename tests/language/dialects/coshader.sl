class noise_layer(float amount = 1; float frequency = 4; string __category = "layer"; string space = "object";)
{
    public uniform float calls = 0;
    varying point m_Q;

    void init(output point q) { q = frequency * transform(space, P); }

    public void begin() { init(m_Q); }
    public color evalColor(color base) { return mix(base, color noise(m_Q), amount); }
    public float evalFloat(string what; float x) {
        if (what == "noise") return x + amount * noise(m_Q);
        else if (what == "cell") return x + amount * cellnoise(m_Q);
        return x;
    }
    public void evalBoth(color a; output color b; output float w) {
        b = evalColor(a);
        w = evalFloat("noise", 0);
    }
}
