room(geometry DEPS scene base)
room_tests(geometry DEPS geometry)
