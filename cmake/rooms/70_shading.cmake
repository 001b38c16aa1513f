room(shading DEPS accel geometry scene texture rsl_jit base)
room_tests(shading DEPS base)
