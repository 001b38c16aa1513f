find_package(ZLIB REQUIRED)
room(ptex DEPS base ZLIB::ZLIB)
