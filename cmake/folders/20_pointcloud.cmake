find_package(ZLIB REQUIRED)
folder_library(pointcloud DEPS base ZLIB::ZLIB)
