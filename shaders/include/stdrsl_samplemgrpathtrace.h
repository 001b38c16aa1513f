/* stdrsl/SampleMgrPathTrace.h: here the same as stdrsl_SampleMgr, which asks whether paths are traced. */
#ifndef STDRSL_SAMPLEMGRPATHTRACE_H
#define STDRSL_SAMPLEMGRPATHTRACE_H
#include <stdrsl/SampleMgr.h>
struct stdrsl_SampleMgrPathTrace : stdrsl_SampleMgr { }
#endif
