room(texture DEPS base display)
room_tests(texture DEPS texture)
