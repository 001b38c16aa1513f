room(base DEPS TBB::tbb fmt::fmt Threads::Threads)
room_tests(base DEPS base)
