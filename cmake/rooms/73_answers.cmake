room(answers DEPS world)
room_tests(integrator DEPS integrator answers)
