room(world DEPS lobes integrator clouds photons ptex shading)
