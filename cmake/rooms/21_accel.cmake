# The only room that knows Embree: its headers stay private to src/accel/*.cpp.
room(accel DEPS geometry embree3)
room_tests(accel DEPS accel)
