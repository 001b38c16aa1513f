// Token-value pairs of the calls of ri.h that end in "...": inside such a function ALPENGLOW_PAIRS(last named parameter) reads
// them into `pairs`, and ALPENGLOW_LIST passes them to the form that ends in V.
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

// Both forms of a call whose request has a name and a parameter list, in this order.
#define ALPENGLOW_NAMED(request)                                                                                                 \
    RtVoid Ri##request##V(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {                                         \
        Building(#request).text(name).parameters(n, tokens, values).run();                                                       \
    }                                                                                                                            \
    RtVoid Ri##request(RtToken name, ...) {                                                                                      \
        ALPENGLOW_PAIRS(name);                                                                                                   \
        Ri##request##V(name, ALPENGLOW_LIST);                                                                                    \
    }
// The same with a second text.
#define ALPENGLOW_NAMED_TWICE(request)                                                                                           \
    RtVoid Ri##request##V(RtToken name, RtToken second, RtInt n, RtToken tokens[], RtPointer values[]) {                         \
        Building(#request).text(name).text(second).parameters(n, tokens, values).run();                                          \
    }                                                                                                                            \
    RtVoid Ri##request(RtToken name, RtToken second, ...) {                                                                      \
        ALPENGLOW_PAIRS(second);                                                                                                 \
        Ri##request##V(name, second, ALPENGLOW_LIST);                                                                            \
    }
