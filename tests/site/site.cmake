# The site of the library, read by Python's own parsers and opened in headless Chromium.
if(missing OR CMAKE_CXX_FLAGS MATCHES "-fsanitize")  # of tests/python/package.cmake; a browser needs no second run
  message(STATUS "pytest is missing (Debian: python3-pytest), or not to be used: no tests of the site")
  return()
endif()
add_test(NAME Site COMMAND ${WALE_PYTHON} -m pytest -q -p no:cacheprovider ${CMAKE_CURRENT_SOURCE_DIR}/site)
set_tests_properties(Site PROPERTIES TIMEOUT 600 ENVIRONMENT
  "WALE_BINARY=$<TARGET_FILE:wale>;WALE_SOURCE_DIR=${PROJECT_SOURCE_DIR};PYTHONDONTWRITEBYTECODE=1;XDG_CONFIG_HOME=/nonexistent")
