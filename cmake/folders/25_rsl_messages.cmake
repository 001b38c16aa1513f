folder_library(rsl/messages DEPS base)
