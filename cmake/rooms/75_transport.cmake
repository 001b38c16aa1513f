room(transport DEPS shading)
