#include "displace.h"
#include "noises.h"
/* true displacement through the header's function, in another space */
displacement dentedskin(float Km = 0.05, freq = 4, truedisp = 1; string shadingspace = "shader"; float octaves = 4;)
{
    point Pt = transform(shadingspace, P) * freq;
    float amp = Km * (fBm(Pt, filterwidthp(Pt), 4, 2, .5) + 0.3 * turbulence(Pt, octaves));
    N = Displace(normalize(vector N), shadingspace, amp, truedisp);
}
