class dome_light(float intensity = 1; color lightcolor = 1; float samples = 16; string map = ""; string __category = "environment,indirect"; float __nonspecular = 0; output float __shadowf = 0;)
{
    public void light(output vector L; output color Cl;)
    {
        vector dir = vector(0, 1, 0);
        L = -vtransform("world", "current", dir);
        Cl = intensity * lightcolor;
        if (map != "") Cl *= color environment(map, dir);
    }
}
