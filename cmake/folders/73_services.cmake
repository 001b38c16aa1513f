folder_library(services DEPS world)
folder_tests(lanes DEPS lanes services)
