room(rsl/front DEPS shadeops base)
room_tests(rslfront DEPS rsl_front)
