room(shadeops DEPS base)
room_tests(shadeops DEPS shadeops)
