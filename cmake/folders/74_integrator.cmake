folder_library(integrator DEPS services lanes)
