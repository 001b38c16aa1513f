# The published scenes, through the reader and the renderer as the program runs them.
folder_tests(scenes DEPS render integrator ri display)
