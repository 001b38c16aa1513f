# The published scenes, through the reader and the renderer as the program runs them.
room_tests(scenes DEPS render integrator ri display)
