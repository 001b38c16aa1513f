/* Tracing rays: trace, raylevel and isshadowray are part of this compiler; visibility is what 3Delight calls transmission. */
#ifndef RAYSERVER_H
#define RAYSERVER_H
color visibility(point from, to) { return transmission(from, to); }
#endif
