room(transport DEPS wave)
