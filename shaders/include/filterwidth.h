/* How far a value changes from one shading sample to the next: the width a pattern has to be filtered over. */
#ifndef FILTERWIDTH_H
#define FILTERWIDTH_H

#ifndef MINFILTWIDTH
#define MINFILTWIDTH 1.0e-6
#endif

/* of a float */
float filterwidth(float x) { return max(abs(Du(x) * du) + abs(Dv(x) * dv), MINFILTWIDTH); }
/* of a position: the side of the square that a sample covers */
float filterwidthp(point p) { return max(sqrt(area(p)), MINFILTWIDTH); }
float filterwidth_point(point p) { return max(sqrt(area(p)), MINFILTWIDTH); }

#ifndef FILTERWIDTH
#define FILTERWIDTH(x) filterwidth(x)
#endif

#endif
