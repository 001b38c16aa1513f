find_package(ZLIB REQUIRED)
room(ri DEPS scene base ZLIB::ZLIB)
room_tests(ri DEPS ri)
