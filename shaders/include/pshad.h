/* The place that a pattern is looked up at: P in a space of the user's choice, at a frequency; "Pref" where a model carries it. */
#ifndef PSHAD_H
#define PSHAD_H
#include "filterwidth.h"

#ifndef USE_PREF
#define USE_PREF 0
#endif
#if USE_PREF
#define UNINITIALIZED_PREF point(-1e10, -1e10, -1e10)
#define PSHAD_PARAMS(spacedefault, freqdefault) \
    varying point Pref = UNINITIALIZED_PREF; string shadingspace = spacedefault; float shadingfreq = freqdefault
#define GET_PSHAD \
    varying point Pshad = transform(shadingspace, Pref != UNINITIALIZED_PREF ? Pref : P) * shadingfreq; \
    float dPshad = filterwidthp(Pshad)
#else
#define PSHAD_PARAMS(spacedefault, freqdefault) string shadingspace = spacedefault; float shadingfreq = freqdefault
#define GET_PSHAD \
    varying point Pshad = transform(shadingspace, P) * shadingfreq; \
    float dPshad = filterwidthp(Pshad)
#endif
#define DEFAULT_PSHAD_PARAMS PSHAD_PARAMS("shader", 1)

#endif
