room(geometry DEPS scene base)
room_tests(geometry DEPS accel geometry)
