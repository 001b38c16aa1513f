find_package(ZLIB REQUIRED)
folder_library(ptex DEPS base ZLIB::ZLIB)
