/* rimlight: a light from behind that gives highlights only: nothing of it in diffuse(), and surfaces can pick it by its category.
     share       how much of it highlights get, and how much the diffuse part gets
   Ball: LightSource "envlight" 3 "float intensity" .05 LightSource "rimlight" 1 "point from" [1 3 4] "float intensity" 30 LightSource "pointlight" 2 "point from" [-4 4 -4] "float intensity" 18 */
light rimlight(
    float intensity = 1; color lightcolor = color(.7, .85, 1); point from = point "shader" (0, 0, 0);
    float __nondiffuse = 1; float __nonspecular = 0; string __category = "rim,nodiffuse";)
{
    illuminate(from) Cl = intensity * lightcolor / (L . L);
}
