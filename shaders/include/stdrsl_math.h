/* stdrsl/Math.h: constants, and what keeps divisors away from 0. */
#ifndef STDRSL_MATH_H
#define STDRSL_MATH_H
#ifndef M_PI
#define M_PI 3.14159265358979323846
#endif
#ifndef M_TWOPI
#define M_TWOPI 6.28318530717958647692
#endif
#ifndef M_PI_2
#define M_PI_2 1.57079632679489661923
#endif
#ifndef M_PI_4
#define M_PI_4 0.78539816339744830962
#endif
#ifndef M_INVPI
#define M_INVPI 0.31830988618379067154
#endif
#ifndef M_INVTWOPI
#define M_INVTWOPI 0.15915494309189533577
#endif
#ifndef M_FOURPI
#define M_FOURPI 12.56637061435917295385
#endif
#ifndef M_INVFOURPI
#define M_INVFOURPI 0.07957747154594766788
#endif
#ifndef M_MINDIVISOR
#define M_MINDIVISOR 1.0e-6 /* the least that is divided by */
#endif
#ifndef M_MAXDIST
#define M_MAXDIST 1.0e10 /* farther than anything: the distance of samples that meet nothing */
#endif
#ifndef M_SQRT2
#define M_SQRT2 1.41421356237309504880
#endif
/* x, but not nearer to 0 than `least`, on its side of 0 */
float signedmax(float least, x) { return (x < 0) ? min(x, -least) : max(x, least); }
#endif
