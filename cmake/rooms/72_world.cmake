room(world DEPS lobes lanes clouds photons ptex shading)
