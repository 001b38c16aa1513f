room(texture DEPS base display clouds)
room_tests(texture DEPS texture)
