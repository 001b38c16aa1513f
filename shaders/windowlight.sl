/* windowlight: light through a window with crossbars, after the light of that name in BMRT's time. It does not spread and does not fall off.
     lightcolor, darkcolor      through a pane, and where bars or the wall around keep it out
     from, to                   give the direction in which the light falls
     center, in, up             the middle of the window, the direction into the room, and upward along the wall
     hpanes, vpanes             how many panes across and up; panewidth, paneheight: their sizes
     framewidth, frameheight    of the bars, as parts of a pane; fuzz: width of the soft edges beside them, as a part of a pane
   The light leaves from the window, so that a wall around it casts no shadow into the room.
   Lamp: LightSource "windowlight" 1 "point from" [0 0 0] "point to" [0 0 1] "vector in" [0 0 1] "vector up" [0 1 0] "float panewidth" 1 "float paneheight" .7 "float fuzz" .05 */
light windowlight(
    float intensity = 1;
    color lightcolor = color(1, .9, .6), darkcolor = color(.05, .15, .1);
    point from = point "shader" (0, 0, 0), to = point "shader" (0, 1, 0), center = point "shader" (0, 0, 0);
    vector up = vector "shader" (0, 0, 1), in = vector "shader" (0, 1, 0);
    float hpanes = 2, vpanes = 3, panewidth = 6, paneheight = 6, framewidth = .1, frameheight = .1, fuzz = .25;)
{
    /* How open the window is at a place counted in panes: 0 outside of it and on bars, which lie over the edges of panes. */
    float open(float place, panes, bar, soft) {
        float inpane = mod(place, 1), edge = bar / 2;
        float pane = smoothstep(edge, edge + soft, inpane) * (1 - smoothstep(1 - edge - soft, 1 - edge, inpane));
        return (place < 0 || place > panes) ? 0 : pane;
    }
    uniform vector into = normalize(in), across = normalize(up ^ into), upright = normalize(into ^ across);
    uniform vector fall = normalize(to - from);
    /* Where the light that falls on Ps came through the wall. */
    point through = Ps - fall * (((Ps - center) . into) / (fall . into));
    illuminate(through, fall, .01) {
        float x = ((through - center) . across) / panewidth + hpanes / 2, y = ((through - center) . upright) / paneheight + vpanes / 2;
        Cl = intensity * mix(darkcolor, lightcolor, open(x, hpanes, framewidth, fuzz) * open(y, vpanes, frameheight, fuzz));
    }
}
