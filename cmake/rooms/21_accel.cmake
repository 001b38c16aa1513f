room(accel DEPS geometry)
room_tests(accel DEPS accel)
