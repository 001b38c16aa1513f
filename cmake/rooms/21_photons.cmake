find_package(ZLIB REQUIRED)
room(photons DEPS base ZLIB::ZLIB)
