/* Numbers that have names. */
#ifndef MATHUTIL_H
#define MATHUTIL_H
#ifndef M_PI
#define M_PI 3.14159265358979323846
#endif
#ifndef M_PI_2
#define M_PI_2 1.57079632679489661923
#endif
#ifndef M_2PI
#define M_2PI 6.28318530717958647692
#endif
#ifndef M_E
#define M_E 2.7182818284590452354
#endif
#ifndef TRUE
#define TRUE 1
#endif
#ifndef FALSE
#define FALSE 0
#endif
#ifndef sqr
#define sqr(x) ((x) * (x))
#endif
#endif
