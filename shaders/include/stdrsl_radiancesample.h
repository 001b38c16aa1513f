/* stdrsl/RadianceSample.h: the structure __radiancesample is part of this compiler. */
#ifndef STDRSL_RADIANCESAMPLE_H
#define STDRSL_RADIANCESAMPLE_H
#endif
