// A shared library that is no plug-in of ours, as those of other renderers.
extern "C" int shadeops_table() { return 0; }
