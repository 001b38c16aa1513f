room(answers DEPS world)
