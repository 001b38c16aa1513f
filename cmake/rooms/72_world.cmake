room(world DEPS lobes clouds photons ptex shading)
