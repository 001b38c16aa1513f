find_package(ZLIB REQUIRED)
folder_library(photonmap DEPS base ZLIB::ZLIB)
