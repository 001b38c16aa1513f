room(answers DEPS world)
room_tests(lanes DEPS lanes answers)
