room(integrator DEPS answers lanes)
