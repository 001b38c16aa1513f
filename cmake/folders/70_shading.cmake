folder_library(shading DEPS accel geometry scene texture rsl_jit base)
folder_tests(shading DEPS base)
