/* The ray server of BMRT. trace, visibility, rayhittest, fulltrace, areashadow, raylevel and isshadowray are part of this compiler, so nothing
   has to be asked of another renderer. Positions and directions go to the server in world space; these are for shaders that do so themselves. */
#ifndef RAYSERVER_H
#define RAYSERVER_H
#define worldp(p) transform("world", p)
#define worldv(v) vtransform("world", v)
#endif
