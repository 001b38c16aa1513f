// Token-value pairs of the calls of ri.h that end in "...": inside such a function ALPENGLOW_PAIRS(last named parameter) reads
// them into `pairs`, and ALPENGLOW_LIST hands them to the form that ends in V.
#pragma once
#include "ri/c/client.h"
#include <cstdarg>

// The parameters before "..." are RtFloat in the specification's binding; the machines this runs on pass them as what they are.
#pragma clang diagnostic ignored "-Wvarargs"

#define ALPENGLOW_PAIRS(last)                                                                                                    \
    va_list list;                                                                                                                \
    va_start(list, last);                                                                                                        \
    Pairs pairs(list);                                                                                                           \
    va_end(list)
#define ALPENGLOW_LIST pairs.count(), pairs.tokens.data(), pairs.values.data()
