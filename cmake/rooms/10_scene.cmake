room(scene DEPS base)
