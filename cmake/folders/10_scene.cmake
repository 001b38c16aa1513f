folder_library(scene DEPS base)
