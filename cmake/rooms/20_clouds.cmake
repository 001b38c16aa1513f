find_package(ZLIB REQUIRED)
room(clouds DEPS base ZLIB::ZLIB)
