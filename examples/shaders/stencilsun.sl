/* stencilsun: sun through a window with panes, that is: a parallel light with a stencil.
     panes    across and up
     bars     width of a bar, as a part of a pane
     width, height   of the window, in shader space, around the origin; light goes along +z
     soft     how soft the shadows of the bars are
   Lamp: LightSource "stencilsun" 1 "float width" 3 "float height" 3 "float intensity" 1.2 */
light stencilsun(
    float intensity = 1, panesx = 3, panesy = 3, bars = .12, width = 2, height = 2, soft = .05;
    color lightcolor = color(1, .95, .85);
    string __category = "sun";)
{
    solar(vector "shader" (0, 0, 1), 0) {
        point Q = transform("shader", Ps);
        float x = (xcomp(Q) / width + .5) * panesx, y = (ycomp(Q) / height + .5) * panesy;
        float fx = mod(x, 1), fy = mod(y, 1), half = bars / 2;
        float open = smoothstep(half - soft, half + soft, fx) * (1 - smoothstep(1 - half - soft, 1 - half + soft, fx)) *
                     smoothstep(half - soft, half + soft, fy) * (1 - smoothstep(1 - half - soft, 1 - half + soft, fy));
        open *= smoothstep(0, soft, x) * (1 - smoothstep(panesx - soft, panesx, x)) * smoothstep(0, soft, y) * (1 - smoothstep(panesy - soft, panesy, y));
        Cl = intensity * lightcolor * open;
    }
}
