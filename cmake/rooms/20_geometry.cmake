find_library(OSD_CPU osdCPU REQUIRED)
room(geometry DEPS scene base ${OSD_CPU})
room_tests(geometry DEPS accel geometry)
