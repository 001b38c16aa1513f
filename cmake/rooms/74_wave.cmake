room(wave DEPS answers)
