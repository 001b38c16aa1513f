// PRMan: a direction, what a light sends from there (radiance, density per steradian), and what a surface makes of it.
// summedResponse and summedPdf are those of accumulateMaterialResponse().
struct __radiancesample {
    varying vector direction = 0;
    varying float distance = 1e38;
    varying color radiance = 0;
    varying color materialResponse = 0;
    varying float materialPdf = 0, lightPdf = 0;
    varying color summedResponse = 0;
    varying float summedPdf = 0;
    public void setMaterialResponse(varying color response; varying float pdf) { materialResponse = response; materialPdf = pdf; }
    public void setMaterialSample(varying color response; varying float pdf; varying vector dir; varying float dist) {
        setMaterialResponse(response, pdf);
        direction = dir;
        distance = dist;
    }
    public void setLightRadiance(varying color light; varying float pdf) { radiance = light; lightPdf = pdf; }
    public void setLightSample(varying color light; varying float pdf; varying vector dir; varying float dist) {
        setLightRadiance(light, pdf);
        direction = dir;
        distance = dist;
    }
}
