folder_tests(oracle DEPS base ${EMBREE_LIBRARY})
if(TARGET test_oracle)
  target_include_directories(test_oracle PRIVATE ${CMAKE_SOURCE_DIR}/tests)
endif()
