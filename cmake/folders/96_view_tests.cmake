# Of the folder itself, in this process, and of the program's command.
folder_tests(view DEPS view display)
if(TARGET test_view)
  target_include_directories(test_view PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(test_view PRIVATE ALPENGLOW_PROGRAM="$<TARGET_FILE:alpenglow>")
  add_dependencies(test_view alpenglow)
endif()
# The page in a real browser: nightly, and only where there is one.
if(ALPENGLOW_TESTS)
  add_test(NAME View.InABrowser COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tests/view/browser_test.py $<TARGET_FILE:alpenglow> ${CMAKE_BINARY_DIR}/view-screenshots)
  set_tests_properties(View.InABrowser PROPERTIES LABELS view SKIP_RETURN_CODE 77 TIMEOUT 900)
endif()
