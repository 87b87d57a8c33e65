# The Python package on the C interface, with the system's own Python.
find_program(WALE_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(WALE_PYTHON NAMES python3)
set(missing python3)
if(WALE_PYTHON)
  execute_process(COMMAND ${WALE_PYTHON} -c "import cffi, numpy, pytest" RESULT_VARIABLE missing ERROR_QUIET)
endif()
if(missing OR CMAKE_CXX_FLAGS MATCHES "-fsanitize")  # a sanitizer's runtime would have to come before Python's
  message(STATUS "Python with cffi, numpy and pytest is missing (Debian: python3-cffi, python3-numpy, python3-pytest), or not "
                 "to be used: no tests of the Python package")
  return()
endif()

set(package ${PROJECT_SOURCE_DIR}/library/python)
set(examples ${PROJECT_SOURCE_DIR}/examples)
add_test(NAME Python.Package COMMAND ${WALE_PYTHON} -m pytest -q -p no:cacheprovider ${CMAKE_CURRENT_SOURCE_DIR}/python)
add_test(NAME Python.DeclaresTheHeaders COMMAND ${WALE_PYTHON} ${package}/declare --check)
add_test(NAME Python.RoughnessByName COMMAND ${WALE_PYTHON} ${examples}/roughness_by_name/main.py)
set_tests_properties(Python.RoughnessByName PROPERTIES
  PASS_REGULAR_EXPRESSION "^coarse roughness: 2\\.3[0-9]+ N at the handle, felt as level 0\\.70\n$")
add_test(NAME Python.CustomDevice COMMAND ${WALE_PYTHON} ${examples}/custom_device/main.py)
set_tests_properties(Python.CustomDevice PROPERTIES PASS_REGULAR_EXPRESSION "^in honey the handle swings by 1?[0-9]\\.[0-9] mm after 2 s")
add_test(NAME Python.MillionHands COMMAND ${WALE_PYTHON} ${examples}/million_hands/main.py)
set_tests_properties(Python.MillionHands PROPERTIES PASS_REGULAR_EXPRESSION "99 % of the forces are at most 1\\.934 N")
set(python_tests Python.Package Python.DeclaresTheHeaders Python.RoughnessByName Python.CustomDevice Python.MillionHands)
find_program(WALE_MYPY mypy)
if(WALE_MYPY)
  add_test(NAME Python.Types COMMAND ${WALE_MYPY} --strict --no-incremental --cache-dir=/dev/null -p wale)
  list(APPEND python_tests Python.Types)
else()
  message(STATUS "mypy is missing (Debian: mypy): the types of the Python package are not checked")
endif()
set_tests_properties(${python_tests} PROPERTIES TIMEOUT 300 ENVIRONMENT
  "WALE_SHARED_LIBRARY=$<TARGET_FILE:${shipped_c}>;PYTHONPATH=${package};MYPYPATH=${package};PYTHONDONTWRITEBYTECODE=1;XDG_CONFIG_HOME=/nonexistent")
