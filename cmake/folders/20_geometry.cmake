find_library(OSD_CPU osdCPU REQUIRED)
folder_library(geometry DEPS scene base ${OSD_CPU})
folder_tests(geometry DEPS accel geometry)
