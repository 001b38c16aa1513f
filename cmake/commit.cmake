cmake_minimum_required(VERSION 3.25)
# Writes OUT with the commit of the checkout at SOURCE, or an empty one where there is none; leaves it alone when nothing has changed,
# so that only a new commit builds anything again.
find_package(Git QUIET)
set(commit "")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --exclude=* --dirty=+ WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define ALPENGLOW_COMMIT \"@commit@\"\n" @ONLY)
