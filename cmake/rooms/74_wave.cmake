room(wave DEPS answers integrator)
