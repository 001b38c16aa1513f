#include "itself.sl"
#include "itself.sl"
surface itself() { Ci = 1; }
